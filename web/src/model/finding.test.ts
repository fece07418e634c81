import { describe, expect, it } from "vitest";
import { again, changeText, counted, type Finding, findings, MARKS, ordered, shown, worst } from "./finding";
import type { Report } from "./map";

const spot = { latitude: 52, longitude: 13 };
const report = {
  guesses: [
    { number: 1, kind: "lanes", what: "1 lanes", where: "way 7 (Kastanienallee)", element: "way 7", key: "lanes", x: 0, y: 0, ...spot, source: "highway=residential", sure: "medium" },
    { number: 2, kind: "height", what: "9 m", where: "building", element: "way 8", key: "height", x: 9, y: 0, ...spot, source: "no height or levels", sure: "low" },
    { number: 3, kind: "speed limit", what: "10 km/h", where: "way 7 (Kastanienallee)", element: "way 7", key: "maxspeed", x: 0, y: 0, ...spot, source: "highway=living_street", sure: "high" },
  ],
  skipped: [
    { number: 4, kind: "signal", what: "traffic signal", where: "node 5", element: "node 5", x: 4, y: 4, ...spot, reason: "no lane leads to it" },
  ],
  corrected: [
    { number: 5, where: "way 6", element: "way 6", x: 1, y: 1, ...spot, tags: { lanes: "2" }, removed: ["width"], before: { lanes: "", width: "3" } },
  ],
} as unknown as Report;
const all = findings(report);
const NOTHING = { kinds: new Set<string>(), marks: new Set<Finding["mark"]>() };

describe("findings", () => {
  it("are the guesses by how sure, what was skipped, and what was corrected", () => {
    expect(all.map(({ id, mark }) => [id, mark])).toEqual([
      ["f1", "medium"],
      ["f2", "low"],
      ["f3", "high"],
      ["f4", "skipped"],
      ["f5", "corrected"],
    ]);
  });

  it("are called by the name of the road where it has one", () => {
    expect(all.map(({ where }) => where)).toEqual(["Kastanienallee", "building", "Kastanienallee", "node 5", "way 6"]);
  });

  it("say what a correction changes, and what the map says", () => {
    expect(all[4]?.what).toBe("lanes = 2, no width");
    expect(all[4]?.why).toBe("the map says no lanes, width = 3");
    expect(changeText({}, ["highway"])).toBe("no highway");
  });

  it("are filtered by kind, by mark and by every word", () => {
    const ids = (filter: typeof NOTHING, query = "") => shown(all, filter, query).map(({ id }) => id);
    expect(ids(NOTHING)).toEqual(["f1", "f2", "f3", "f4", "f5"]);
    expect(ids({ ...NOTHING, kinds: new Set(["height", "signal"]) })).toEqual(["f1", "f3", "f5"]);
    expect(ids({ ...NOTHING, marks: new Set(["high" as const, "corrected" as const]) })).toEqual(["f1", "f2", "f4"]);
    expect(ids(NOTHING, "KASTANIEN limit")).toEqual(["f3"]);
  });

  it("are counted, the most frequent first", () => {
    expect(counted([...all, ...all.slice(0, 1)], ({ kind }) => kind)[0]).toEqual(["lanes", 2]);
    expect(counted(all, ({ kind }) => kind).reduce((sum, [, count]) => sum + count, 0)).toBe(all.length);
  });

  it("are ordered, the least sure first", () => {
    expect(ordered(all, "mark", false).map(({ mark }) => mark)).toEqual([...MARKS]);
    expect(ordered(all, "mark", true).map(({ mark }) => mark)).toEqual([...MARKS].reverse());
    expect(ordered(all, "what", false).map(({ what }) => what).slice(0, 3)).toEqual(["1 lanes", "9 m", "10 km/h"]);
  });

  it("are as bad as the worst of them", () => {
    expect(worst(all)).toBe("low");
    expect(worst(all.filter(({ mark }) => mark !== "low"))).toBe("medium");
  });
});

describe("after another import", () => {
  const renumbered = (list: Finding[]) => list.map((finding, at) => ({ ...finding, id: String(at + 1) }));

  it("a finding is found under its new number", () => {
    const later = renumbered(all.slice(1));
    expect(again(all[2] as Finding, later)).toBe(later[1]);
    expect(again(all[1] as Finding, later)).toBe(later[0]);
  });

  it("a guess that was corrected is the correction", () => {
    const later = [...all.slice(1), { ...(all[4] as Finding), id: "9", element: "way 7" }];
    expect(again(all[0] as Finding, later)?.id).toBe("9");
  });

  it("a correction that was taken back is the guess again", () => {
    const corrected = { ...(all[4] as Finding), element: "way 8" };
    expect(again(corrected, all.slice(0, 4))?.id).toBe("f2");
  });

  it("what is gone is gone", () => expect(again(all[3] as Finding, all.slice(0, 3))).toBeUndefined());
});
