/** The table of runs: its columns, their order, and which of them say something. */

import { fromSet, unitAt } from "./form";
import { explained, type Measure, titleOf } from "./measure";
import type { Json, Run } from "./run";
import { shortNames } from "./run";
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
  value: (run: Run) => Json | undefined;
}

/** One column for every parameter that any run set. */
export function parameterColumns(runs: readonly Run[], units: Record<string, string>): Column[] {
  const set = new Map(runs.map((run) => [run.run, fromSet(run.parameters)]));
  const paths = [...new Set([...set.values()].flatMap((changes) => Object.keys(changes)))].sort();
  const short = shortNames(paths);
  return paths.map((path) => ({
    id: `parameter:${path}`,
    group: "parameters",
    title: words(short[path] ?? path),
    unit: unitAt(units, path),
    name: path,
    numeric: [...set.values()].every(
      (changes) => changes[path] === undefined || typeof changes[path] === "number",
    ),
    value: ({ run }) => set.get(run)?.[path],
  }));
}

/** One column for every metric that any run has; `known` are the server's words for them. */
export function metricColumns(runs: readonly Run[], known: readonly Measure[]): Column[] {
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
export function varies(column: Column, runs: readonly Run[]): boolean {
  const first = runs[0];
  if (!first) return false;
  const text = (run: Run) => JSON.stringify(column.value(run) ?? null);
  return runs.some((run) => text(run) !== text(first));
}

const missing = (value: Json | undefined): boolean =>
  value === null || value === undefined || value === "" || (typeof value === "number" && Number.isNaN(value));

/** Ascending order of two values of one column: numbers by size, the rest by text. */
function order(a: Json | undefined, b: Json | undefined): number {
  if (typeof a === "number" && typeof b === "number") return a - b;
  return formatValue(a).localeCompare(formatValue(b), "en", { numeric: true });
}

/** Sort by a column; what is missing comes last in both directions, and equals keep their order. */
export function sorted(runs: readonly Run[], value: Column["value"], descending: boolean): Run[] {
  return [...runs].sort((one, other) => {
    const [a, b] = [value(one), value(other)];
    if (missing(a) || missing(b)) return Number(missing(a)) - Number(missing(b));
    return descending ? order(b, a) : order(a, b);
  });
}

/** Runs whose visible text holds every word of the query. */
export function filtered(runs: readonly Run[], query: string): Run[] {
  const needles = query.toLowerCase().split(/\s+/).filter(Boolean);
  if (needles.length === 0) return [...runs];
  return runs.filter((run) => {
    const text = searchText(run);
    return needles.every((needle) => text.includes(needle));
  });
}

function searchText(run: Run): string {
  const set = Object.entries(run.parameters).map(([path, value]) => `${path}=${formatValue(value)}`);
  return [
    `#${run.run}`,
    run.scenario,
    run.status,
    run.error ?? "",
    `seed=${run.seed}`,
    `parent=${run.parent ?? ""}`,
    ...set,
  ]
    .join(" ")
    .toLowerCase();
}
