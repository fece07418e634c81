/** The findings as a table: sortable, moved through with the keyboard, drawn only where it is seen. */

import { useVirtualizer } from "@tanstack/react-virtual";
import { type KeyboardEvent, useEffect, useRef } from "react";
import { type Finding, MARK_NAMES, type SortKey } from "../../model/finding";
import { Icon } from "../../ui/Icon";
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
  const { onKey, focusFirst } = useRowKeys(scroller, findings, at, onSelect);
  useShortcuts({ j: focusFirst, k: focusFirst, ArrowDown: focusFirst, ArrowUp: focusFirst });

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

/** Where a key leads, from one row of so many. */
const STEPS: Record<string, (at: number, count: number) => number> = {
  ArrowDown: (at) => at + 1,
  j: (at) => at + 1,
  ArrowUp: (at) => at - 1,
  k: (at) => at - 1,
  PageDown: (at) => at + 10,
  PageUp: (at) => at - 10,
  Home: () => 0,
  End: (_at, count) => count - 1,
};

/** The keys select rows, and the focus goes with the selection as soon as the row is drawn. */
function useRowKeys(
  scroller: React.RefObject<HTMLDivElement | null>,
  findings: readonly Finding[],
  at: number,
  onSelect: (finding: Finding) => void,
) {
  const wanted = useRef(false);
  const rowAt = (index: number) => scroller.current?.querySelector<HTMLElement>(`tr[data-index="${index}"]`);
  // Without dependencies: a row far away is drawn only after the table was scrolled to it.
  useEffect(() => {
    const row = wanted.current ? rowAt(at) : null;
    if (!row) return;
    wanted.current = false;
    row.focus({ preventScroll: true });
  });
  const onKey = (event: KeyboardEvent) => {
    const step = STEPS[event.key];
    const from = Number((event.target as HTMLElement).closest("tr")?.dataset.index);
    const enter = event.key === "Enter" && Number.isInteger(from);
    if ((!step && !enter) || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    const to = step ? Math.min(findings.length - 1, Math.max(0, step(from, findings.length))) : from;
    const finding = findings[to];
    if (!finding) return;
    wanted.current = true;
    onSelect(finding);
  };
  const focusFirst = () => (rowAt(at) ?? rowAt(0))?.focus();
  return { onKey, focusFirst };
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
