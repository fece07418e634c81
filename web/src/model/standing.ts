/** How a metric of a run stands against that of a baseline. */

import { isWhole, type ListedRun } from "./run";

export type Standing = "better" | "worse" | "same";

/** In any unit, as the server has it: nobody measures finer on the road. */
export const FINEST = 1e-3;

/**
 * Better, worse or the same, as the server compares; nothing where one has no value, ended early, or no direction is better.
 * Values that differ by less than `alike` [1] of the greater one are the same.
 */
export function standing(run: ListedRun, base: ListedRun | undefined, metric: string, alike: number): Standing | undefined {
  if (!base || base.run === run.run || !isWhole(run) || !isWhole(base)) return undefined;
  const [own, other] = [run.metrics[metric], base.metrics[metric]];
  const [a, b] = [other?.value ?? null, own?.value ?? null];
  if (a === null || b === null) return undefined;
  if (Math.abs(b - a) <= Math.max(alike * Math.max(Math.abs(a), Math.abs(b)), FINEST)) return "same";
  if (!own?.goal) return undefined;
  return b > a === (own.goal === "higher") ? "better" : "worse";
}
