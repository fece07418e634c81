import { describe, expect, it } from "vitest";
import { finished, metric } from "../test/scenario";
import { entriesOf, groupable, groupsOf, said, summary } from "./grouping";
import { type Column, metricColumns, parameterColumns, RUN_COLUMNS } from "./table";

const PATH = "applications.platoon.parameters.headway";
const made = (run: number, headway: number, gap: number | null, more: Parameters<typeof finished>[0] = {}) =>
  finished({ run, settings: { [PATH]: headway }, metrics: { minimum_gap: metric(gap, "m", "higher") }, ...more });
const RUNS = [
  made(1, 0.6, 2),
  made(2, 0.9, 9, { tags: ["wet", "night"] }),
  made(3, 0.6, 4),
  made(4, 0.9, 100, { status: "stopped", tags: ["night", "wet"] }),
  made(5, 1.2, null),
];
const [gap] = metricColumns(RUNS, []) as [Column];
const [headway] = parameterColumns(RUNS, { [PATH]: "s" }) as [Column];
const column = (id: string) => RUN_COLUMNS.find((each) => each.id === id) as Column;
const told = (groups: ReturnType<typeof groupsOf>) => groups.map(({ title, runs }) => [title, runs.map(({ run }) => run)]);

describe("groups of runs", () => {
  it("are of those that agree in a column, in the order in which they come", () => {
    expect(told(groupsOf(RUNS, headway))).toEqual([
      ["Headway [s] 0.6", [1, 3]],
      ["Headway [s] 0.9", [2, 4]],
      ["Headway [s] 1.2", [5]],
    ]);
  });

  it("know the same tags in whatever order", () => {
    expect(told(groupsOf(RUNS, column("tags")))).toEqual([
      ["Tags: none", [1, 3, 5]],
      ["Tags wet, night", [2, 4]],
    ]);
  });

  it("are sorted as units by their means, those without one last", () => {
    const order = (desc: boolean) => groupsOf(RUNS, headway, { column: gap, desc }).map(({ key }) => key);
    expect(order(false)).toEqual(["0.6", "0.9", "1.2"]);
    expect(order(true)).toEqual(["0.9", "0.6", "1.2"]);
  });

  it("are folded to their heads", () => {
    const groups = groupsOf(RUNS, headway);
    const lines = entriesOf(groups, new Set(["0.6"])).map(({ run, group }) => run?.run ?? group?.title);
    expect(lines).toEqual(["Headway [s] 0.6", "Headway [s] 0.9", 2, 4, "Headway [s] 1.2", 5]);
  });

  it("are made of what was said and set, and not of what came out", () => {
    const ids = groupable([...RUN_COLUMNS, headway, gap]).map(({ id }) => id);
    expect(ids).toContain(`parameter:${PATH}`);
    expect(ids).toContain("verdict");
    for (const id of ["run", "created", gap.id]) expect(ids).not.toContain(id);
  });
});

describe("what a group says", () => {
  it("is mean and deviation of a metric, without runs that ended early", () => {
    expect(summary(RUNS, gap)).toEqual({ count: 3, mean: 5, deviation: Math.sqrt(13), least: 2, most: 9 });
    expect(said(RUNS, gap)?.text).toBe("5 ± 3.6");
    expect(said([RUNS[1], RUNS[3]] as typeof RUNS, gap)?.text).toBe("9");
    expect(said([RUNS[4]] as typeof RUNS, gap)).toBeUndefined();
  });

  it("is from where to where a parameter goes, and how many words there are", () => {
    expect(said(RUNS, headway)?.text).toBe("0.6 … 1.2");
    expect(said([RUNS[0], RUNS[2]] as typeof RUNS, headway)?.text).toBe("0.6");
    expect(said(RUNS, column("status"))).toEqual({ text: "2 values", full: "done, stopped" });
  });

  it("is there for more runs than a call has arguments", () => {
    const many = Array.from({ length: 200_000 }, () => RUNS[0] as (typeof RUNS)[0]);
    expect(summary(many, gap)?.most).toBe(2);
  });
});
