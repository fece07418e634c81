/** The findings as a table: sortable, moved through with the keyboard, drawn only where it is seen. */

import { useVirtualizer } from "@tanstack/react-virtual";
import { type KeyboardEvent, useEffect, useMemo, useRef } from "react";
import { type Finding, MARK_NAMES, type SortKey } from "../../model/finding";
import { Icon } from "../../ui/Icon";
import { useRowFocus } from "../../ui/row";
import { useShortcuts } from "../../ui/shortcut";
import classes from "./Maps.module.css";
import { MarkIcon } from "./MarkIcon";

const ROW_HEIGHT = 30;

const COLUMNS: { key: SortKey; title: string; name: string }[] = [
  { key: "mark", title: "", name: "How sure" },
  { key: "kind", title: "Kind", name: "What kind of thing" },
  { key: "what", title: "What", name: "What was taken, or left out" },
  { key: "where", title: "Where", name: "On which road or element" },
];

export interface Sort {
  key: SortKey;
  descending: boolean;
}

interface Props {
  findings: readonly Finding[];
  selected: Finding | undefined;
  sort: Sort;
  onSort: (sort: Sort) => void;
  onSelect: (finding: Finding) => void;
}

export function FindingsTable({ findings, selected, sort, onSort, onSelect }: Props) {
  const scroller = useRef<HTMLDivElement>(null);
  const virtual = useVirtualizer({
    count: findings.length,
    getScrollElement: () => scroller.current,
    estimateSize: () => ROW_HEIGHT,
    overscan: 10,
  });
  const at = selected ? findings.indexOf(selected) : -1;
  // The row of a mark that was clicked comes into sight, and stays there when the details take room.
  const height = virtual.scrollRect?.height;
  useEffect(() => {
    if (at >= 0) virtual.scrollToIndex(at, { align: "auto" });
  }, [at, height, virtual]);
  const keys = useMemo(() => findings.map(({ id }) => id), [findings]);
  const { enter, step } = useRowFocus(scroller, keys, (index) => virtual.scrollToIndex(index));
  const onKey = (event: KeyboardEvent) => {
    const finding = findings[step(event) ?? -1];
    if (finding) onSelect(finding);
  };
  const come = () => enter(Math.max(0, at));
  useShortcuts({ j: come, k: come, ArrowDown: come, ArrowUp: come });

  const items = virtual.getVirtualItems();
  const above = items[0]?.start ?? 0;
  const below = virtual.getTotalSize() - (items.at(-1)?.end ?? 0);
  return (
    <div ref={scroller} className={classes.scroller}>
      <table className={classes.findings} role="grid" aria-label="Findings" data-testid="findings" aria-rowcount={findings.length + 1}>
        <thead>
          <tr>
            {COLUMNS.map(({ key, title, name }) => (
              <th key={key} scope="col" title={name} aria-sort={ariaSort(sort, key)} data-column={key}>
                <button
                  type="button"
                  className={classes.sort}
                  aria-label={title || name}
                  onClick={() => onSort({ key, descending: sort.key === key && !sort.descending })}
                >
                  {title}
                  {sort.key === key ? <Icon name={sort.descending ? "down" : "up"} size={12} /> : null}
                </button>
              </th>
            ))}
          </tr>
        </thead>
        <tbody onKeyDown={onKey}>
          <Gap height={above} />
          {items.map(({ index }) => {
            const finding = findings[index];
            return finding ? (
              <Row
                key={finding.id}
                finding={finding}
                index={index}
                selected={index === at}
                reachable={index === Math.max(0, at)}
                onSelect={onSelect}
              />
            ) : null;
          })}
          <Gap height={below} />
        </tbody>
      </table>
    </div>
  );
}

const ariaSort = (sort: Sort, key: SortKey) =>
  sort.key === key ? (sort.descending ? "descending" : "ascending") : "none";

/** Room for the rows that are not drawn. */
function Gap({ height }: { height: number }) {
  return height > 0 ? (
    <tr aria-hidden="true">
      <td colSpan={COLUMNS.length} style={{ height, padding: 0, border: 0 }} />
    </tr>
  ) : null;
}

interface RowProps {
  finding: Finding;
  index: number;
  selected: boolean;
  /** Whether the tab key leads here. */
  reachable: boolean;
  onSelect: (finding: Finding) => void;
}

function Row({ finding, index, selected, reachable, onSelect }: RowProps) {
  const { mark, kind, what, where } = finding;
  return (
    <tr
      data-index={index}
      data-testid="finding-row"
      data-mark={mark}
      aria-selected={selected}
      tabIndex={reachable ? 0 : -1}
      onClick={() => onSelect(finding)}
      onKeyDown={({ key }) => key === "Enter" && onSelect(finding)}
    >
      <td data-column="mark">
        <MarkIcon mark={mark} title={MARK_NAMES[mark]} />
      </td>
      <td title={kind}>{kind}</td>
      <td title={what}>{what}</td>
      <td title={where}>{where}</td>
    </tr>
  );
}
