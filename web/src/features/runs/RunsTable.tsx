/** The table itself: grouped headers with units, sorting, and rows drawn only where they are seen. */

import { Checkbox, VisuallyHidden } from "@mantine/core";
import { useNavigate } from "@tanstack/react-router";
import {
  type ColumnDef,
  columnVisibilityFeature,
  rowSortingFeature,
  type SortingState,
  tableFeatures,
  useTable,
} from "@tanstack/react-table";
import { useVirtualizer } from "@tanstack/react-virtual";
import { type KeyboardEvent, type RefObject, useEffect, useLayoutEffect, useMemo, useRef, useState } from "react";
import { useGlossary } from "../../api/glossary";
import { offsets } from "../../model/arrangement";
import { type Entry, entriesOf, groupsOf, type RunGroup, said } from "../../model/grouping";
import { onTop } from "../../model/pin";
import type { Json, ListedRun } from "../../model/run";
import { standing } from "../../model/standing";
import { type Column, isUnranked, sorted, varies } from "../../model/table";
import { formatMoment, formatNumber, formatTime, formatValue, withUnit } from "../../model/units";
import type { Word } from "../../model/verdict";
import { Icon } from "../../ui/Icon";
import { useRowFocus } from "../../ui/row";
import { StatusBadge } from "../../ui/StatusBadge";
import { useShortcuts } from "../../ui/shortcut";
import { VerdictBadge } from "../../ui/VerdictBadge";
import classes from "./Runs.module.css";
import type { RunsView } from "./RunsPage";

const ROW_HEIGHT = 33;

/** These say what a row is, so they stay even when all rows agree. */
const ALWAYS = new Set(["run", "status", "verdict", "created"]);

const GROUP_TITLES = { pinned: "Pinned", run: "Run", parameters: "Parameters that some run has set", metrics: "Metrics", channels: "Recorded channels" };

const features = tableFeatures({ rowSortingFeature, columnVisibilityFeature });

interface Props {
  runs: readonly ListedRun[];
  /** The runs without the filter. */
  all: readonly ListedRun[];
  columns: readonly Column[];
  /** Ids of columns that somebody does not want to see. */
  hidden: readonly string[];
  /** Those that stay at the left, behind the run's number. */
  fixed: readonly Column[];
  onFix: (column: string) => void;
  /** The run that the others are tinted against; it stands first. */
  base: ListedRun | undefined;
  /** Those that stay on top beside it. */
  pinned: ReadonlySet<number>;
  onPin: (run: number) => void;
  /** The run that is pointed at elsewhere. */
  hovered: number | undefined;
  onBase: (run: number) => void;
  view: RunsView;
  onView: (view: RunsView) => void;
  selected: ReadonlySet<number>;
  onToggle: (run: number) => void;
  /** Many are chosen at once, or given up. */
  onPick: (runs: readonly ListedRun[], isPicked: boolean) => void;
  /** Somebody wants to decide about a run. */
  onJudge: (run: ListedRun, word: Word) => void;
}

