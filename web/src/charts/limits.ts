/**
 * The limits of a chart's axis: all that curves do, but not needles.
 *
 * A time gap grows without bound as a car comes to a stand, and one such needle would press everything else into a line at the foot.
 * A needle is a tail of a curve's values that is longer than all the rest of them, holds little of the time that is shown, and grows
 * thinner outwards. A hard brake is none, however short: it stays at its peak for a while. Whoever zooms into a needle sees it.
 */

import type { Columns } from "./TimeChart";
import type { Span } from "./zoom";

export interface Limits {
  low: number;
  high: number;
  /** The least and the greatest value beyond the limits. */
  below?: number;
  above?: number;
}

/** [1] Of the time that is shown: the tails of a curve. */
const TAIL = 0.02;
/** [1] Of that time: the outer half of a needle holds less. */
const SLENDER = 0.01;
/** [1] Of a tail's time: the outer half of a needle holds less. */
const THINNER = 1 / 3;

/** [1] Of the axis: what reaches beyond it by less is hardly a pixel, and belongs to it. */
const SLIGHT = 0.02;

/** A straight piece of a curve: its lower and its upper value, and how long it takes [s]. */
type Piece = readonly [low: number, high: number, time: number];

/** The limits for what is seen between two times; none where nothing is seen. */
export function limitsOf([time, ...columns]: Columns, span?: Span): Limits | undefined {
  const [first, last] = seen(time, span);
  const curves = columns.map((column) => pieces(time, column, first, last)).filter((curve) => curve.length > 0);
  if (curves.length === 0) return undefined;
  const [least, low] = [greatestOf, upper].map((end) => -Math.max(...curves.map((curve) => end(negative(curve))))) as [number, number];
  const [greatest, high] = [greatestOf, upper].map((end) => Math.max(...curves.map(end))) as [number, number];
  const slight = SLIGHT * (high - low);
  return {
    ...(low - least > slight ? { low, below: least } : { low: least }),
    ...(greatest - high > slight ? { high, above: greatest } : { high: greatest }),
  };
}

/** The samples between two times, from the first up to before the last. */
function seen(time: readonly number[], span: Span | undefined): [number, number] {
  if (!span) return [0, time.length];
  const first = time.findIndex((t) => t >= span[0]);
  const beyond = time.findIndex((t) => t > span[1]);
  return [first < 0 ? time.length : first, beyond < 0 ? time.length : beyond];
}

/** The pieces of a curve from sample to sample, none over a gap; a sample by itself takes no time. */
function pieces(time: readonly number[], column: Columns[number], first: number, last: number): Piece[] {
  const found: Piece[] = [];
  let before: { value: number; t: number } | undefined;
  for (let i = first; i < last; i += 1) {
    const [value, t] = [column[i], time[i] as number];
    if (value === undefined) continue; // only the other run has a sample there
    const own = typeof value === "number" && Number.isFinite(value) ? { value, t } : undefined;
    if (own) {
      const from = before ?? own;
      found.push([Math.min(from.value, own.value), Math.max(from.value, own.value), t - from.t]);
    }
    before = own;
  }
  return found;
}

const negative = (curve: readonly Piece[]): Piece[] => curve.map(([low, high, time]) => [-high, -low, time]);

const greatestOf = (curve: readonly Piece[]): number => curve.reduce((most, [, high]) => Math.max(most, high), -Infinity);

/** Up to where a curve is shown: its greatest value, or where its needles begin. */
function upper(curve: readonly Piece[]): number {
  const greatest = greatestOf(curve);
  const total = curve.reduce((sum, [, , time]) => sum + time, 0);
  const end = exceeded(curve, TAIL * total);
  const body = end + exceeded(negative(curve), TAIL * total);
  const outer = timeAbove(curve, (end + greatest) / 2);
  const isNeedle = greatest - end > body && outer < SLENDER * total && outer < THINNER * timeAbove(curve, end);
  return isNeedle ? end : greatest;
}

/** Halvings of a range of values: finer than a pixel of any screen. */
const HALVINGS = 20;

/** The value that a curve exceeds for just a time [s]. */
function exceeded(curve: readonly Piece[], time: number): number {
  let [low, high] = [-greatestOf(negative(curve)), greatestOf(curve)];
  for (let i = 0; i < HALVINGS; i += 1) {
    const middle = (low + high) / 2;
    if (timeAbove(curve, middle) > time) low = middle;
    else high = middle;
  }
  return high;
}

/** For how long a curve is above a value [s]. */
function timeAbove(curve: readonly Piece[], value: number): number {
  let sum = 0;
  for (const [low, high, time] of curve) if (high > value) sum += low >= value ? time : (time * (high - value)) / (high - low);
  return sum;
}
