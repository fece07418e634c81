import { describe, expect, it } from "vitest";
import { finished, metric } from "../test/scenario";
import { standing } from "./standing";

const run = (number: number, gap: number | null, part = {}) => finished({ run: number, metrics: { min_gap: metric(gap, "m", "higher") }, ...part });
const base = run(1, 2);

describe("a metric against the baseline", () => {
  it.each([
    [3, "better"],
    [1, "worse"],
    [2.01, "same"],
    [2, "same"],
    [null, undefined],
  ])("%s m against 2 m: %s", (gap, expected) => {
    expect(standing(run(2, gap), base, "min_gap", 0.01)).toBe(expected);
  });
  it("is nothing of itself, of a run that ended early, without a baseline, without a direction", () => {
    expect(standing(base, base, "min_gap", 0.01)).toBeUndefined();
    expect(standing(run(2, 3, { status: "stopped" }), base, "min_gap", 0.01)).toBeUndefined();
    expect(standing(run(2, 3), run(1, 2, { status: "failed" }), "min_gap", 0.01)).toBeUndefined();
    expect(standing(run(2, 3), undefined, "min_gap", 0.01)).toBeUndefined();
    const plain = finished({ run: 2, metrics: { min_gap: metric(3, "m", null) } });
    expect(standing(plain, base, "min_gap", 0.01)).toBeUndefined();
  });
  it("takes what nobody could measure for the same", () => {
    expect(standing(run(2, 7e-6), run(1, 1e-6), "min_gap", 0.01)).toBe("same");
    expect(standing(run(2, 0.002), run(1, 0), "min_gap", 0.01)).toBe("better");
  });
  it("takes what rounding has left of zero for zero", () => {
    expect(standing(run(2, 1e-17), run(1, 0), "min_gap", 0.01)).toBe("same");
  });
});
