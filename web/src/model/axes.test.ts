import { describe, expect, it } from "vitest";
import { finished, metric } from "../test/scenario";
import { type Axis, axesOf, axisOf, axisText, changed, firstAxes, placeOn, rangeAt, rangeOf, reordered, valueAt } from "./axes";
import { filterOf } from "./filter";
import { metricColumns, parameterColumns, RUN_COLUMNS, textOf } from "./table";

const runs = [1, 2, 3, 4].map((run) =>
  finished({
    run,
    parameters: { "platoon.headway": 0.3 * run, "radio.kind": "simple" },
    metrics: { min_gap: metric(run === 4 ? null : 10 - run, "m", "higher"), count: metric(7, "1", null), speed: metric(run, "m/s", null) },
    ...(run === 3 ? { status: "failed" as const, unmet: [] } : {}),
  }),
);
const columns = [...RUN_COLUMNS, ...parameterColumns(runs, {}), ...metricColumns(runs, [])];
const axes = axesOf(columns, runs);
const gap = axes.find(({ column }) => column.id === "metric:min_gap") as (typeof axes)[number];

describe("axes", () => {
  it("are of numbers that differ, over whole runs", () => {
    expect(axes.map(({ column }) => column.id)).toEqual(["parameter:platoon.headway", "metric:min_gap", "metric:speed"]);
    expect([gap.low, gap.high]).toEqual([8, 9]);
  });
  it("begin with what was set, and with metrics that have a direction", () => {
    expect(firstAxes(axes, runs)).toEqual(["parameter:platoon.headway", "metric:min_gap", "metric:speed"]);
  });
  it("have a place for every value, and none for a missing one or one of a run that ended early", () => {
    expect(runs.map((run) => placeOn(gap, run))).toEqual([1, 0, undefined, undefined]);
    expect(valueAt(gap, 0.5)).toBe(8.5);
    expect(valueAt(gap, 3)).toBe(9);
  });
  it("show the range that a filter keeps", () => {
    const range = (text: string) => rangeOf(gap, filterOf(text, columns, textOf) .bounds ?? []);
    expect(range("")).toBeUndefined();
    expect(range("min_gap >= 8.5")).toEqual([0.5, 1]);
    expect(range("min_gap > 8.25 and min_gap < 8.5")).toEqual([0.25, 0.5]);
    expect(range("min_gap = 9")).toEqual([1, 1]);
    expect(range("min_gap < 100")).toEqual([0, 1]);
    expect(range("min_gap != 9")).toBeUndefined();
  });
  it("may stand on their head: what was above is below", () => {
    const flipped = { ...gap, isFlipped: true };
    expect(runs.map((run) => placeOn(flipped, run))).toEqual([0, 1, undefined, undefined]);
    expect(valueAt(flipped, 0.25)).toBe(8.75);
    expect(rangeAt(flipped, [0, 0.25])).toEqual([8.75, 9]);
    expect(rangeOf(flipped, filterOf("min_gap >= 8.5", columns, textOf).bounds ?? [])).toEqual([0, 0.5]);
  });
  it("may be logarithmic: the geometric mean is in the middle", () => {
    const log: Axis = { ...gap, low: 1, high: 100, isLog: true };
    expect(valueAt(log, 0.5)).toBeCloseTo(10);
    expect(rangeOf(log, filterOf("min_gap >= 10", columns, textOf).bounds ?? [])?.[0]).toBeCloseTo(0.5);
  });
  it("come back from an address as they were, and none has a logarithm of what is not positive", () => {
    const wanted = changed(axes, 1, { isFlipped: true, isLog: true });
    expect(wanted.map((axis) => axisOf(axisText(axis), axes)?.isLog)).toEqual([false, true, false]);
    expect(axisOf(axisText(wanted[1] as Axis), axes)).toMatchObject({ isFlipped: true, isLog: true });
    expect(axisOf("metric:min_gap!log", [{ ...gap, low: 0 }])?.isLog).toBe(false);
    expect(axisOf("metric:unknown", axes)).toBeUndefined();
  });
  it("change places, and stay within the ends", () => {
    const ids = (some: readonly Axis[]) => some.map(({ column }) => column.title);
    const [a, b, c] = ids(axes);
    expect(ids(reordered(axes, 0, 2))).toEqual([b, c, a]);
    expect(ids(reordered(axes, 2, -1))).toEqual([c, a, b]);
    expect(ids(reordered(axes, 2, 9))).toEqual([a, b, c]);
  });
});
