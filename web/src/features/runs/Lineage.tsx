/** Runs as a tree: which descends from which, and what was changed on the way. */

import { Checkbox, Text } from "@mantine/core";
import { Link } from "@tanstack/react-router";
import { useVirtualizer } from "@tanstack/react-virtual";
import { useMemo, useRef } from "react";
import { type Branch, type Change, forest } from "../../model/lineage";
import { type ListedRun, shortNames } from "../../model/run";
import { formatMoment, formatValue, words } from "../../model/units";
import { StatusBadge } from "../../ui/StatusBadge";
import { VerdictBadge } from "../../ui/VerdictBadge";
import classes from "./Lineage.module.css";

const ROW_HEIGHT = 34;

interface Props {
  runs: readonly ListedRun[];
  selected: ReadonlySet<number>;
  onToggle: (run: number) => void;
}

export function Lineage({ runs, selected, onToggle }: Props) {
  const branches = useMemo(() => forest(runs), [runs]);
  const scroller = useRef<HTMLDivElement>(null);
  const virtual = useVirtualizer({
    count: branches.length,
    getScrollElement: () => scroller.current,
    estimateSize: () => ROW_HEIGHT,
    overscan: 12,
  });
  return (
    <div ref={scroller} className={classes.scroller} data-testid="lineage">
      <ul className={classes.tree} role="tree" aria-label="Lineage of the runs" style={{ height: virtual.getTotalSize() }}>
        {virtual.getVirtualItems().map(({ index, start }) => {
          const branch = branches[index] as Branch;
          return (
            <li
              key={branch.run.run}
              role="treeitem"
              aria-level={branch.open.length + 1}
              data-run={branch.run.run}
              aria-selected={selected.has(branch.run.run)}
              className={classes.row}
              style={{ transform: `translateY(${start}px)`, height: ROW_HEIGHT }}
            >
              <Row branch={branch} selected={selected.has(branch.run.run)} onToggle={() => onToggle(branch.run.run)} />
            </li>
          );
        })}
      </ul>
    </div>
  );
}

interface RowProps {
  branch: Branch;
  selected: boolean;
  onToggle: () => void;
}

function Row({ branch: { run, open, straight, lost, changes, heirs }, selected, onToggle }: RowProps) {
  return (
    <>
      <Checkbox size="xs" checked={selected} onChange={onToggle} aria-label={`Select run ${run.run} to compare`} />
      <Lines open={open} straight={straight} />
      <Link to="/runs/$run" params={{ run: String(run.run) }} className={classes.number}>
        #{run.run}
      </Link>
      <StatusBadge status={run.status} error={run.error} unmet={run.unmet} />
      {run.verdict === "open" ? null : <VerdictBadge verdict={run.verdict} reason={run.reason} />}
      {run.name ? <b>{run.name}</b> : null}
      <span className={classes.changes}>
        {run.parent === null ? (
          <Text span size="sm" c="dimmed">
            {run.scenario}
          </Text>
        ) : lost ? (
          <Text span size="sm" c="dimmed">
            child of #{run.parent}, which is not shown
          </Text>
        ) : (
          <Changes changes={changes} />
        )}
      </span>
      <Text span size="xs" c="dimmed" className={classes.end}>
        {heirs > 0 ? `${heirs} ${heirs === 1 ? "descends" : "descend"} from it, ` : ""}
        {formatMoment(run.created)}
      </Text>
    </>
  );
}

/** What was changed on the way from the parent. */
function Changes({ changes }: { changes: readonly Change[] }) {
  if (changes.length === 0)
    return (
      <Text span size="sm" c="dimmed">
        nothing was changed
      </Text>
    );
  const short = shortNames(changes.map(({ path }) => path));
  return changes.map(({ path, from, to }) => (
    <span key={path} title={path} className={classes.change}>
      {words(short[path] ?? path).toLowerCase()} <s>{formatValue(from)}</s> <b>{formatValue(to)}</b>
    </span>
  ));
}

const STEP = 22;

/** From the parent to the run, past all that still comes above. */
function Lines({ open, straight }: { open: readonly boolean[]; straight: boolean }) {
  const width = (open.length + 1) * STEP;
  const at = (level: number) => (level + 0.5) * STEP;
  const last = open.length;
  const middle = ROW_HEIGHT / 2;
  return (
    <svg width={width} height={ROW_HEIGHT} aria-hidden="true" className={classes.lines}>
      {open.map((goes, level) =>
        goes || (level === last - 1 && !straight) ? (
          <line key={level} x1={at(level)} x2={at(level)} y1={0} y2={goes ? ROW_HEIGHT : middle} />
        ) : null,
      )}
      {straight ? <line x1={at(last)} x2={at(last)} y1={0} y2={middle} /> : null}
      {!straight && last > 0 ? <line x1={at(last - 1)} x2={at(last)} y1={middle} y2={middle} /> : null}
      <circle cx={at(last)} cy={middle} r={4} />
    </svg>
  );
}
