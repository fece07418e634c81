import { expect, it } from "vitest";
import { bandsOf } from "./wanted";

const document = {
  goals: { min_gap: { least: 2, most: null }, late: { least: 0.8 }, max_deceleration: { most: 6 }, max_lateral_offset: { most: 0.5 }, min_ttc: { least: 1 } },
  measures: { late: { kind: "min_time_gap" } },
};

it("draws a goal about the least or greatest value of a quantity into its chart", () => {
  expect(bandsOf(document, "gap")).toEqual([{ metric: "min_gap", least: 2 }]);
  expect(bandsOf(document, "time_gap")).toEqual([{ metric: "late", least: 0.8 }]);
});

it("knows that a deceleration is a negative acceleration, and an offset one to either side", () => {
  expect(bandsOf(document, "acceleration")).toEqual([{ metric: "max_deceleration", least: -6 }]);
  expect(bandsOf(document, "lateral_offset")).toEqual([{ metric: "max_lateral_offset", least: -0.5, most: 0.5 }]);
});

it("has nothing to say of other quantities, nor without goals", () => {
  expect(bandsOf(document, "speed")).toEqual([]);
  expect(bandsOf({}, "gap")).toEqual([]);
});

it("draws no limit of a measure that looks at a part of the run, or at some vehicles", () => {
  const of = (part: Record<string, unknown>) => bandsOf({ goals: { late: { least: 2 } }, measures: { late: { kind: "min_gap", begin: null, end: null, vehicles: [], ...part } } } as never, "gap");
  expect(of({})).toHaveLength(1);
  expect(of({ begin: { at: 20 } })).toEqual([]);
  expect(of({ vehicles: ["follower_3"] })).toEqual([]);
});