export function RunsTable({ runs, all, columns, hidden, fixed, onFix, base, pinned, onPin, hovered, view, selected, onView, onToggle, onPick, onJudge, onBase }: Props) {
  const sorting = readSort(view.sort);
  const data = useMemo(() => ordered(runs, columns, readSort(view.sort)[0], base, pinned), [runs, columns, view.sort, base, pinned]);
  const { entries, fold, folded } = useEntries(data, columns, view);
  const table = useTable({
    features,
    data,
    columns: useMemo(() => grouped(columns, fixed), [columns, fixed]),
    getRowId: (run: ListedRun) => String(run.run),
    manualSorting: true,
    enableMultiSort: false,
    state: { sorting, columnVisibility: visibility(columns, all, view.varying !== false, hidden, fixed) },
    onSortingChange: (next) =>
      onView({ ...view, sort: writeSort(typeof next === "function" ? next(sorting) : next) }),
  });
  const scroller = useRef<HTMLDivElement>(null);
  const { rowsById } = table.getRowModel();
  const virtual = useVirtualizer({
    count: entries.length,
    getScrollElement: () => scroller.current,
    estimateSize: () => ROW_HEIGHT,
    overscan: 12,
  });
  const items = virtual.getVirtualItems();
  const above = items[0]?.start ?? 0;
  const below = virtual.getTotalSize() - (items.at(-1)?.end ?? 0);
  const width = table.getVisibleLeafColumns().length + 1;
  const keys = useMemo(() => entries.map(({ run, group }) => (run ? String(run.run) : groupKey(group))), [entries]);
  const shown = table.getVisibleLeafColumns().map(({ id }) => byId(columns, id));
  const lefts = useMemo(() => leftsOf(shown, fixed), [shown.map(({ id }) => id).join(), fixed]);
  useOffsets(scroller, lefts);
  const { enter, step } = useRowFocus(scroller, keys, (index) => virtual.scrollToIndex(index));
  useRowKeys(() => enter(virtual.range?.startIndex ?? 0), items.length > 0);
  const withFocused = (act: (run: ListedRun) => void) => () => {
    const run = runs.find((each) => String(each.run) === focusedRun());
    if (run) act(run);
  };
  const judge = (word: Word) => withFocused((run) => onJudge(run, word));
  useShortcuts({
    c: judge("candidate"),
    C: judge("candidate"),
    d: judge("discarded"),
    D: judge("discarded"),
    b: withFocused(({ run }) => onBase(run)),
    p: () => {
      const column = focusedColumn();
      if (column && column !== "run") onFix(column);
      else withFocused(({ run }) => onPin(run))();
    },
  });

  return (
    <div ref={scroller} className={classes.scroller}>
      <table className={classes.table} data-testid="runs-table" aria-rowcount={entries.length + 2}>
        <thead>
          {table.getHeaderGroups().map((group, level) => (
            <tr key={group.id}>
              <th className={classes.pick}>
                {level === 0 ? <VisuallyHidden>Selection</VisuallyHidden> : <PickAll runs={runs} selected={selected} what="all shown runs" onPick={onPick} />}
              </th>
              {group.headers.map((header) =>
                level === 0 ? (
                  <th
                    key={header.id}
                    colSpan={header.colSpan}
                    scope="colgroup"
                    className={classes.group}
                    data-group={header.column.id}
                    data-sticky={header.column.id === "pinned" || undefined}
                    style={header.column.id === "pinned" ? { left: "var(--left-group, auto)" } : undefined}
                  >
                    <span className={classes.groupName}>{String(header.column.columnDef.header ?? "")}</span>
                  </th>
                ) : (
                  <SortHeader
                    key={header.id}
                    column={byId(columns, header.column.id)}
                    left={lefts[header.column.id]}
                    isFixed={fixed.some(({ id }) => id === header.column.id)}
                    sorted={header.column.getIsSorted()}
                    onSort={() => header.column.toggleSorting(undefined)}
                  />
                ),
              )}
            </tr>
          ))}
        </thead>
        <tbody onKeyDown={step}>
          <Gap height={above} width={width} />
          {items.map(({ index }) => {
            const { run, group } = entries[index] ?? {};
            if (group)
              return (
                <GroupRow
                  key={groupKey(group)}
                  group={group}
                  index={index}
                  columns={shown}
                  lefts={lefts}
                  isOpen={!folded.has(group.key)}
                  selected={selected}
                  onFold={() => fold(group.key)}
                  onPick={onPick}
                />
              );
            const row = run && rowsById[String(run.run)];
            return row ? (
              <RunRow
                key={row.id}
                run={row.original}
                index={index}
                columns={row.getVisibleCells().map((cell) => byId(columns, cell.column.id))}
                lefts={lefts}
                base={base}
                isPinned={pinned.has(row.original.run)}
                hovered={row.original.run === hovered}
                selected={selected.has(row.original.run)}
                onToggle={() => onToggle(row.original.run)}
              />
            ) : null;
          })}
          <Gap height={below} width={width} />
        </tbody>
      </table>
    </div>
  );
}

/** The lines of the table: runs or, grouped, heads with the runs that belong to them, which can be folded. */
function useEntries(data: readonly ListedRun[], columns: readonly Column[], { by, sort }: RunsView) {
  const [folded, setFolded] = useState<ReadonlySet<string>>(new Set());
  const entries = useMemo((): Entry[] => {
    const column = columns.find(({ id }) => id === by);
    if (!column) return data.map((run) => ({ run }));
    const [first] = readSort(sort);
    const ranking = columns.find(({ id }) => id === first?.id);
    return entriesOf(groupsOf(data, column, ranking && first ? { column: ranking, desc: first.desc } : undefined), folded);
  }, [data, columns, by, sort, folded]);
  // What was folded by another column is nothing in this one.
  useEffect(() => setFolded(new Set()), [by]);
  const fold = (key: string) => setFolded((before) => new Set(before.has(key) ? [...before].filter((each) => each !== key) : [...before, key]));
  return { entries, fold, folded };
}

