import { describe, expect, it, test } from "vitest";
import { changeOf, commonKinds, differs, goalsTold, type MetricBeside, merged, namesOf, numbersOf, offsetsOf, standOf, tally } from "./beside";
import type { RunEvent } from "./run";

const metric = (part: Partial<MetricBeside>): MetricBeside => ({
  name: "min_gap",
  unit: "m",
  goal: "higher",
  values: [1, 2, 0.5],
  relative: [0, 1, -0.5],
  stands: ["same", "better", "worse"],
  ...part,
});

describe("the runs of an address", () => {
  it("are numbers, each once, eight at most", () => {
    expect(numbersOf("3,5,3,x,-1,1.5")).toEqual([3, 5]);
    expect(numbersOf("1,2,3,4,5,6,7,8,9")).toHaveLength(8);
    expect(numbersOf(undefined)).toEqual([]);
  });
});

describe("a metric says something", () => {
  it.each([
    [{}, true],
    [{ values: [1, 1, 1], stands: ["same", "same", "same"] }, false],
    [{ values: [1, 1.001, 1], stands: ["same", "same", "same"] }, false],
    [{ values: [null, null, null], stands: [null, null, null] }, false],
    [{ values: [1, null, 1], stands: ["same", null, "same"] }, true],
    [{ goal: null, values: [1, 2, 1], stands: ["same", null, "same"] }, true],
  ] as [Partial<MetricBeside>, boolean][])("%o: %s", (part, expected) => {
    expect(differs(metric(part))).toBe(expected);
  });
});

describe("the name of a run", () => {
  const runs = [
    { run: 3, name: "" },
    { run: 5, name: "wet" },
  ];
  it("says what differs when that is little", () => {
    const headway = { path: "applications.platoon.parameters.headway", values: [0.6, 0.9], unit: "s" };
    expect(namesOf(runs, [headway])).toEqual(["#3 headway 0.6", "#5 wet headway 0.9"]);
  });
  it("is the number when much differs, or a run has no such value", () => {
    const many = ["a", "b", "c"].map((path) => ({ path, values: [1, 2], unit: "" }));
    expect(namesOf(runs, many)).toEqual(["#3", "#5 wet"]);
    expect(namesOf(runs, [{ path: "k", values: [null, 2], unit: "" }])).toEqual(["#3", "#5 wet"]);
  });
});

describe("how a run stands against the first", () => {
  it("is what the server says, unless it is not to be ranked or a value is missing", () => {
    expect([0, 1, 2].map((place) => standOf(metric({}), place, ""))).toEqual(["same", "better", "worse"]);
    expect(standOf(metric({}), 1, "Nothing is ranked")).toBe("not ranked");
    expect(standOf(metric({ values: [1, null, 2] }), 1, "")).toBe("missing");
    expect(standOf(metric({ values: [null, 1, 2] }), 1, "")).toBe("missing");
    expect(standOf(metric({ goal: null, stands: [null, null, null] }), 1, "")).toBe("no goal");
    expect(tally([metric({}), metric({})], 2, "")).toMatchObject({ worse: 2, better: 0 });
  });
  it("tells no difference where only rounding has left one", () => {
    expect(changeOf(metric({ values: [0.3, 0.30000000000000004], relative: [0, 2e-16] }), 1)).toEqual({ difference: 0, relative: 0 });
    expect(changeOf(metric({ values: [0, 1e-17], relative: [0, null] }), 1)).toEqual({ difference: 0, relative: 0 });
    expect(changeOf(metric({}), 1)).toEqual({ difference: 1, relative: 1 });
  });
  it("is none where nobody could measure it, and no share where that is many times the baseline", () => {
    expect(changeOf(metric({ values: [1e-6, 7e-6], relative: [0, 6] }), 1)).toEqual({ difference: 0, relative: 0 });
    expect(changeOf(metric({ values: [0.002, 0.502], relative: [0, 250] }), 1)).toEqual({ difference: 0.5, relative: null });
  });
});

const happened = (...events: [string, number][]) => events.map(([kind, time]) => ({ kind, time }) as RunEvent);

describe("runs are aligned by an event", () => {
  const events = [happened(["brake", 20], ["hit", 22]), happened(["start", 1], ["brake", 21.5], ["brake", 30])];
  it("that has happened in all of them", () => {
    expect(commonKinds(events)).toEqual(["brake"]);
    expect(commonKinds([])).toEqual([]);
  });
  it("the first of it counts", () => {
    expect(offsetsOf(events, "brake")).toEqual([0, 1.5]);
    expect(offsetsOf(events, undefined)).toEqual([0, 0]);
  });
});

describe("traces on one axis", () => {
  const trace = (time: number[], values: (number | null)[]) => ({ time, channels: { "leader.speed": { unit: "m/s", values } } });
  const names = ["leader.speed"];

  it("keep gaps as null, and are undefined where only another run has a sample", () => {
    const found = merged([trace([0, 1, 2], [1, null, 3]), trace([0, 1.5], [5, 6])], [0, 0], [names, names]);
    expect(found).toEqual([
      [0, 1, 1.5, 2],
      [1, null, undefined, 3],
      [5, undefined, 6, undefined],
    ]);
  });
  it("are moved by their offsets, and meet where they are the same time", () => {
    const found = merged([trace([0, 0.1], [1, 2]), trace([1.5, 1.6], [3, 4])], [0, 1.5], [names, names]);
    expect(found.slice(1)).toEqual([
      [1, 2],
      [3, 4],
    ]);
  });
  it("have nothing for a channel that a run has not", () => {
    expect(merged([trace([0], [1]), trace([0], [2])], [0, 0], [names, []])).toEqual([[0], [1]]);
  });
});

test("goals met are told with their number, and runs without any say so", () => {
  expect(goalsTold({ met: 2, of: 3, missed: ["min_gap is 1 m, at least 2 is wanted"] })).toEqual({ text: "2 of 3", why: "min_gap is 1 m, at least 2 is wanted" });
  expect(goalsTold({ met: 3, of: 3, missed: [] }).text).toBe("✓ 3 of 3");
  expect(goalsTold({ met: 0, of: 0, missed: [] }).text).toBe("none set");
  expect(goalsTold(null).text).toBe("not measured");
});
