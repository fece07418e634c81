/** A channel in a few numbers: of which channels, and between which times. */

import type { RunDetail, Server } from "./run";

export const NAMES: Record<Server["Aggregate"]["kind"], string> = {
  min: "Minimum",
  max: "Maximum",
  mean: "Mean",
  p5: "5th percentile",
  p95: "95th percentile",
  at_event: "At the event",
};

/** The channels that all runs have recorded, in the order of the first. */
export function common(runs: readonly Pick<RunDetail, "channels">[]): RunDetail["channels"] {
  const [first, ...others] = runs.map(({ channels }) => channels);
  const had = others.map((channels) => new Set(channels.map(({ name }) => name)));
  return (first ?? []).filter(({ name }) => had.every((names) => names.has(name)));
}

/** A time that was typed [s]; undefined where nothing was, null for what is no number. */
export function boundOf(text: string): number | undefined | null {
  const typed = text.trim().replace(",", ".");
  if (typed === "") return undefined;
  return Number.isFinite(Number(typed)) ? Number(typed) : null;
}