const groupKey = ({ key }: RunGroup): string => `group ${key}`;

/** The keyboard works at once: the first row in sight has the focus, and gets it back from nowhere. */
function useRowKeys(first: () => void, filled: boolean) {
  useEffect(() => {
    if (filled && !document.activeElement?.matches("input, textarea, select")) first();
  }, [filled]);
  useShortcuts({ ArrowDown: first, ArrowUp: first, j: first, k: first, J: first, K: first });
}

/** The run of the row that has the focus. */
const focusedRun = () => document.activeElement?.closest<HTMLElement>("tr[data-run]")?.dataset.run;

/** The column whose head has the focus. */
const focusedColumn = () => document.activeElement?.closest<HTMLElement>("th[data-column]")?.dataset.column;

/** Where columns begin that stay at the left, as a style; the others have none. */
type Lefts = Record<string, string>;

/** The run's number, and behind it what was pinned. */
function leftsOf(shown: readonly Column[], fixed: readonly Column[]): Lefts {
  const staying = shown.filter(({ id }) => id === "run" || fixed.some((column) => column.id === id));
  return Object.fromEntries(staying.map(({ id }, place) => [id, `var(--left-${place}, auto)`]));
}

/**
 * Where the columns that stay begin, measured: what stands in the rows that are drawn makes them wider or narrower. It goes to
 * the table as properties of its style, so no row is drawn again for it.
 */
function useOffsets(scroller: RefObject<HTMLDivElement | null>, lefts: Lefts) {
  useLayoutEffect(() => {
    const host = scroller.current;
    if (!host) return;
    const heads = [...host.querySelectorAll<HTMLElement>("thead tr + tr th")].slice(0, Object.keys(lefts).length + 1);
    const measure = () => {
      const widths = heads.map((head) => head.getBoundingClientRect().width);
      const begins = offsets(widths, host.clientWidth);
      begins.slice(1).forEach((left, place) => set(host, `--left-${place}`, left));
      set(host, "--left-group", begins.includes(undefined) ? undefined : begins[1]);
      set(host, "--staying", Math.max(0, ...begins.map((left, place) => (left === undefined ? 0 : left + (widths[place] ?? 0)))));
    };
    measure();
    const observer = new ResizeObserver(measure);
    for (const each of [host, ...heads]) observer.observe(each);
    return () => observer.disconnect();
  }, [lefts]);
}

function set({ style }: HTMLElement, name: string, px: number | undefined) {
  if (px === undefined) style.removeProperty(name);
  else style.setProperty(name, `${px}px`);
}

const byId = (columns: readonly Column[], id: string): Column =>
  columns.find((column) => column.id === id) as Column;

/** Room for the rows that are not drawn. */
function Gap({ height, width }: { height: number; width: number }) {
  return height > 0 ? (
    <tr>
      <td colSpan={width} style={{ height, padding: 0, border: 0 }} />
    </tr>
  ) : null;
}

function grouped(columns: readonly Column[], fixed: readonly Column[]): ColumnDef<typeof features, ListedRun>[] {
  const staying = fixed.length > 0 ? [...columns.filter(({ id }) => id === "run"), ...fixed] : [];
  const groups = (["pinned", "run", "parameters", "metrics", "channels"] as const).map((group) => ({
    id: group,
    header: GROUP_TITLES[group],
    columns: (group === "pinned" ? staying : columns.filter((column) => column.group === group && !staying.includes(column)))
      .map(({ id, title, value }) => ({
        id,
        header: title,
        accessorFn: (run: ListedRun) => value(run) ?? undefined,
      })),
  }));
  return groups.filter(({ columns: own }) => own.length > 0);
}

function visibility(
  columns: readonly Column[],
  runs: readonly ListedRun[],
  varyingOnly: boolean,
  hidden: readonly string[],
  fixed: readonly Column[],
): Record<string, boolean> {
  const isAsked = ({ id, group }: Column) => ALWAYS.has(id) || group === "channels" || fixed.some((each) => each.id === id);
  return Object.fromEntries(
    columns.map((column) => [
      column.id,
      !hidden.includes(column.id) && (isAsked(column) || !varyingOnly || runs.length < 2 || varies(column, runs)),
    ]),
  );
}

/** `-metric:minimum_gap` in the address is that column, falling. */
function readSort(sort: string | undefined): SortingState {
  if (!sort) return [];
  return sort.startsWith("-") ? [{ id: sort.slice(1), desc: true }] : [{ id: sort, desc: false }];
}

