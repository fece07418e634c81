import { describe, expect, it } from "vitest";
import type { KnownKind } from "./form";
import { settingsOf, whom, windowOf } from "./scope";

const document = {
  measures: {
    braking: {
      kind: "time_exposed_ttc",
      begin: { at: 0, event: null, unit: null, entry: "hard_brake" },
      end: { at: 1.5, event: "script_ended", unit: null, entry: "hard_brake" },
      vehicles: ["follower_1", "follower_2"],
      limit: 2,
    },
    late: { kind: "min_gap", begin: { at: 20 }, end: null, vehicles: [] },
    before: { kind: "min_gap", begin: null, end: { at: -2, event: "collision", unit: "leader", entry: null }, vehicles: [] },
  },
};

const limit = { type: "number", title: "Limit", unit: "s", default: 3 };
const kinds = [
  { sort: "metric", name: "time_exposed_ttc", settings: { properties: { begin: {}, end: {}, vehicles: {}, limit } } },
] as unknown as KnownKind[];

describe("the window of a metric", () => {
  it.each([
    ["min_ttc", "the whole run; all recorded vehicles"],
    ["braking", "from the beginning of hard_brake to 1.5 s after the first script ended of hard_brake; follower_1, follower_2"],
    ["late", "from 20 s to the end; all recorded vehicles"],
    ["before", "from the start to 2 s before the first collision of leader; all recorded vehicles"],
  ])("%s: %s", (name, told) => expect(windowOf(document, name)).toBe(told));

  it("is everything in a scenario that says nothing", () => {
    expect(windowOf({}, "braking")).toBe("the whole run; all recorded vehicles");
  });
});

describe("the settings of a metric", () => {
  it("are those of the scenario, or else by default, with their units", () => {
    expect(settingsOf(document, "braking", kinds)).toEqual(["Limit 2 s"]);
    expect(settingsOf(document, "time_exposed_ttc", kinds)).toEqual(["Limit 3 s"]);
    expect(settingsOf(document, "min_gap", kinds)).toEqual([]);
  });
});

describe("whom a metric is about", () => {
  it("is told without the time, where there is one", () => {
    expect(whom("follower_1 behind leader at 20.74 s", 20.74)).toBe("follower_1 behind leader");
    expect(whom("at 3.00 s", 3)).toBe("");
    expect(whom("no message was sent", null)).toBe("no message was sent");
  });
});
