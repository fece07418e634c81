/** Axes over which runs are drawn: numbers that were set or measured, and where a value stands on them. */

import type { Bound } from "./filter";
import type { ListedRun } from "./run";
import { type Column, isUnranked, varies } from "./table";

export interface Axis {
  column: Column;
  low: number;
  high: number;
}

/** From which value to which. */
export type Range = readonly [number, number];

/** The number that a run has there; none of a metric that has no place among the others. */
export function numberOf(column: Column, run: ListedRun): number | undefined {
  const value = column.value(run);
  return typeof value === "number" && Number.isFinite(value) && !isUnranked(column, run) ? value : undefined;
}

/** All axes that tell runs apart: of numbers of which there are two at least. */
export function axesOf(columns: readonly Column[], runs: readonly ListedRun[]): Axis[] {
  return columns.flatMap((column) => {
    if (!column.numeric || (column.group === "run" && column.id !== "seed") || !varies(column, runs)) return [];
    const values = runs.flatMap((run) => numberOf(column, run) ?? []);
    const [low, high] = values.reduce(([least, most], value) => [Math.min(least, value), Math.max(most, value)], [Infinity, -Infinity]);
    return low < high ? [{ column, low, high }] : [];
  });
}

/** So many of each are shown until somebody chooses. */
const FIRST = { parameters: 4, metrics: 4 };

/** What is shown at first: what was set, and metrics of which one direction is better, by what the goals of the runs ask for. */
export function firstAxes(axes: readonly Axis[], runs: readonly ListedRun[]): string[] {
  const of = (group: "parameters" | "metrics") => axes.filter(({ column }) => column.group === group);
  const asked = new Set(runs.flatMap(({ unmet }) => unmet.map((name) => `metric:${name}`)));
  const directed = ({ column }: Axis) => runs.some((run) => run.metrics[column.id.slice("metric:".length)]?.goal);
  const rank = (axis: Axis) => (asked.has(axis.column.id) ? 0 : directed(axis) ? 1 : 2);
  const metrics = of("metrics").sort((one, other) => rank(one) - rank(other));
  return [...of("parameters").slice(0, FIRST.parameters), ...metrics.slice(0, FIRST.metrics)].map(({ column }) => column.id);
}

/** 0 at the lowest value, 1 at the highest; nothing where a run has none. */
export function placeOn({ column, low, high }: Axis, run: ListedRun): number | undefined {
  const value = numberOf(column, run);
  return value === undefined ? undefined : (value - low) / (high - low);
}

/** The value at a place of an axis. */
export const valueAt = ({ low, high }: Axis, place: number): number => low + Math.min(1, Math.max(0, place)) * (high - low);

/** Between which places of an axis a filter keeps the runs; nothing when it says nothing of it. */
export function rangeOf({ column, low, high }: Axis, bounds: readonly Bound[]): Range | undefined {
  const own = bounds.filter((bound) => bound.column === column.id && bound.sign !== "!=");
  if (own.length === 0) return undefined;
  const least = Math.max(low, ...own.flatMap(({ sign, value }) => (sign.startsWith(">") || sign === "=" ? value : [])));
  const most = Math.min(high, ...own.flatMap(({ sign, value }) => (sign.startsWith("<") || sign === "=" ? value : [])));
  const place = (value: number) => Math.min(1, Math.max(0, (value - low) / (high - low)));
  return [place(least), place(most)];
}
