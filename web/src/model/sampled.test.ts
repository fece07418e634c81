import { expect, test } from "vitest";
import { tableOf } from "./sampled";

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
