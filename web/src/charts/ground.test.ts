import { describe, expect, it } from "vitest";
import type { PlanLane } from "../model/map";
import { dashes, offLand, onLand, storeyOf } from "./ground";

const lane: PlanLane = {
  id: 0, road: "a", index: 0, width: 3, speed: 14, internal: false, open: true,
  centre: [[0, 0], [300, 0]], land: [[[0, 0], [100, 0]], [[200, 0], [300, 0]]], aloft: [{ lift: 5.5, centre: [[100, 0], [200, 0]] }],
};

describe("levels on the plan", () => {
  it("draws a lane on the land where it lies on it, and off it elsewhere", () => {
    expect(onLand(lane).map(({ centre }) => centre)).toEqual(lane.land);
    expect(offLand(lane).map(({ centre, lift, road }) => [centre, lift, road])).toEqual([[[[100, 0], [200, 0]], 5.5, "a"]]);
  });

  it("takes a lane that is on the land all along as it is", () => {
    const flat = { ...lane, land: null, aloft: null };
    expect(onLand(flat)).toEqual([flat]);
    expect(offLand(flat)).toEqual([]);
  });

  it("draws the higher of two bridges over the lower one", () => {
    const [low] = offLand(lane), [high] = offLand({ ...lane, aloft: [{ lift: 11, centre: [[0, 0], [9, 0]] }] });
    expect(storeyOf(high!)).toBeGreaterThan(storeyOf(low!));
  });

  it("makes dashes of 3 m that stay on the line", () => {
    const found = dashes([[0, 0], [20, 0]]);
    expect(found.length).toBe(3);
    expect(found.map((dash) => dash.map(([x]) => x))).toEqual([[0, 3], [7.5, 10.5], [15, 18]]);
  });
});
