/** The goals of a scenario, and how far a run is from them. */

import type { Json, RunDetail } from "./run";
import { isTree } from "./schema";

export interface Wanted {
  metric: string;
  bound: "least" | "most";
  wanted: number;
  value: number | null;
  unit: string;
  /** By how much the goal is met; negative when it is missed, null when nothing was measured. */
  margin: number | null;
}

/** Every goal of the run's scenario; one that is bounded on both sides makes two. */
export function goalsOf({ document, metrics }: Pick<RunDetail, "document" | "metrics">): Wanted[] {
  const goals: Json | undefined = document.goals;
  if (!isTree(goals)) return [];
  return Object.entries(goals).flatMap(([metric, goal]) =>
    (["least", "most"] as const).flatMap((bound): Wanted[] => {
      const wanted = isTree(goal) ? goal[bound] : undefined;
      if (typeof wanted !== "number") return [];
      const { value = null, unit = "" } = metrics[metric] ?? {};
      const margin = value === null ? null : bound === "least" ? value - wanted : wanted - value;
      return [{ metric, bound, wanted, value, unit, margin }];
    }),
  );
}
