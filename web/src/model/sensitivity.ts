/**
 * Which parameter goes with a metric over many runs: rank correlations, the strongest first.
 *
 * Spearman's coefficient is the correlation of ranks, ties sharing the mean of theirs: 1 where the metric only rises with the parameter,
 * -1 where it only falls, whatever the shape. Its 95 % interval by Bonett and Wright (Psychometrika 65 (2000) 23): with n runs, about
 * atanh(r) with the deviation sqrt((1 + r²/2) / (n - 3)). It says nothing of causes, nor of parameters that were varied together.
 */

import { numberOf } from "./axes";
import type { ListedRun } from "./run";
import { type Column, varies } from "./table";

export interface Sensitivity {
  column: Column;
  /** Runs that have both. */
  count: number;
  /** From -1 to 1. */
  rank: number;
  low: number;
  high: number;
}

/** With fewer runs the interval is everything. */
export const FEWEST = 5;
const NORMAL_95 = 1.959964;

/** Of every number that was set and that varies, how it goes with a metric. */
export function sensitivities(metric: Column, columns: readonly Column[], runs: readonly ListedRun[]): Sensitivity[] {
  const set = columns.filter((column) => column.group === "parameters" && column.numeric && varies(column, runs));
  const found = set.flatMap((column) => {
    const pairs = runs.flatMap((run) => {
      const [x, y] = [numberOf(column, run), numberOf(metric, run)];
      return x === undefined || y === undefined ? [] : [[x, y] as const];
    });
    const rank = pairs.length < FEWEST ? undefined : correlation(ranks(pairs.map(([x]) => x)), ranks(pairs.map(([, y]) => y)));
    return rank === undefined ? [] : [{ column, count: pairs.length, rank, ...intervalOf(rank, pairs.length) }];
  });
  return found.sort((one, other) => Math.abs(other.rank) - Math.abs(one.rank));
}

/** Where each value stands, from 1; equal ones share the mean of their places. */
export function ranks(values: readonly number[]): number[] {
  const sorted = [...values].sort((one, other) => one - other);
  const first = new Map<number, number>();
  const last = new Map<number, number>();
  for (const [place, value] of sorted.entries()) {
    if (!first.has(value)) first.set(value, place + 1);
    last.set(value, place + 1);
  }
  return values.map((value) => ((first.get(value) ?? 0) + (last.get(value) ?? 0)) / 2);
}

/** The correlation of two rows; none where one of them is always the same. */
export function correlation(x: readonly number[], y: readonly number[]): number | undefined {
  const mean = (some: readonly number[]) => some.reduce((sum, each) => sum + each, 0) / some.length;
  const [a, b] = [mean(x), mean(y)];
  const sums = x.map((each, place) => [each - a, (y[place] as number) - b] as const);
  const both = sums.reduce((sum, [one, other]) => sum + one * other, 0);
  const size = Math.sqrt(sums.reduce((sum, [one]) => sum + one * one, 0) * sums.reduce((sum, [, other]) => sum + other * other, 0));
  return size > 0 ? Math.min(1, Math.max(-1, both / size)) : undefined;
}

export function intervalOf(rank: number, count: number): { low: number; high: number } {
  const away = NORMAL_95 * Math.sqrt((1 + rank ** 2 / 2) / (count - 3));
  return { low: Math.tanh(Math.atanh(rank) - away), high: Math.tanh(Math.atanh(rank) + away) };
}

/** Whether it may be nothing but chance: no correlation lies within the interval. */
export const mayBeChance = ({ low, high }: Pick<Sensitivity, "low" | "high">): boolean => low <= 0 && high >= 0;
