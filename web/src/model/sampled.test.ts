import { expect, test } from "vitest";
import { evenly, pairsOf, partOf, tableOf } from "./sampled";

const time = Array.from({ length: 1001 }, (_, i) => i / 10);
const data: [number[], (number | null)[]] = [time, time.map((t) => (t === 50 ? null : 2 * t))];

test("all samples stand there when they are few, gaps as gaps", () => {
  const { rows, of } = tableOf(data, [49.9, 50.1]);
  expect(of).toBe(3);
  expect(rows).toEqual([[49.9, 99.8], [50, null], [50.1, 100.2]]);
});

test("of many so many are taken evenly, the first and the last among them", () => {
  const { rows, of } = tableOf(data, undefined, 11);
  expect(of).toBe(1001);
  expect(rows.map(([at]) => at)).toEqual([0, 10, 20, 30, 40, 50, 60, 70, 80, 90, 100]);
});

test("nothing has no rows", () => expect(tableOf([[]], undefined)).toEqual({ rows: [], of: 0 }));

test("curves of one quantity over another stand below each other, of each about as many", () => {
  const one = { label: "leader", time: [0, 1, 2], x: [5, 6, null], y: [1, 2, 3] };
  expect(pairsOf([one]).rows).toEqual([["leader", 0, 5, 1], ["leader", 1, 6, 2], ["leader", 2, null, 3]]);
  const long = { label: "follower", time, x: time, y: time };
  const { rows, of } = pairsOf([one, long], 20);
  expect(of).toBe(1004);
  expect(rows.filter(([whose]) => whose === "leader")).toHaveLength(3);
  expect(rows.filter(([whose]) => whose === "follower")).toHaveLength(10);
  expect(rows.at(-1)).toEqual(["follower", 100, 100, 100]);
});

test("the ends are always taken, and it is told how much was", () => {
  expect(evenly([...Array(1000).keys()], 4)).toEqual([0, 333, 666, 999]);
  expect(partOf(3, 3, "runs")).toBe("3 runs.");
  expect(partOf(200, 1000, "runs")).toBe("200 of 1000 runs, evenly taken.");
});
