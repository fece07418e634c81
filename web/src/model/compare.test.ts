import { describe, expect, it } from "vitest";
import { differing, type MetricDifference, merge, tally, verdict } from "./compare";

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
      "not ranked": 0,
      missing: 0,
    });
  });

  it("is none where a run ended early, whatever the figures say", () => {
    const why = "Nothing is ranked: run 1 is stopped at 6 s";
    expect(verdict(metric({ better: null }), why)).toBe("not ranked");
    expect(tally([metric({}), metric({ a: null })], why)).toMatchObject({ better: 0, "not ranked": 1, missing: 1 });
  });

  it("tells no difference where only rounding has left one", () => {
    const left = differing(metric({ a: 0.3, b: 0.30000000000000004, difference: 5e-17, relative: 2e-16 }));
    expect(left).toEqual({ difference: 0, relative: 0 });
    expect(differing(metric({ a: 0, b: 1e-17, difference: 1e-17, relative: null }))).toEqual({ difference: 0, relative: 0 });
    expect(differing(metric({}))).toEqual({ difference: 1, relative: 1 });
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
