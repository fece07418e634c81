import { describe, expect, it } from "vitest";
import { metric } from "../test/scenario";
import { goalsOf } from "./goal";

describe("the goals of a run", () => {
  it("are met or missed by a margin", () => {
    const goals = { min_ttc: { least: 1.5, most: null }, collisions: { least: null, most: 0 } };
    const metrics = { min_ttc: metric(2, "s"), collisions: metric(3, "1") };
    expect(goalsOf({ document: { goals }, metrics })).toEqual([
      { metric: "min_ttc", bound: "least", wanted: 1.5, value: 2, unit: "s", margin: 0.5 },
      { metric: "collisions", bound: "most", wanted: 0, value: 3, unit: "1", margin: -3 },
    ]);
  });

  it("have no margin before anything is measured, and need not be there", () => {
    expect(goalsOf({ document: { goals: { min_ttc: { least: 1 } } }, metrics: {} })[0]?.margin).toBeNull();
    expect(goalsOf({ document: {}, metrics: {} })).toEqual([]);
  });
});
