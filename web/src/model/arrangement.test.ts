import { describe, expect, it } from "vitest";
import { AS_IT_IS, arranged, moved, toggled } from "./arrangement";
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
});
