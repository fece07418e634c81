import { describe, expect, it } from "vitest";
import { finished } from "../test/scenario";
import { AS_IT_IS, arranged, withChannel, withoutChannel } from "./arrangement";
import { channelColumn, channelId, joined, nameOf, samplesOf, type Told } from "./column";
import { filterOf, shortest } from "./filter";
import { RUN_COLUMNS, sorted, textOf, varies } from "./table";

const NAME = "leader.speed.max";
const cell = (run: number, value: number | null, why = "") => ({ run, value, unit: value === null ? "" : "m/s", time: null, why });
const told = (cells: Told["cells"], lacking = 0): Told => ({
  name: NAME, channel: "leader.speed", kind: "max", begin: null, end: null, event: "", meaning: "the greatest sample that is a number", cells, lacking,
});
const runs = [1, 2, 3, 4, 5].map((run) => finished({ run, status: run === 4 ? "stopped" : run === 5 ? "running" : "done" }));
const [first, second, third, , fifth] = runs as [(typeof runs)[0], (typeof runs)[0], (typeof runs)[0], (typeof runs)[0], (typeof runs)[0]];
const column = channelColumn(NAME, told([cell(1, 20), cell(2, 30), cell(3, null, "This run has no channel."), cell(4, 99)]));

describe("a channel in one number", () => {
  it("has a name that says all of it", () => {
    const wanted = { channel: "a.gap", kind: "mean", begin: undefined, end: undefined, event: "" } as const;
    expect(nameOf(wanted)).toBe("a.gap.mean");
    expect(nameOf({ ...wanted, begin: 0, end: 2.5 })).toBe("a.gap.mean@0..2.5");
    expect(nameOf({ ...wanted, end: 2 })).toBe("a.gap.mean@..2");
    expect(nameOf({ ...wanted, kind: "at_event", event: "collision" })).toBe("a.gap.at_collision");
  });
  it("is told with its unit and its definition", () => {
    expect([column.title, column.unit]).toEqual(["leader.speed maximum", "m/s"]);
    expect(column.name).toContain("the greatest sample that is a number");
    const part = channelColumn(NAME, { ...told([]), kind: "at_event", event: "hard_brake", begin: 5 });
    expect(part.title).toBe("leader.speed at the first hard brake, from 5 s");
  });
  it("says why there is none", () => {
    expect(column.lack?.(third)).toEqual({ text: "–", why: "This run has no channel." });
    expect(column.lack?.(fifth)).toEqual({ text: "–", why: "The run is not over." });
    const begun = channelColumn(NAME, told([cell(1, 20)], 3));
    expect(begun.lack?.(second).text).toBe("…");
    expect(channelColumn(NAME, undefined).lack?.(second).text).toBe("…");
    expect(channelColumn(NAME, { ...told([], 3), refused: new Error("The disk is full.") }).lack?.(second).why).toBe("The disk is full.");
  });
  it("sorts, with what ended early and what is missing behind", () => {
    expect(sorted(runs, column, true).map(({ run }) => run)).toEqual([2, 1, 4, 3, 5]);
    expect(sorted(runs, column, false).map(({ run }) => run)).toEqual([1, 2, 4, 3, 5]);
  });
  it("is filtered by its name", () => {
    const columns = [...RUN_COLUMNS, column, channelColumn("other.speed.max", told([]))];
    expect(shortest(column, columns)).toBe(NAME);
    const { test, wrong } = filterOf(`${NAME} >= 25`, columns, textOf);
    expect(wrong).toBeUndefined();
    expect(runs.filter((run) => test?.(run)).map(({ run }) => run)).toEqual([2]); // 99 is of a run that was stopped
    expect(filterOf("max > 1", columns, textOf).wrong?.problem).toContain("no “max”");
  });
  it("fills piece by piece", () => {
    const whole = joined(joined(told([cell(1, 20)], 2), told([cell(3, 7)], 1)), told([cell(3, 8), cell(2, 9)], 0));
    expect(whole.cells.map(({ run, value }) => [run, value])).toEqual([[3, 8], [2, 9], [1, 20]]);
    expect(whole.lacking).toBe(0);
    expect(varies(channelColumn(NAME, whole), [first, second])).toBe(true);
  });
});

it("columns that were added are remembered with the others, and go without a trace", () => {
  const added = withChannel(withChannel({ ...AS_IT_IS, hidden: [channelId(NAME)] }, NAME), NAME);
  expect(added).toMatchObject({ channels: [NAME], hidden: [] });
  const pinned = { ...added, pinned: [channelId(NAME), "seed"], order: ["seed", channelId(NAME)] };
  expect(withoutChannel(pinned, NAME)).toEqual({ channels: [], hidden: [], pinned: ["seed"], order: ["seed"] });
  expect(arranged([column, ...RUN_COLUMNS], added)).toHaveLength(RUN_COLUMNS.length + 1);
});

it("channels to choose from are those of the newest run of each scenario that is over", () => {
  const some = [finished({ run: 9, scenario: "a", status: "running" }), finished({ run: 8, scenario: "a" }), finished({ run: 7, scenario: "b" }), finished({ run: 3, scenario: "a" })];
  expect(samplesOf(some, 8)).toEqual([8, 7]);
  expect(samplesOf(some, 1)).toEqual([8]);
});
