/** Where vehicles were outside the span that they were validated for: what of it concerns a chart, and what led farthest, in words. */

import type { Server } from "./run";
import { formatNumber, unitText, words } from "./units";

export type Spanned = Server["Spanned"];
type Stretch = Server["Beyond"];

/** A part of a time axis [s]. */
export type Part = readonly [begin: number, end: number];

/** What a chart, or a timeline, has to show of it. */
export interface Beyond {
  parts: readonly Part[];
  /** The worst of all: whose, which quantity, how far. */
  worst: string;
  /** The same of every vehicle, a line each. */
  all: string;
  /** How far the worst was outside, in the width of its span. */
  far: number;
}

/** That of some vehicles; nothing when none of them left its span. */
export function beyondOf(known: readonly Spanned[] | undefined, vehicles?: readonly string[]): Beyond | undefined {
  const left = (known ?? []).filter(({ vehicle, stretches }) => stretches.length > 0 && (vehicles?.includes(vehicle) ?? true));
  const told = left
    .map(({ vehicle, stretches, not_recorded }) => ({ vehicle, stretch: stretches.reduce(farther), not_recorded }))
    .sort((a, b) => farness(b.stretch) - farness(a.stretch));
  const [worst] = told;
  if (!worst) return undefined;
  return {
    parts: union(left.flatMap(({ stretches }) => stretches.map(({ begin, end }): Part => [begin, end]))),
    worst: inWords(worst.vehicle, worst.stretch),
    far: farness(worst.stretch),
    all: told.map(({ vehicle, stretch, not_recorded }) => inWords(vehicle, stretch) + lacking(not_recorded)).join("\n"),
  };
}

/** That of runs beside each other, on the clock of the first: each begins so much later [s] than that. Lines say whose they are. */
export function beyondOfRuns(found: readonly { name: string; offset: number; beyond: Beyond | undefined }[]): Beyond | undefined {
  const left = found.flatMap(({ name, offset, beyond }) => (beyond ? [{ name, offset, beyond }] : []));
  if (left.length === 0) return undefined;
  const { name, beyond } = left.reduce((a, b) => (b.beyond.far > a.beyond.far ? b : a));
  return {
    parts: union(left.flatMap(({ offset, beyond: { parts } }) => parts.map(([begin, end]): Part => [begin - offset, end - offset]))),
    worst: `${name}: ${beyond.worst}`,
    far: beyond.far,
    all: left.map(({ name, beyond }) => `${name}:\n${beyond.all}`).join("\n"),
  };
}

/** How far outside, in the width of the span. */
export const farness = ({ value, low, high }: Stretch): number => Math.max(low - value, value - high, 0) / Math.max(high - low, 1e-9);

const farther = (a: Stretch, b: Stretch): Stretch => (farness(b) > farness(a) ? b : a);

function inWords(vehicle: string, { quantity, value, low, high, unit }: Stretch): string {
  const span = low === high ? "never validated" : `validated from ${formatNumber(low)} to ${formatNumber(high)} ${unitText(unit)}`;
  return `${words(vehicle)}, ${words(quantity).toLowerCase()} ${formatNumber(value)} ${unitText(unit)}, ${span}`;
}

const lacking = (names: readonly string[]): string =>
  names.length ? ` (${names.map((name) => words(name).toLowerCase()).join(", ")} not recorded)` : "";

/** Parts in the order of time, those that touch as one. */
export function union(parts: readonly Part[]): Part[] {
  const found: [number, number][] = [];
  for (const [begin, end] of [...parts].sort((a, b) => a[0] - b[0])) {
    const last = found.at(-1);
    if (last && begin <= last[1]) last[1] = Math.max(last[1], end);
    else found.push([begin, end]);
  }
  return found;
}
