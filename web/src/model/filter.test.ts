import { describe, expect, it } from "vitest";
import { finished, metric } from "../test/scenario";
import { type Filter, filterOf, withRange } from "./filter";
import { metricColumns, parameterColumns, RUN_COLUMNS, textOf } from "./table";

const HEADWAY = "applications.platoon.parameters.headway";
const runs = [
  finished({ run: 1, parameters: { [HEADWAY]: 0.6 }, metrics: { min_ttc: metric(1.5, "s", "higher") }, verdict: "candidate" }),
  finished({ run: 2, parameters: { [HEADWAY]: 0.9 }, metrics: { min_ttc: metric(0.8, "s", "higher") }, tags: ["wet", "night"], parent: 1 }),
  finished({ run: 3, parameters: { [HEADWAY]: 1.2 }, metrics: { min_ttc: metric(9, "s", "higher") }, status: "failed", error: "ZeroDivisionError" }),
  finished({ run: 4, parameters: { "radio.delay": 0.1, "front.delay": 0.2 }, seed: 7, name: "a long night" }),
];
const columns = [...RUN_COLUMNS, ...parameterColumns(runs, {}), ...metricColumns(runs, [])];
const filter = (text: string): Filter => filterOf(text, columns, textOf);
const shown = (text: string) => runs.filter((run) => filter(text).test?.(run)).map(({ run }) => run);

describe("an expression shows", () => {
  it.each([
    ["", [1, 2, 3, 4]],
    ["headway < 0.8", [1]],
    ["headway>=0.9", [2, 3]],
    ["headway = 0.9", [2]],
    ["headway != 0.9", [1, 3, 4]],
    [`${HEADWAY} = 0.9`, [2]],
    ["headway < 1 and min_ttc > 1.2", [1]],
    ["headway < 1 min_ttc > 1.2", [1]],
    ["failed or tag = wet", [2, 3]],
    ["tags = NIGHT", [2]],
    ["night", [2, 4]],
    ["not night", [1, 3]],
    ["not (headway = 0.6 or failed)", [2, 4]],
    ["status = done and (seed = 7 or verdict = candidate)", [1, 4]],
    ["parent = 1", [2]],
    ["zerodivision", [3]],
    ['name = "a long night"', [4]],
    ["front.delay = 0.2", [4]],
    ["run > 2", [3, 4]],
    ["#3", [3]],
    ["seed=7", [4]],
    ["headway=0.9 parent=1", [2]],
    ["  ", [1, 2, 3, 4]],
    ["nothing", []],
  ])("%s", (text, expected) => {
    expect(shown(text)).toEqual(expected);
  });

  it("no run that ended early by its metrics, neither less nor more", () => {
    expect(shown("min_ttc > 1")).toEqual([1]);
    expect(shown("not min_ttc < 100")).toEqual([3, 4]);
    expect(shown("min_ttc != 1.5")).toEqual([2, 4]);
  });
});

describe("what cannot be read is told with its place", () => {
  it.each([
    ["headwy < 1", 0, "did you mean headway"],
    ["delay = 0.1", 0, "front.delay or radio.delay"],
    ["headway <", 9, "a value is missing"],
    ["headway < fast", 10, "compares numbers"],
    ["(failed", 0, "not closed"],
    ["failed)", 6, "closes nothing"],
    ["or failed", 0, "a word or a comparison is missing"],
    ["failed and", 10, "missing at the end"],
    ['"failed', 0, "quotation mark"],
    ["< 3", 0, "stands no name"],
    ["volume > 3", 0, "There is no “volume”"],
  ])("%s", (text, at, problem) => {
    const { wrong } = filter(text);
    expect(wrong?.at).toBe(at);
    expect(wrong?.problem).toContain(problem);
  });
});

describe("a range of one column", () => {
  const headway = columns.find(({ id }) => id.endsWith("headway")) as (typeof columns)[number];
  const ranged = (text: string, range?: readonly [number, number]) => withRange(text, filter(text).bounds ?? [], headway, columns, range);
  it("is said behind the rest, and takes the place of what was said of it", () => {
    expect(ranged("", [0.5, 1])).toBe("headway >= 0.5 and headway <= 1");
    expect(ranged("done", [0.5, 1])).toBe("done and headway >= 0.5 and headway <= 1");
    expect(ranged("done and headway >= 0.5 and headway <= 1 and wet", [0.61234, 0.9])).toBe("done and wet and headway >= 0.6123 and headway <= 0.9");
    expect(ranged("headway > 0.5 wet")).toBe("wet");
    expect(ranged("headway >= 0.5 and headway <= 1")).toBe("");
  });
  it("is known of what binds every run, and of nothing within brackets or beside an or", () => {
    expect(filter("wet headway < 1")).toMatchObject({ bounds: [{ column: headway.id, sign: "<", value: 1, from: 4, to: 15 }] });
    for (const text of ["not headway < 1", "(headway < 1)", "wet or headway < 1", "headway < 1 or wet"]) expect(filter(text)).toMatchObject({ bounds: [] });
    expect(filter("(wet or night) headway < 1")).toMatchObject({ bounds: [{ value: 1 }] });
  });
});
