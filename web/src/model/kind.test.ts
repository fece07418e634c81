import { describe, expect, it } from "vitest";
import { kinds } from "../test/scenario";
import { settingsAtRest } from "./form";
import { bySort, matchingKinds } from "./kind";

describe("the list of kinds", () => {
  it("goes sort by sort", () => {
    expect(bySort(kinds).map(([sort, some]) => [sort, some.map(({ name }) => name)])).toEqual([
      ["application", ["cacc", "acc"]],
      ["sensor", ["lidar", "radar"]],
    ]);
  });

  it("finds by all words at once, wherever they stand", () => {
    expect(matchingKinds(kinds, "sensor light").map(({ name }) => name)).toEqual(["lidar"]);
    expect(matchingKinds(kinds, "")).toHaveLength(4);
    expect(matchingKinds(kinds, "sensor cooperative")).toEqual([]);
  });

  it("tells what may be set, with unit, range and default", () => {
    const fields = settingsAtRest(kinds[0] as never);
    expect(fields[0]).toMatchObject({ path: "headway", unit: "s", value: 0.6, allowed: "at least 0.1, at most 5 s" });
  });
});
