/** How metrics spread over the seeds of one setting: what chance alone makes of it. */

import { isWhole, type Run } from "./run";

export interface Spread {
  metric: string;
  unit: string;
  /** Runs that have a value. */
  count: number;
  mean: number;
  /** Standard deviation of the sample; 0 of a single one. */
  deviation: number;
  least: { value: number; run: number };
  most: { value: number; run: number };
}

type Setting = Pick<Run, "scenario_hash" | "code_version">;

/** Whether only the seeds of two runs differ: the code of the studio and of its kinds is part of a setting. */
export const isSameSetting = (one: Setting, other: Setting): boolean =>
  one.scenario_hash === other.scenario_hash && one.code_version === other.code_version;

/** The whole runs of the same setting as one run, each seed once, the newest of a seed; that run among them. */
export function alike<Some extends Run>(runs: readonly Some[], run: Setting): Some[] {
  const bySeed = new Map<number, Some>();
  for (const each of runs) if (isWhole(each) && isSameSetting(each, run) && !bySeed.has(each.seed)) bySeed.set(each.seed, each);
  return [...bySeed.values()].sort((one, other) => one.seed - other.seed);
}

/** The spread of every metric that two runs have. */
export function spreadOf(runs: readonly Run[]): Spread[] {
  const names = [...new Set(runs.flatMap(({ metrics }) => Object.keys(metrics)))];
  return names.flatMap((metric) => {
    const found = runs.flatMap(({ run, metrics }) => {
      const value = metrics[metric]?.value ?? null;
      return value === null ? [] : [{ value, run }];
    });
    return found.length > 1 ? [spread(metric, runs.find(({ metrics }) => metrics[metric])?.metrics[metric]?.unit ?? "", found)] : [];
  });
}

function spread(metric: string, unit: string, found: readonly { value: number; run: number }[]): Spread {
  const sorted = [...found].sort((one, other) => one.value - other.value);
  const mean = found.reduce((sum, { value }) => sum + value, 0) / found.length;
  const squares = found.reduce((sum, { value }) => sum + (value - mean) ** 2, 0);
  return {
    metric,
    unit,
    count: found.length,
    mean,
    deviation: Math.sqrt(squares / Math.max(found.length - 1, 1)),
    least: sorted[0] as { value: number; run: number },
    most: sorted.at(-1) as { value: number; run: number },
  };
}
