import { describe, expect, it } from "vitest";
import { finished } from "../test/scenario";
import { changesOf, forest } from "./lineage";

const run = (number: number, parent: number | null, headway = 0.6, seed = 1) =>
  finished({ run: number, parent, seed, parameters: { "platoon.headway": headway } });

describe("trees of runs", () => {
  it("have children below their parents, the oldest first, the newest tree first", () => {
    const found = forest([run(6, null), run(5, 2), run(4, 1), run(3, 2), run(2, 1), run(1, null)]);
    expect(found.map((each) => [each.run.run, each.open])).toEqual([
      [6, []],
      [1, []],
      [2, [true]],
      [3, [true, true]],
      [5, [true, false]],
      [4, [false]],
    ]);
    expect(found.every(({ straight }) => !straight)).toBe(true);
    expect(found.map(({ heirs }) => heirs)).toEqual([0, 4, 2, 0, 0, 0]);
  });

  it("tell of a run whose parent is not shown", () => {
    expect(forest([run(7, 3)])).toMatchObject([{ lost: true, changes: [], open: [] }]);
    expect(forest([run(7, 7)])).toMatchObject([{ run: { run: 7 } }]);
  });

  it("let an only child stand straight below its parent", () => {
    expect(forest([run(1, null), run(2, 1), run(3, 2), run(4, 2)]).map(({ open, straight }) => [open, straight])).toEqual([
      [[], false],
      [[], true],
      [[true], false],
      [[false], false],
    ]);
  });

  it("take a chain of ten thousand generations", () => {
    const found = forest(Array.from({ length: 10_000 }, (_, i) => run(i + 1, i === 0 ? null : i)));
    expect(found.at(-1)).toMatchObject({ open: [], straight: true });
    expect(found[0]?.heirs).toBe(9_999);
  });
});

describe("what was changed", () => {
  it("is what was set otherwise, the seed too", () => {
    expect(changesOf(run(2, 1, 0.9, 5), run(1, null))).toEqual([
      { path: "platoon.headway", from: 0.6, to: 0.9 },
      { path: "seed", from: 1, to: 5 },
    ]);
    expect(changesOf(run(2, 1), run(1, null))).toEqual([]);
  });
});
