/** Two runs side by side: verdicts in words, and traces on one time axis. */

import type { Filled, Json, Server, Trace } from "./run";

export type ParameterDifference = Filled<Server["ParameterDifference"], { a: Json; b: Json }>;
export type MetricDifference = Server["MetricDifference"];

export type Verdict = "better" | "worse" | "same" | "no goal" | "not ranked" | "missing";

/** How B stands against A in this metric. */
export function verdict({ a, b, better, goal }: MetricDifference, unranked = ""): Verdict {
  if (a === null || b === null) return "missing";
  if (unranked) return "not ranked";
  if (goal === null || better === null) return "no goal";
  return better === "same" ? "same" : better === "b" ? "better" : "worse";
}

/** How often each verdict was given. */
export function tally(metrics: readonly MetricDifference[], unranked = ""): Record<Verdict, number> {
  const counts: Record<Verdict, number> = { better: 0, worse: 0, same: 0, "no goal": 0, "not ranked": 0, missing: 0 };
  for (const metric of metrics) counts[verdict(metric, unranked)] += 1;
  return counts;
}

/** [1] Of the greater value: a smaller difference is what rounding has left. */
const ROUNDING = 1e-9;

/** The difference, and that over the value of A, without what rounding has left of equal values. */
export function differing({ a, b, difference, relative }: MetricDifference): Pick<MetricDifference, "difference" | "relative"> {
  if (a === null || b === null || difference === null) return { difference, relative };
  const equal = Math.abs(difference) <= ROUNDING * Math.max(Math.abs(a), Math.abs(b), 1);
  return equal ? { difference: 0, relative: 0 } : { difference, relative };
}

/** Values on a merged time axis: `undefined` where the run has no sample there, `null` where it has a gap. */
export type Merged = [number[], ...(number | null | undefined)[][]];

/** Both traces' channels over the union of their times. */
export function merge(a: Trace, b: Trace, channels: readonly string[]): Merged {
  const time = [...new Set([...a.time, ...b.time])].sort((one, other) => one - other);
  const columns = [a, b].flatMap((trace) => {
    const at = new Map(trace.time.map((t, index) => [t, index]));
    return channels.map((name) => {
      const values = trace.channels[name]?.values;
      return time.map((t) => (at.has(t) && values ? values[at.get(t) as number] : undefined));
    });
  });
  return [time, ...columns];
}
