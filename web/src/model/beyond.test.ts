import { expect, it } from "vitest";
import { beyondOf, beyondOfRuns, type Spanned, union } from "./beyond";

const stretch = (begin: number, end: number, quantity: string, value: number, low: number, high: number, unit = "m/s") => ({ begin, end, quantity, unit, value, low, high });
const KNOWN: Spanned[] = [
  { vehicle: "leader", stretches: [stretch(1, 2, "speed", 25, 0, 20), stretch(5, 6, "yaw_rate", 0.9, -0.5, 0.5, "rad/s")], not_recorded: [] },
  { vehicle: "follower_1", stretches: [stretch(1.5, 3, "speed", 22, 0, 20)], not_recorded: ["lateral_acceleration"] },
  { vehicle: "follower_2", stretches: [], not_recorded: [] },
];

it("joins the parts of all vehicles, and tells the worst in the width of its own span", () => {
  const found = beyondOf(KNOWN);
  expect(found?.parts).toEqual([[1, 3], [5, 6]]);
  expect(found?.worst).toBe("Leader, yaw rate 0.9 rad/s, validated from −0.5 to 0.5 rad/s");
  expect(found?.all.split("\n")[1]).toBe("Follower 1, speed 22 m/s, validated from 0 to 20 m/s (lateral acceleration not recorded)");
});

it("shows only what concerns the vehicles that are drawn", () => {
  expect(beyondOf(KNOWN, ["follower_1"])?.parts).toEqual([[1.5, 3]]);
  expect(beyondOf(KNOWN, ["follower_2", "other"])).toBeUndefined();
  expect(beyondOf(undefined)).toBeUndefined();
});

it("says what was never validated instead of a span without width", () => {
  const none: Spanned = { vehicle: "car", stretches: [stretch(0, 1, "yaw_rate", 0.1, 0, 0, "rad/s")], not_recorded: [] };
  expect(beyondOf([none])?.worst).toBe("Car, yaw rate 0.1 rad/s, never validated");
});

it("puts parts that touch together", () => {
  expect(union([[3, 4], [0, 1], [1, 2]])).toEqual([[0, 2], [3, 4]]);
});

it("puts runs on the clock of the first, and names the one that went farthest", () => {
  const found = beyondOfRuns([
    { name: "#1", offset: 0, beyond: beyondOf(KNOWN, ["follower_1"]) },
    { name: "#2", offset: 2, beyond: beyondOf(KNOWN, ["leader"]) },
    { name: "#3", offset: 0, beyond: undefined },
  ]);
  expect(found?.parts).toEqual([[-1, 0], [1.5, 4]]);
  expect(found?.worst).toBe("#2: Leader, yaw rate 0.9 rad/s, validated from −0.5 to 0.5 rad/s");
  expect(found?.all).toContain("#1:\nFollower 1, speed 22 m/s");
  expect(beyondOfRuns([{ name: "#1", offset: 0, beyond: undefined }])).toBeUndefined();
});
