/** Runs of a table in groups that agree in one column, and what can be said of a group as a whole. */

import type { Json, ListedRun } from "./run";
import { type Column, isResult, isUnranked } from "./table";
import { formatNumber, formatValue, withUnit } from "./units";

export interface RunGroup {
  /** The value that its runs agree in, as JSON; null of those that have none. */
  key: string;
  title: string;
  runs: ListedRun[];
}

/** A line of the table: the head of a group, or a run. */
export type Entry = { group: RunGroup; run?: undefined } | { run: ListedRun; group?: undefined };

/** Of these nobody makes groups: every run has its own. */
const UNLIKE = new Set(["run", "created", "sim_time"]);

/** The columns by which runs may be grouped: what was said and set, and not what came out. */
export const groupable = (columns: readonly Column[]): Column[] =>
  columns.filter((column) => !isResult(column) && !UNLIKE.has(column.id));

/** The groups of runs; their runs keep their order. Groups stand as their means do in the column that is sorted by, else as they come. */
export function groupsOf(runs: readonly ListedRun[], by: Column, sort?: { column: Column; desc: boolean }): RunGroup[] {
  const found = new Map<string, RunGroup>();
  for (const run of runs) {
    const key = keyOf(by.value(run));
    const group = found.get(key) ?? { key, title: titleOf(by, by.value(run)), runs: [] };
    group.runs.push(run);
    found.set(key, group);
  }
  const groups = [...found.values()];
  return sort ? ranked(groups, sort.column, sort.desc) : groups;
}

const keyOf = (value: Json | undefined): string =>
  JSON.stringify(value === undefined || value === "" ? null : Array.isArray(value) ? [...value].sort() : value);

function titleOf(by: Column, value: Json | undefined): string {
  const name = withUnit(by.title, by.unit);
  if (value === null || value === undefined || value === "" || (Array.isArray(value) && value.length === 0)) return `${name}: none`;
  if (by.id === "parent") return `${name} #${value}`;
  return `${name} ${Array.isArray(value) ? value.join(", ") : formatValue(value)}`;
}

/** Groups by their means; those without one come last, up and down, and a column without numbers leaves them alone. */
function ranked(groups: readonly RunGroup[], column: Column, desc: boolean): RunGroup[] {
  const means = new Map(groups.map((group) => [group, summary(group.runs, column)?.mean]));
  const order = (one?: number, other?: number) =>
    one === undefined || other === undefined ? Number(one === undefined) - Number(other === undefined) : (one - other) * (desc ? -1 : 1);
  return [...groups].sort((one, other) => order(means.get(one), means.get(other)));
}

/** The lines of the table; of a folded group only its head. */
export const entriesOf = (groups: readonly RunGroup[], folded: ReadonlySet<string>): Entry[] =>
  groups.flatMap((group): Entry[] => [{ group }, ...(folded.has(group.key) ? [] : group.runs.map((run) => ({ run })))]);

/** How the numbers of a column spread over runs. */
export interface Summary {
  count: number;
  mean: number;
  /** Standard deviation of the sample; 0 of a single one. */
  deviation: number;
  least: number;
  most: number;
}

/** The spread over the runs that have a number there; metrics of runs that ended early are not among them. */
export function summary(runs: readonly ListedRun[], column: Column): Summary | undefined {
  if (!column.numeric) return undefined;
  const values = runs.flatMap((run) => {
    const value = isUnranked(column, run) ? undefined : column.value(run);
    return typeof value === "number" && Number.isFinite(value) ? [value] : [];
  });
  return values.length ? spread(values) : undefined;
}

function spread(values: readonly number[]): Summary {
  const count = values.length;
  const mean = values.reduce((sum, value) => sum + value, 0) / count;
  const squares = values.reduce((sum, value) => sum + (value - mean) ** 2, 0);
  // One by one: of so many arguments as there are runs a call may have too many.
  const least = values.reduce((one, other) => Math.min(one, other));
  const most = values.reduce((one, other) => Math.max(one, other));
  return { count, mean, deviation: Math.sqrt(squares / Math.max(count - 1, 1)), least, most };
}

/** What a group says in a column, in short and in full; nothing where its runs have nothing. */
export function said(runs: readonly ListedRun[], column: Column): { text: string; full: string } | undefined {
  const found = summary(runs, column);
  if (found) return isResult(column) ? spreadText(found, column) : rangeText(found, column);
  const texts = new Set(runs.map((run) => valueText(column.value(run))));
  texts.delete("–");
  if (texts.size === 0) return undefined;
  const all = [...texts].slice(0, 12).join(", ");
  return texts.size === 1 ? { text: all, full: all } : { text: `${texts.size} values`, full: texts.size > 12 ? `${all}, …` : all };
}

const valueText = (value: Json | undefined): string => (Array.isArray(value) ? value.join(", ") || "–" : formatValue(value));

function spreadText({ count, mean, deviation, least, most }: Summary, { title, unit }: Column) {
  const text = count > 1 ? `${formatNumber(mean)} ± ${short(deviation)}` : formatNumber(mean);
  const of = count > 1 ? `mean and standard deviation of ${count} runs, from ${formatNumber(least)} to ${formatNumber(most)}` : "of one run";
  return { text, full: `${withUnit(title, unit)}: ${of}` };
}

function rangeText({ count, least, most }: Summary, { title, unit }: Column) {
  const text = least === most ? formatNumber(least) : `${formatNumber(least)} … ${formatNumber(most)}`;
  return { text, full: `${withUnit(title, unit)} of ${count} run${count > 1 ? "s" : ""}` };
}

/** A deviation is not known better than to two digits. */
const short = (value: number): string => formatNumber(Number(value.toPrecision(2)));
