/** Which findings are shown: by how sure they are, and by kind, each with its count. */

import { UnstyledButton } from "@mantine/core";
import { counted, type Filter, type Finding, MARK_NAMES, MARKS, type Mark } from "../../model/finding";
import { words } from "../../model/units";
import classes from "./Maps.module.css";
import { MarkIcon } from "./MarkIcon";

interface Props {
  findings: readonly Finding[];
  filter: Filter;
  onFilter: (filter: Filter) => void;
}

export function Filters({ findings, filter, onFilter }: Props) {
  const marks = new Map(counted(findings, ({ mark }) => mark));
  const kinds = counted(findings, ({ kind }) => kind).filter(([kind]) => kind !== "corrected");
  return (
    <div className={classes.filters} data-testid="filters">
      <div role="group" aria-label="Shown by how sure">
        {MARKS.filter((mark) => marks.has(mark)).map((mark) => (
          <Chip
            key={mark}
            pressed={!filter.marks.has(mark)}
            onClick={() => onFilter({ ...filter, marks: toggled(filter.marks, mark as Mark) })}
          >
            <MarkIcon mark={mark} size={13} />
            {MARK_NAMES[mark]} <b>{marks.get(mark)}</b>
          </Chip>
        ))}
      </div>
      <div role="group" aria-label="Shown by kind">
        {kinds.map(([kind, count]) => (
          <Chip
            key={kind}
            pressed={!filter.kinds.has(kind)}
            onClick={() => onFilter({ ...filter, kinds: toggled(filter.kinds, kind) })}
          >
            {words(kind)} <b>{count}</b>
          </Chip>
        ))}
      </div>
    </div>
  );
}

function toggled<Key>(set: ReadonlySet<Key>, key: Key): ReadonlySet<Key> {
  const next = new Set(set);
  if (!next.delete(key)) next.add(key);
  return next;
}

interface ChipProps {
  pressed: boolean;
  onClick: () => void;
  children: React.ReactNode;
}

function Chip({ pressed, onClick, children }: ChipProps) {
  return (
    <UnstyledButton className={classes.chip} aria-pressed={pressed} onClick={onClick}>
      {children}
    </UnstyledButton>
  );
}
