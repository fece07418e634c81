import { describe, expect, it } from "vitest";
import { pathOf, rangeOf, ticksOf } from "./XYChart";

describe("a chart of one quantity over another", () => {
  it("has round ticks within its range", () => {
    expect(ticksOf({ low: -0.3, high: 10.2 })).toEqual([0, 5, 10]);
    expect(ticksOf({ low: 0, high: 1 })).toEqual([0, 0.2, 0.4, 0.6, 0.8, 1]);
    expect(ticksOf({ low: 1200, high: 1290 }).every((tick) => tick >= 1200 && tick <= 1290)).toBe(true);
  });

  it("covers all values, and has a range without any", () => {
    const { low, high } = rangeOf([3, null, 5, undefined]);
    expect(low).toBeLessThan(3);
    expect(high).toBeGreaterThan(5);
    expect(rangeOf([])).toEqual({ low: 0, high: 1 });
    expect(rangeOf([7]).high).toBeGreaterThan(7);
  });

  it("leaves a gap where one of both is missing", () => {
    const same = (value: number) => value;
    expect(pathOf({ x: [0, 1, null, 3, 4], y: [0, 1, 2, 3, null] }, same, same)).toBe("M0.0 0.0L1.0 1.0M3.0 3.0");
  });
});