const writeSort = ([first]: SortingState): string | undefined =>
  first ? `${first.desc ? "-" : ""}${first.id}` : undefined;

function ordered(
  runs: readonly ListedRun[],
  columns: readonly Column[],
  sort: SortingState[number] | undefined,
  base: ListedRun | undefined,
  pinned: ReadonlySet<number>,
): ListedRun[] {
  const column = columns.find(({ id }) => id === sort?.id);
  const found = column && sort ? sorted(runs, column, sort.desc) : [...runs];
  return onTop(found, base?.run, pinned);
}

interface HeaderProps {
  column: Column;
  left: string | undefined;
  isFixed: boolean;
  sorted: false | "asc" | "desc";
  onSort: () => void;
}

const ARIA_SORT = { asc: "ascending", desc: "descending" } as const;

function SortHeader({ column, left, isFixed, sorted: direction, onSort }: HeaderProps) {
  return (
    <th
      scope="col"
      title={column.id === "run" ? column.name : `${column.name}\n${isFixed ? "p: let it go to its place" : "p: keep it at the left"}`}
      data-column={column.id}
      data-numeric={column.numeric || undefined}
      data-sticky={left !== undefined || undefined}
      style={{ left }}
      aria-sort={direction ? ARIA_SORT[direction] : "none"}
    >
      <button type="button" className={classes.sort} onClick={onSort}>
        {withUnit(column.title, column.unit)}
        {direction ? <Icon name={direction === "asc" ? "up" : "down"} size={12} /> : null}
      </button>
    </th>
  );
}

interface PickProps {
  runs: readonly ListedRun[];
  selected: ReadonlySet<number>;
  what: string;
  onPick: Props["onPick"];
}

/** Chooses many runs at once; when all of them are chosen, gives them up. */
function PickAll({ runs, selected, what, onPick }: PickProps) {
  const count = runs.reduce((sum, { run }) => sum + Number(selected.has(run)), 0);
  const isAll = count === runs.length && count > 0;
  return (
    <Checkbox
      size="xs"
      checked={isAll}
      indeterminate={count > 0 && !isAll}
      onChange={() => onPick(runs, !isAll)}
      aria-label={`Select ${what}`}
      title={`Select ${what}`}
    />
  );
}

interface GroupProps {
  group: RunGroup;
  index: number;
  columns: readonly Column[];
  lefts: Lefts;
  isOpen: boolean;
  selected: ReadonlySet<number>;
  onFold: () => void;
  onPick: Props["onPick"];
}

/** The head of a group: how many there are, and how what is shown of them spreads. */
function GroupRow({ group: { title, runs }, index, columns, lefts, isOpen, selected, onFold, onPick }: GroupProps) {
  const onKey = (event: KeyboardEvent) => {
    if (event.target !== event.currentTarget) return;
    const isWay = (event.key === "ArrowLeft" && isOpen) || (event.key === "ArrowRight" && !isOpen);
    if (event.key === "Enter" || isWay) onFold();
    if (event.key === "x") onPick(runs, !runs.every(({ run }) => selected.has(run)));
  };
  return (
    <tr tabIndex={0} data-index={index} data-heap={title} onKeyDown={onKey}>
      <td className={classes.pick}>
        <PickAll runs={runs} selected={selected} what={`the runs of ${title}`} onPick={onPick} />
      </td>
      {columns.map((column) =>
        column.id === "run" ? (
          <td key={column.id} data-sticky style={{ left: lefts[column.id] }}>
            <button type="button" tabIndex={-1} className={classes.fold} aria-expanded={isOpen} onClick={onFold}>
              <Icon name={isOpen ? "down" : "right"} size={12} />
              {title} <small>{runs.length === 1 ? "1 run" : `${runs.length} runs`}</small>
            </button>
          </td>
        ) : (
          <GroupCell key={column.id} column={column} left={lefts[column.id]} runs={runs} />
        ),
      )}
    </tr>
  );
}

function GroupCell({ column, left, runs }: { column: Column; left: string | undefined; runs: readonly ListedRun[] }) {
  const found = useMemo(() => (UNSAID.has(column.id) ? undefined : said(runs, column)), [column, runs]);
  return (
    <td data-numeric={column.numeric || undefined} data-sticky={left !== undefined || undefined} style={{ left }} title={found?.full}>
      {found?.text}
    </td>
  );
}

