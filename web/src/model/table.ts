/** The table of runs: its columns, their order, and which of them say something. */

import { unitAt } from "./form";
import { explained, type Measure, titleOf } from "./measure";
import type { Json, ListedRun } from "./run";
import { isWhole, shortNames } from "./run";
import { formatValue, words } from "./units";

export type Group = "run" | "parameters" | "metrics";

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
}

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

/** Whether a metric of this run has no place among those of others, since it was measured of less than a whole run. */
export const isUnranked = ({ group }: Pick<Column, "group">, run: ListedRun): boolean => group === "metrics" && !isWhole(run);

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

/** Runs whose visible text holds every word of the query. */
export function filtered(runs: readonly ListedRun[], query: string): ListedRun[] {
  const needles = query.toLowerCase().split(/\s+/).filter(Boolean);
  if (needles.length === 0) return [...runs];
  return runs.filter((run) => {
    const text = searchText(run);
    return needles.every((needle) => text.includes(needle));
  });
}

function searchText(run: ListedRun): string {
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
