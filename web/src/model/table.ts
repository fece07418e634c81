/** The table of runs: its columns, their order, and which of them say something. */

import { plain } from "./note";
import { unitAt } from "./form";
import { explained, type Measure, titleOf } from "./measure";
import type { Json, ListedRun } from "./run";
import { isWhole, shortNames } from "./run";
import { formatValue, words } from "./units";

export type Group = "run" | "parameters" | "metrics" | "channels";

export interface Column {
  id: string;
  group: Group;
  title: string;
  unit: string;
  /** The full name, for the tooltip. */
  name: string;
  /** Numbers stand on the right, so that their digits can be compared. */
  numeric: boolean;
  value: (run: ListedRun) => Json | undefined;
  /** Of a parameter: whether the run has set it; else it is as the run's scenario has it. */
  isSet?: (run: ListedRun) => boolean;
  /** Of a channel in one number: what stands where there is none, and why. */
  lack?: (run: ListedRun) => { text: string; why: string };
}

/** What every run has, whatever was set or measured. */
export const RUN_COLUMNS: Column[] = ([
  { id: "run", title: "Run", unit: "", name: "Number of the run", numeric: false, value: ({ run }) => run },
  { id: "scenario", title: "Scenario", unit: "", name: "Scenario", numeric: false, value: ({ scenario }) => scenario },
  { id: "status", title: "Status", unit: "", name: "Status", numeric: false, value: ({ status }) => status },
  { id: "verdict", title: "Verdict", unit: "", name: "What was decided about it (C: candidate, D: discarded)", numeric: false, value: ({ verdict }) => verdict },
  { id: "name", title: "Name", unit: "", name: "What it was called", numeric: false, value: ({ name }) => name },
  { id: "tags", title: "Tags", unit: "", name: "What it is found by", numeric: false, value: ({ tags }) => tags },
  { id: "note", title: "Note", unit: "", name: "What was written about it", numeric: false, value: ({ note }) => plain(note) || null },
  { id: "parent", title: "Parent", unit: "", name: "The run it descends from", numeric: false, value: ({ parent }) => parent },
  { id: "created", title: "Created", unit: "", name: "When it was started", numeric: false, value: ({ created }) => created },
  { id: "seed", title: "Seed", unit: "", name: "Seed of the random numbers", numeric: true, value: ({ seed }) => seed },
  { id: "sim_time", title: "Simulated", unit: "s", name: "Simulated time", numeric: true, value: ({ sim_time_s }) => sim_time_s },
] satisfies Omit<Column, "group">[]).map((column) => ({ ...column, group: "run" as const }));

/** One column for every parameter that any run set; every run has its value there, whether it was set or not. */
export function parameterColumns(runs: readonly ListedRun[], units: Record<string, string>): Column[] {
  const paths = [...new Set(runs.flatMap(({ settings }) => Object.keys(settings)))].sort();
  const short = shortNames(paths);
  return paths.map((path) => ({
    id: `parameter:${path}`,
    group: "parameters",
    title: words(short[path] ?? path),
    unit: unitAt(units, path),
    name: path,
    numeric: runs.every(({ settings }) => settings[path] === undefined || typeof settings[path] === "number"),
    value: ({ settings }) => settings[path],
    isSet: ({ parameters }) => Object.keys(parameters).some((set) => set === path || path.startsWith(`${set}.`)),
  }));
}

/** One column for every metric that any run has; `known` are the server's words for them. */
export function metricColumns(runs: readonly ListedRun[], known: readonly Measure[]): Column[] {
  const units = new Map(
    runs.flatMap(({ metrics }) => Object.entries(metrics).map(([name, { unit }]) => [name, unit] as const)),
  );
  return [...units].map(([name, unit]) => ({
    id: `metric:${name}`,
    group: "metrics",
    title: titleOf(name, known),
    unit,
    name: explained(name, known),
    numeric: true,
    value: ({ metrics }) => metrics[name]?.value,
  }));
}

/** Whether the runs disagree in this column; a missing value is a value of its own. */
export function varies(column: Column, runs: readonly ListedRun[]): boolean {
  const first = runs[0];
  if (!first) return false;
  const text = (run: ListedRun) => JSON.stringify(column.value(run) ?? null);
  return runs.some((run) => text(run) !== text(first));
}

const missing = (value: Json | undefined): boolean =>
  value === null || value === undefined || value === "" || (typeof value === "number" && Number.isNaN(value));

/** Ascending order of two values of one column: numbers by size, the rest by text. */
function order(a: Json | undefined, b: Json | undefined): number {
  if (typeof a === "number" && typeof b === "number") return a - b;
  return formatValue(a).localeCompare(formatValue(b), "en", { numeric: true });
}

/** What came out of a run, and was not set. */
export const isResult = ({ group }: Pick<Column, "group">): boolean => group === "metrics" || group === "channels";

/** Whether a result of this run has no place among those of others, since it was measured of less than a whole run. */
export const isUnranked = (column: Pick<Column, "group">, run: ListedRun): boolean => isResult(column) && !isWhole(run);

/**
 * Sort by a column; equals keep their order. Last in both directions come what is missing and, before it, metrics of runs
 * that ended early.
 */
export function sorted(
  runs: readonly ListedRun[],
  { group, value }: Pick<Column, "group" | "value">,
  descending: boolean,
): ListedRun[] {
  const rank = (run: ListedRun) => (missing(value(run)) ? 2 : isUnranked({ group }, run) ? 1 : 0);
  return [...runs].sort((one, other) => {
    const [a, b] = [value(one), value(other)];
    return rank(one) - rank(other) || (descending ? order(b, a) : order(a, b));
  });
}

/** What stands in the row of a run, in small letters, to look for words in. */
export function textOf(run: ListedRun): string {
  const had = Object.entries(run.settings).map(([path, value]) => `${path}=${formatValue(value)}`);
  return [
    `#${run.run}`,
    run.scenario,
    run.status,
    run.error ?? "",
    run.verdict,
    run.reason,
    run.name,
    ...run.tags,
    `seed=${run.seed}`,
    `parent=${run.parent ?? ""}`,
    ...had,
  ]
    .join(" ")
    .toLowerCase();
}