/** Of these every run has its own, and seeds are no quantity. */
const UNSAID = new Set(["created", "parent", "seed"]);

interface RowProps {
  run: ListedRun;
  index: number;
  columns: readonly Column[];
  lefts: Lefts;
  base: ListedRun | undefined;
  isPinned: boolean;
  hovered: boolean;
  selected: boolean;
  onToggle: () => void;
}

function RunRow({ run, index, columns, lefts, base, isPinned, hovered, selected, onToggle }: RowProps) {
  const { alike } = useGlossary();
  const navigate = useNavigate();
  const open = (event?: { target: EventTarget }) => {
    // Picking a run is not opening it.
    if (event?.target instanceof Element && event.target.closest("td")?.matches(`.${classes.pick}`)) return;
    navigate({ to: "/runs/$run", params: { run: String(run.run) } });
  };
  const onKey = (event: KeyboardEvent) => {
    if (event.key === "Enter" && event.target === event.currentTarget) open();
    if (event.key === "x" && event.target === event.currentTarget) onToggle();
  };
  return (
    <tr
      tabIndex={0}
      data-run={run.run}
      data-index={index}
      data-selected={selected || undefined}
      data-hovered={hovered || undefined}
      data-base={run.run === base?.run || undefined}
      onClick={open}
      onKeyDown={onKey}
    >
      <td className={classes.pick}>
        <Checkbox
          size="xs"
          checked={selected}
          onChange={onToggle}
          aria-label={`Select run ${run.run} to compare`}
          data-testid={`select-${run.run}`}
        />
      </td>
      {columns.map((column) => (
        <td
          key={column.id}
          data-numeric={column.numeric || undefined}
          data-sticky={lefts[column.id] !== undefined || undefined}
          style={{ left: lefts[column.id] }}
          data-stand={column.group === "metrics" ? standing(run, base, column.id.slice("metric:".length), alike) : undefined}
        >
          <Cell column={column} run={run} isBase={run.run === base?.run} isPinned={isPinned} />
        </td>
      ))}
    </tr>
  );
}

function Cell({ column, run, isBase, isPinned }: { column: Column; run: ListedRun; isBase: boolean; isPinned: boolean }) {
  const value: Json | undefined = column.value(run);
  switch (column.id) {
    case "run":
      return (
        <>
          <b>#{run.run}</b>
          {isBase ? <small title="The others are tinted against it"> baseline</small> : null}
          {isPinned ? <small title="Stays on top (p)"> pinned</small> : null}
        </>
      );
    case "status":
      return <StatusBadge status={run.status} error={run.error} unmet={run.unmet} />;
    case "verdict":
      return <VerdictBadge verdict={run.verdict} reason={run.reason} />;
    case "created":
      return formatMoment(run.created);
    case "tags":
      return run.tags.length ? run.tags.join(", ") : <span className={classes.none}>–</span>;
    case "note":
      return value ? <span className={classes.said} title={run.note}>{String(value)}</span> : <span className={classes.none}>–</span>;
    case "parent":
      return run.parent === null ? <span className={classes.none}>–</span> : `#${run.parent}`;
    case "sim_time":
      return run.sim_time_s === null ? "–" : formatNumber(Number(run.sim_time_s.toFixed(2)));
    default:
      if (value === null || value === undefined) return <Lack {...column.lack?.(run)} />;
      if (isUnranked(column, run)) return <Early run={run} value={value} />;
      return column.isSet?.(run) === false ? <Default value={value} /> : formatValue(value);
  }
}

/** Where there is no value: why, if that is known. */
function Lack({ text = "–", why }: { text?: string; why?: string }) {
  return (
    <span className={classes.none} title={why}>
      {text}
      {why ? <VisuallyHidden> {why}</VisuallyHidden> : null}
    </span>
  );
}

/** What was measured of a run that ended early stands there, but with no place among the others. */
function Early({ run, value }: { run: ListedRun; value: Json }) {
  const until = run.sim_time_s === null ? "" : ` until ${formatTime(run.sim_time_s)} s`;
  return (
    <span className={classes.early} title={`Not ranked: the run is ${run.status}, and was measured only${until}`}>
      {formatValue(value)} <small>{run.status}</small>
    </span>
  );
}

/** What a run has not set is as its scenario has it. */
function Default({ value }: { value: Json }) {
  return (
    <span className={classes.default} title="Not set: as the run's scenario has it">
      {formatValue(value)}
      <VisuallyHidden> (not set)</VisuallyHidden>
    </span>
  );
}
