import { expect, test } from "vitest";
import { finished, metric } from "../test/scenario";
import { correlation, intervalOf, mayBeChance, ranks, sensitivities } from "./sensitivity";
import { metricColumns, parameterColumns } from "./table";

test("equal values share the mean of their places", () => expect(ranks([10, 30, 20, 20])).toEqual([1, 4, 2.5, 2.5]));

test("a correlation is 1, -1, none, or what stands in the closed form", () => {
  expect(correlation([1, 2, 3], [2, 4, 6])).toBe(1);
  expect(correlation([1, 2, 3], [3, 2, 1])).toBe(-1);
  expect(correlation([1, 2, 3], [5, 5, 5])).toBeUndefined();
  // Without ties it is 1 - 6 Σd² / (n (n² - 1)): here d² sum to 2, n is 4.
  expect(correlation([1, 2, 3, 4], [2, 1, 3, 4])).toBeCloseTo(1 - 12 / 60);
});

test("an interval gets narrower with more runs, and one run more or less says nothing", () => {
  const [few, many] = [intervalOf(0.6, 8), intervalOf(0.6, 200)];
  expect(mayBeChance(few)).toBe(true);
  expect(mayBeChance(many)).toBe(false);
  // atanh(0.6) = 0.6931, sqrt(1.18 / 197) = 0.07739: from 0.5414 to 0.8448 before tanh.
  expect(many.low).toBeCloseTo(Math.tanh(0.5414), 3);
  expect(many.high).toBeCloseTo(Math.tanh(0.8448), 3);
  expect(intervalOf(1, 9)).toEqual({ low: 1, high: 1 });
});

const runs = Array.from({ length: 12 }, (_, place) =>
  finished({
    run: place + 1,
    parameters: { headway: place, gain: (place * 5) % 12, kind: "simple" },
    settings: { headway: place, gain: (place * 5) % 12, kind: "simple" },
    metrics: { gap: metric(place ** 3, "m", "higher") },
    ...(place === 11 ? { status: "failed" as const } : {}),
  }),
);
const columns = [...parameterColumns(runs, {}), ...metricColumns(runs, [])];

test("the strongest is first, over whole runs alone, whatever the shape of the curve", () => {
  const [first, second, ...others] = sensitivities(columns.at(-1) as (typeof columns)[number], columns, runs);
  expect(first).toMatchObject({ rank: 1, count: 11 });
  expect(first?.column.id).toBe("parameter:headway");
  expect(second?.column.id).toBe("parameter:gain");
  expect(Math.abs(second?.rank ?? 1)).toBeLessThan(0.5);
  expect(others).toEqual([]);
});

test("four runs are too few", () => expect(sensitivities(columns.at(-1) as (typeof columns)[number], columns, runs.slice(0, 4))).toEqual([]));
