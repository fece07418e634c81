import { describe, expect, it } from "vitest";
import {
  byLine,
  freeName,
  hasWindowsLines,
  mapId,
  matchingScenarios,
  nameFor,
  nameProblem,
  ordered,
  pathOf,
  plainName,
  problemLines,
  type ScenarioRow,
  type TextProblem,
} from "./scenario";

const row = (id: string, part: Partial<ScenarioRow> = {}): ScenarioRow => ({
  id,
  file: `${id}.yaml`,
  title: id,
  description: "",
  map: "maps/town.osm",
  changed: "2026-01-01T00:00:00+00:00",
  digest: "",
  sealed: false,
  runs: 0,
  vehicles: 1,
  duration_s: 60,
  attribution: "",
  problem: null,
  ...part,
});

describe("names of files", () => {
  it("takes letters of any script", () => {
    for (const name of ["platoon", "Großer Stern", "東京", "a-b_c.d", "x.yaml"]) expect(nameProblem(name, [])).toBe("");
    expect(plainName(" Weg.YAML ")).toBe("Weg");
  });

  it.each([
    ["", "a name"],
    [".yaml", "a name"],
    ["..", "no other folder"],
    ["../x", "no other folder"],
    ["/etc/passwd", "no other folder"],
    ["C:\\x", "no other folder"],
    [".x", "dot"],
    ["x.", "dot"],
    ["what?", "“?”"],
    ["a\u202eb", "No file name"],
    ["con", "Windows"],
    ["x".repeat(81), "80"],
    ["Platoon", "already"],
  ])("refuses %j", (name, words) => {
    expect(nameProblem(name, ["platoon"])).toContain(words);
  });

  it("finds one that is free", () => {
    expect(freeName("a", ["b"])).toBe("a");
    expect(freeName("a", ["A", "a_2"])).toBe("a_3");
    expect(freeName("a_2", ["a_2"])).toBe("a_3");
  });

  it("makes one of a title", () => {
    expect(nameFor("Großer Stern: 2 cars, ACC!")).toBe("großer_stern_2_cars_acc");
    expect(nameFor("…")).toBe("");
  });
});

describe("the list", () => {
  const rows = [
    row("b", { title: "Beta", runs: 3, changed: "2026-01-03" }),
    row("a", { title: "Alpha", map: "maps/berlin", changed: "2026-01-02", problem: "a.yaml: seed: is missing\n  more" }),
    row("c", { title: "Gamma", description: "two trucks", runs: null }),
  ];
  const ids = (found: ScenarioRow[]) => found.map(({ id }) => id).join("");

  it("is searched by all words", () => {
    expect(ids(matchingScenarios(rows, ""))).toBe("bac");
    expect(ids(matchingScenarios(rows, "trucks GAMMA"))).toBe("c");
    expect(ids(matchingScenarios(rows, "problem"))).toBe("a");
    expect(ids(matchingScenarios(rows, "berlin"))).toBe("a");
    expect(ids(matchingScenarios(rows, "nothing"))).toBe("");
  });

  it("is ordered", () => {
    expect(ids(ordered(rows, "title"))).toBe("abc");
    expect(ids(ordered(rows, "changed"))).toBe("bac");
    expect(ids(ordered(rows, "runs"))).toBe("bac");
    expect(ids(ordered(rows, "map"))).toBe("abc");
  });

  it("knows the maps of the folder", () => {
    expect(mapId("maps/berlin")).toBe("berlin");
    expect(mapId("../maps/berlin")).toBeUndefined();
    expect(mapId("maps/stern/net.osm")).toBeUndefined();
  });
});

it("tells the first problem of a scenario first", () => {
  expect(problemLines("x.yaml is not valid.\n  seed: is wrong\n  clok: too")).toEqual(["seed: is wrong", ["clok: too"]]);
  expect(problemLines("x.yaml cannot be read")).toEqual(["x.yaml cannot be read", []]);
});

describe("problems of a text", () => {
  const problem = (line: number | null, column: number | null, where = ""): TextProblem => ({
    where,
    what: "",
    value: "",
    allowed: "",
    remedy: "",
    line,
    column,
  });

  it("stand in the order of their lines", () => {
    const found = byLine([problem(7, 3), problem(2, 9), problem(null, null), problem(2, 1)]);
    expect(found.map(({ line, column }) => [line, column])).toEqual([
      [null, null],
      [2, 1],
      [2, 9],
      [7, 3],
    ]);
  });

  it("name the field", () => {
    expect(pathOf({ where: "my.yaml, line 3, column 5: clock.duration" })).toBe("clock.duration");
    expect(pathOf({ where: "my.yaml, line 3, column 5" })).toBe("");
    expect(pathOf({ where: "my.yaml" })).toBe("");
    expect(pathOf({ where: "my.yaml: map.file" })).toBe("map.file");
    expect(pathOf({ where: "body" })).toBe("body");
  });
});

it("keeps the line breaks of a file", () => {
  expect(hasWindowsLines("a\r\nb\r\n")).toBe(true);
  expect(hasWindowsLines("a\r\nb\n")).toBe(false);
  expect(hasWindowsLines("a\nb")).toBe(false);
  expect(hasWindowsLines("\na\r\n")).toBe(false);
});
