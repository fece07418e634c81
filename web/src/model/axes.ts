/** Axes over which runs are drawn: numbers that were set or measured, and where a value stands on them. */

import type { Bound } from "./filter";
import type { ListedRun } from "./run";
import { type Column, isUnranked, varies } from "./table";

export interface Axis {
  column: Column;
  low: number;
  high: number;
  /** The highest value is below. */
  isFlipped?: boolean;
  /** Equal ratios are equally long; of positive values alone. */
  isLog?: boolean;
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

/** Where a value stands: 0 at the lower end of the axis, 1 at the upper one. */
function placeOf({ low, high, isFlipped, isLog }: Axis, value: number): number {
  const place = isLog ? Math.log(value / low) / Math.log(high / low) : (value - low) / (high - low);
  return isFlipped ? 1 - place : place;
}

/** The same of a run; nothing where it has no value. */
export function placeOn(axis: Axis, run: ListedRun): number | undefined {
  const value = numberOf(axis.column, run);
  return value === undefined ? undefined : placeOf(axis, value);
}

/** The value at a place of an axis. */
export function valueAt({ low, high, isFlipped, isLog }: Axis, place: number): number {
  const inside = Math.min(1, Math.max(0, place));
  const share = isFlipped ? 1 - inside : inside;
  return isLog ? low * (high / low) ** share : low + share * (high - low);
}

/** From the least to the greatest of the values at two places. */
export const rangeAt = (axis: Axis, places: readonly number[]): Range =>
  places.map((place) => valueAt(axis, place)).sort((one, other) => one - other) as unknown as Range;

/** Between which places of an axis a filter keeps the runs; nothing when it says nothing of it. */
export function rangeOf(axis: Axis, bounds: readonly Bound[]): Range | undefined {
  const { column, low, high } = axis;
  const own = bounds.filter((bound) => bound.column === column.id && bound.sign !== "!=");
  if (own.length === 0) return undefined;
  const least = Math.max(low, ...own.flatMap(({ sign, value }) => (sign.startsWith(">") || sign === "=" ? value : [])));
  const most = Math.min(high, ...own.flatMap(({ sign, value }) => (sign.startsWith("<") || sign === "=" ? value : [])));
  const places = [least, most].map((value) => Math.min(1, Math.max(0, placeOf(axis, Math.min(high, Math.max(low, value))))));
  return places.sort((one, other) => one - other) as unknown as Range;
}

// -- how somebody wants them ---------------------------------------------------------------------------

const [FLIPPED, LOG] = ["!flipped", "!log"];

/** An axis in an address: its column, and how it is drawn. */
export const axisText = ({ column, isFlipped, isLog }: Axis): string => `${column.id}${isFlipped ? FLIPPED : ""}${isLog ? LOG : ""}`;

/** The axis that an address names; none that is not there, and no logarithm of what is not positive. */
export function axisOf(text: string, all: readonly Axis[]): Axis | undefined {
  const [id = ""] = text.split("!");
  const found = all.find(({ column }) => column.id === id);
  return found && { ...found, isFlipped: text.includes(FLIPPED), isLog: text.includes(LOG) && canBeLog(found) };
}

export const canBeLog = ({ low }: Axis): boolean => low > 0;

/** The axes with one of them at another place. */
export function reordered(axes: readonly Axis[], from: number, to: number): Axis[] {
  const next = [...axes];
  next.splice(Math.min(axes.length - 1, Math.max(0, to)), 0, ...next.splice(from, 1));
  return next;
}

/** The axes with one of them changed. */
export const changed = (axes: readonly Axis[], at: number, change: Partial<Axis>): Axis[] =>
  axes.map((axis, place) => (place === at ? { ...axis, ...change } : axis));
