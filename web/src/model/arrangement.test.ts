import { describe, expect, it } from "vitest";
import { AS_IT_IS, arranged, moved, offsets, pinned, pinnedOf, toggled } from "./arrangement";
import type { Column } from "./table";

const column = (id: string, group: Column["group"]): Column => ({ id, group, title: id, unit: "", name: id, numeric: true, value: () => 1 });
const columns = [column("run", "run"), column("seed", "run"), column("a", "metrics"), column("b", "metrics"), column("c", "metrics")];
const ids = (all: readonly Column[]) => all.map(({ id }) => id).join("");

describe("columns", () => {
  it("stand as they are until somebody moves one, within its group", () => {
    expect(ids(arranged(columns, AS_IT_IS))).toBe("runseedabc");
    const once = moved(AS_IT_IS, columns, "c", -1);
    expect(ids(arranged(columns, once))).toBe("runseedacb");
    expect(ids(arranged(columns, moved(once, columns, "c", -5)))).toBe("runseedcab");
    expect(ids(arranged(columns, moved(once, columns, "b", 1)))).toBe("runseedacb");
    expect(ids(arranged(columns, moved(once, columns, "seed", -1)))).toBe("seedrunacb");
  });
  it("that come up later stand behind those that were arranged", () => {
    const arrangement = moved(AS_IT_IS, columns.slice(0, 4), "b", -1);
    expect(ids(arranged(columns, arrangement))).toBe("runseedbac");
  });
  it("are hidden and shown again", () => {
    const hidden = toggled(AS_IT_IS, "a");
    expect(hidden.hidden).toEqual(["a"]);
    expect(toggled(hidden, "a")).toEqual(AS_IT_IS);
  });
  it("that stay at the left are moved among themselves, and their old places stay", () => {
    const two = pinned(pinned(AS_IT_IS, "c"), "seed");
    expect(ids(pinnedOf(columns, two))).toBe("cseed");
    expect(ids(pinnedOf(columns, moved(two, columns, "seed", -9)))).toBe("seedc");
    expect(moved(two, columns, "seed", -9).order).toEqual([]);
    expect(ids(arranged(columns, moved(two, columns, "b", -1)))).toBe("runseedcba"); // c is elsewhere, and does not count as a step
    expect(pinned(pinned(two, "c"), "seed")).toEqual(AS_IT_IS);
  });
  it("are shown when they are pinned, and stay pinned while they are hidden", () => {
    const shown = pinned(toggled(AS_IT_IS, "a"), "a");
    expect(shown).toEqual({ hidden: [], order: [], pinned: ["a"] });
    expect(toggled(toggled(shown, "a"), "a")).toEqual(shown);
  });
  it("of which nothing was pinned, kept by an older page, and those that are gone, are no fault", () => {
    expect(pinnedOf(columns, { hidden: [], order: [] })).toEqual([]);
    expect(pinnedOf(columns, pinned(AS_IT_IS, "gone"))).toEqual([]);
  });
  it("begin where those before them end, as long as a third of the table is left", () => {
    expect(offsets([40, 70.5, 100], 900)).toEqual([0, 40, 110.5]);
    expect(offsets([40, 70, 300, 300], 900)).toEqual([0, 40, 110, undefined]);
  });
});
