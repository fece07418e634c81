import { describe, expect, it } from "vitest";
import { type MetricDifference, merge, tally, verdict } from "./compare";

const metric = (part: Partial<MetricDifference>): MetricDifference => ({
  name: "gap",
  unit: "m",
  goal: "higher",
  a: 1,
  b: 2,
  difference: 1,
  relative: 1,
  better: "b",
  ...part,
});

describe("the verdict on B", () => {
  it.each([
    [{ better: "b" }, "better"],
    [{ better: "a" }, "worse"],
    [{ better: "same" }, "same"],
    [{ goal: null, better: null }, "no goal"],
    [{ b: null, better: null }, "missing"],
    [{ a: null, better: null }, "missing"],
  ] as [Partial<MetricDifference>, string][])("%o is %s", (part, expected) => {
    expect(verdict(metric(part))).toBe(expected);
  });

  it("is counted", () => {
    expect(tally([metric({}), metric({}), metric({ better: "a" })])).toEqual({
      better: 2,
      worse: 1,
      same: 0,
      "no goal": 0,
      missing: 0,
    });
  });
});

describe("two traces on one axis", () => {
  const trace = (time: number[], values: (number | null)[]) => ({
    time,
    channels: { "leader.speed": { unit: "m/s", values } },
  });

  it("keep gaps as null, and are undefined where only the other has a sample", () => {
    const merged = merge(trace([0, 1, 2], [1, null, 3]), trace([0, 1.5], [5, 6]), ["leader.speed"]);
    expect(merged).toEqual([
      [0, 1, 1.5, 2],
      [1, null, undefined, 3],
      [5, undefined, 6, undefined],
    ]);
  });

  it("have empty columns for a channel that one of them lacks", () => {
    expect(merge(trace([0], [1]), { time: [0], channels: {} }, ["leader.speed"])).toEqual([
      [0],
      [1],
      [undefined],
    ]);
  });
});
