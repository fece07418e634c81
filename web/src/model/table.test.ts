import { describe, expect, it } from "vitest";
import { finished, metric } from "../test/scenario";
import { isUnranked, metricColumns, parameterColumns, sorted, varies } from "./table";

const gap = (value: number | null) => ({ minimum_gap: metric(value, "m", "higher") });
const runs = [
  finished({ run: 1, metrics: gap(3), parameters: { "radio.delay": 0.1 } }),
  finished({
    run: 2,
    metrics: gap(null),
    parameters: { "radio.delay": 0.2 },
    status: "failed",
    error: "ZeroDivisionError",
  }),
  finished({ run: 3, metrics: gap(-1), parameters: { "radio.delay": 0.1 }, seed: 7 }),
  finished({ run: 4, metrics: gap(Number.NaN) }),
];
const numbers = (all: readonly { run: number }[]) => all.map(({ run }) => run);
const [gapColumn] = metricColumns(runs, [
  { name: "minimum_gap", title: "Least gap", unit: "m", goal: "higher", explanation: "Least distance ahead." },
]);
const [delayColumn] = parameterColumns(runs, { "radio.delay": "s" });
if (!gapColumn || !delayColumn) throw new Error("the fixture has both columns");

describe("columns", () => {
  it("carry names and units", () => {
    expect(gapColumn).toMatchObject({ title: "Least gap", unit: "m", numeric: true });
    expect(gapColumn.name).toBe("Least distance ahead. (minimum_gap)");
    expect(metricColumns(runs, [])[0]).toMatchObject({ title: "Minimum gap", name: "minimum_gap" });
    expect(delayColumn).toMatchObject({ title: "Delay", unit: "s", name: "radio.delay", numeric: true });
  });

  it("say more of the path where the last part is not enough", () => {
    const two = [finished({ parameters: { "radio.delay": 1, "front.delay": 2, "radio.loss": 0 } })];
    expect(parameterColumns(two, {}).map(({ title }) => title)).toEqual([
      "Front delay",
      "Radio delay",
      "Loss",
    ]);
  });

  it("have the value of a run that has not set it, and know that", () => {
    const path = "applications.platoon.parameters.headway";
    const two = [
      finished({ run: 1, settings: { [path]: 0.6 } }),
      finished({ run: 2, parameters: { "applications.platoon.parameters": { headway: 0.9 } }, settings: { [path]: 0.9 } }),
    ];
    const [headway] = parameterColumns(two, {});
    expect(two.map((run) => [headway?.value(run), headway?.isSet?.(run)])).toEqual([
      [0.6, false],
      [0.9, true],
    ]);
    expect(numbers(sorted(two, headway as typeof delayColumn, true))).toEqual([2, 1]);
  });

  it("lay out the parameters of an exchanged application", () => {
    const set = { "applications.platoon.parameters.headway": 1, "applications.platoon.parameters.name": "x" };
    const swapped = [
      finished({ parameters: { "applications.platoon.parameters": { headway: 1, name: "x" } }, settings: set }),
    ];
    expect(parameterColumns(swapped, {}).map(({ name, numeric }) => [name, numeric])).toEqual([
      ["applications.platoon.parameters.headway", true],
      ["applications.platoon.parameters.name", false],
    ]);
  });

  it("vary when one run has a value that another has not", () => {
    expect(varies(delayColumn, runs)).toBe(true);
    expect(varies(delayColumn, [runs[0], runs[2]] as typeof runs)).toBe(false);
    expect(varies(delayColumn, [runs[0], runs[3]] as typeof runs)).toBe(true);
    expect(varies(delayColumn, [])).toBe(false);
  });
});

describe("sorting", () => {
  it("puts what is missing last, up and down", () => {
    expect(numbers(sorted(runs, gapColumn, false))).toEqual([3, 1, 2, 4]);
    expect(numbers(sorted(runs, gapColumn, true))).toEqual([1, 3, 2, 4]);
  });

  it.each(["failed", "stopped", "killed", "cancelled", "running"] as const)(
    "gives a run that is %s no place among whole ones, but for what was set",
    (status) => {
      const early = [
        finished({ run: 1, metrics: gap(9), status, parameters: { "radio.delay": 0.3 } }),
        finished({ run: 2, metrics: gap(5), parameters: { "radio.delay": 0.1 } }),
        finished({ run: 3, metrics: gap(null), parameters: { "radio.delay": 0.2 } }),
      ];
      expect([true, false].map((falling) => numbers(sorted(early, gapColumn, falling)))).toEqual([
        [2, 1, 3],
        [2, 1, 3],
      ]);
      expect(early.map((run) => isUnranked(gapColumn, run))).toEqual([true, false, false]);
      expect(numbers(sorted(early, delayColumn, true))).toEqual([1, 3, 2]);
    },
  );

  it("keeps the order of equals and leaves the input alone", () => {
    expect(numbers(sorted(runs, delayColumn, false))).toEqual([1, 3, 2, 4]);
    expect(numbers(runs)).toEqual([1, 2, 3, 4]);
  });

  it("reads numbers in text as numbers", () => {
    const named = ["run10", "run9"].map((scenario, index) => finished({ run: index, scenario }));
    const column = { group: "run" as const, value: ({ scenario }: { scenario: string }) => scenario };
    expect(sorted(named, column, false).map(({ scenario }) => scenario)).toEqual([
      "run9",
      "run10",
    ]);
  });
});
