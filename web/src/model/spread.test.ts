import { expect, it } from "vitest";
import type { Run } from "./run";
import { alike, spreadOf } from "./spread";

const run = (number: number, seed: number, value: number | null, part: Partial<Run> = {}): Run =>
  ({ run: number, seed, status: "done", scenario_hash: "a", code_version: "1", metrics: { min_gap: { value, unit: "m" } }, ...part }) as Run;

it("takes every seed of the same setting once, the newest, and only whole runs", () => {
  const runs = [run(5, 2, 1), run(4, 1, 1), run(3, 1, 1), run(2, 3, 1, { status: "stopped" }), run(1, 4, 1, { scenario_hash: "b" }), run(0, 5, 1, { code_version: "1+changed" })];
  expect(alike(runs, { scenario_hash: "a", code_version: "1" }).map((each) => each.run)).toEqual([4, 5]);
});

it("tells mean, deviation of the sample, least and greatest with their runs", () => {
  const [found] = spreadOf([run(1, 1, 2), run(2, 2, 4), run(3, 3, 6)]);
  expect(found).toEqual({ metric: "min_gap", unit: "m", count: 3, mean: 4, deviation: 2, least: { value: 2, run: 1 }, most: { value: 6, run: 3 } });
});

it("has nothing to tell of a metric that only one run has", () => {
  expect(spreadOf([run(1, 1, 2), run(2, 2, null)])).toEqual([]);
});
