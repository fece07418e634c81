import { describe, expect, it } from "vitest";
import { finished } from "../test/scenario";
import { channelsOf, drawn, leadersOf, parts, quantitiesOf, quantity, recorded, vehiclesOf } from "./channel";
import { lineColor } from "./palette";
import { countByStatus, isLive, shortNames, untraced } from "./run";
import { append, noSamples } from "./samples";
import { resolve } from "./schema";
import {
  formatDifference,
  formatDuration,
  formatFixed,
  formatNumber,
  formatRelative,
  formatTime,
  formatValue,
  unitText,
  withUnit,
  words,
} from "./units";

describe("numbers", () => {
  it.each([
    [0, "0"],
    [720, "720"],
    [12345, "12345"],
    [13.8888, "13.89"],
    [-0.4635, "−0.4635"],
    [0.00001, "1·10⁻⁵"],
    [1027291.03, "1.027·10⁶"],
    [-0.000012346, "−1.235·10⁻⁵"],
    [Number.NaN, "–"],
  ])("%d is %s", (value, text) => expect(formatNumber(value)).toBe(text));

  it("keep their sign in differences and ratios", () => {
    expect([formatDifference(0.5), formatDifference(-0.5), formatDifference(0)]).toEqual([
      "+0.5",
      "−0.5",
      "0",
    ]);
    expect([formatRelative(0.1234), formatRelative(-0.5)]).toEqual(["+12.3 %", "−50 %"]);
  });

  it("have no sign where they are told as zero", () => {
    expect([-0.004, -0, 0.004, -0.006].map((value) => formatFixed(value, 2))).toEqual(["0.00", "0.00", "0.00", "−0.01"]);
    expect([formatTime(-1e-9), formatNumber(-0), formatDifference(-0), formatRelative(-1e-9)]).toEqual(["0.00", "0", "0", "0 %"]);
  });

  it("have units, but not the unit one", () => {
    expect([withUnit("Gap", "m"), withUnit("Loss", "1"), withUnit("Count", "")]).toEqual([
      "Gap [m]",
      "Loss",
      "Count",
    ]);
    expect(unitText(null)).toBe("");
  });

  it("tell times so that one tick is seen", () => {
    expect([formatTime(0.02), formatDuration(3.42), formatDuration(125)]).toEqual([
      "0.02",
      "3.4 s",
      "2 min 05 s",
    ]);
  });
});

describe("words", () => {
  it("are read from names", () => {
    expect([words("mean_time_gap"), words("min_ttc"), words("rms_jerk"), words("follower_1")]).toEqual([
      "Mean time gap",
      "Min TTC",
      "RMS jerk",
      "Follower 1",
    ]);
  });

  it("tell values of any kind", () => {
    expect([formatValue(true), formatValue(null), formatValue("cacc"), formatValue(["a"])]).toEqual([
      "on",
      "–",
      "cacc",
      '["a"]',
    ]);
  });
});

describe("a run without traces", () => {
  it("recorded nothing only when it is over", () => {
    expect(untraced("done")).toBe("This run recorded nothing.");
    for (const status of ["waiting", "starting", "running", "paused"] as const) expect(untraced(status)).not.toContain("nothing");
  });
});

describe("channels", () => {
  const all = ["leader.speed", "follower_1.speed", "follower_1.gap", "traffic_01.speed", "leader.x"];

  it("are split at the first dot", () =>
    expect(parts("follower_1.time_gap")).toEqual({ vehicle: "follower_1", quantity: "time_gap" }));

  it("of the platoon are drawn, those of the traffic are not", () => {
    expect(channelsOf("speed", all)).toEqual(["leader.speed", "follower_1.speed"]);
    expect(vehiclesOf(all)).toEqual(["leader", "follower_1"]);
  });

  it("of gaps leave out a platoon's leader, wherever the file names it, and nobody else", () => {
    const two = ["leader.gap", "follower_1.gap"];
    for (const gaps of [two, [...two].reverse()]) {
      expect(drawn("gap", gaps, ["leader"])).toEqual(["follower_1.gap"]);
      expect(drawn("gap", gaps, [])).toEqual(gaps);
    }
    expect(drawn("gap", ["leader.gap"], ["leader"])).toEqual(["leader.gap"]);
    expect(drawn("speed", all, ["leader"])).toEqual(["leader.speed", "follower_1.speed"]);
  });

  it("know a platoon's leader by whom the others listen to", () => {
    const platoon = { units: ["b", "c"], listens_to: ["a", ["b", "a"]] };
    expect(leadersOf({ applications: { platoon } })).toEqual(["a"]);
    expect(leadersOf({ applications: { platoon, next: { units: ["a"], listens_to: ["z"] } } })).toEqual(["z"]);
    expect(leadersOf({ applications: { acc: { units: ["ego"], listens_to: [] }, star: { units: ["b", "c"], listens_to: ["a", "a"] } } })).toEqual([]);
    expect(leadersOf(undefined)).toEqual([]);
  });

  it("hold quantities in the server's words, and its order; others are called by their name", () => {
    const glossary = ["gap", "yaw_rate", "speed"].map((name) => ({ name, label: `The ${name}`, unit: "u", meaning: "m" }));
    expect(quantitiesOf([...all, "traffic_01.wind"], glossary)).toEqual([
      glossary[0],
      glossary[2],
      { name: "x", label: "X", unit: "", meaning: "" },
    ]);
    expect(quantity("time_gap", glossary)).toEqual({ name: "time_gap", label: "Time gap", unit: "", meaning: "" });
  });

  it("of a run keep the unit and label that were recorded with them", () => {
    const glossary = [{ name: "speed", label: "Speed", unit: "m/s", meaning: "forward" }];
    expect(recorded([{ name: "leader.speed", label: "Pace", unit: "km/h" }, { name: "leader.x", label: "East", unit: "m" }], glossary)).toEqual([
      { name: "speed", label: "Pace", unit: "km/h", meaning: "forward" },
      { name: "x", label: "East", unit: "m", meaning: "" },
    ]);
  });
});

describe("line colours", () => {
  /** Relative luminance and contrast after WCAG 2.2. */
  const luminance = (hex: string) => {
    const [r, g, b] = [1, 3, 5]
      .map((at) => Number.parseInt(hex.slice(at, at + 2), 16) / 255)
      .map((c) => (c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4)) as [number, number, number];
    return 0.2126 * r + 0.7152 * g + 0.0722 * b;
  };
  const contrast = (one: string, other: string) => {
    const [high, low] = [luminance(one), luminance(other)].sort((a, b) => b - a) as [number, number];
    return (high + 0.05) / (low + 0.05);
  };

  it("are all different and stand out from the page in both themes", () => {
    for (const [dark, page] of [
      [false, "#ffffff"],
      [true, "#242424"],
    ] as const) {
      const colors = Array.from({ length: 8 }, (_, index) => lineColor(index, dark));
      expect(new Set(colors).size).toBe(8);
      for (const color of colors) expect(contrast(color, page), color).toBeGreaterThan(3);
    }
  });
});

describe("samples", () => {
  it("grow, pad late channels, and leave out what is known", () => {
    const samples = noSamples();
    append(samples, { time: [0, 0.02], channels: { "leader.speed": [1, 2] } });
    append(samples, { time: [0.02, 0.04], channels: { "leader.speed": [2, 3], "f.gap": [8, 9] } });
    append(samples, { time: [0.06], channels: { "f.gap": [null] } });
    expect(samples).toEqual({
      time: [0, 0.02, 0.04, 0.06],
      channels: { "leader.speed": [1, 2, 3, null], "f.gap": [null, null, 9, null] },
    });
  });

  it("stay when nothing is new", () => {
    const samples = { time: [1], channels: { a: [1] } };
    append(samples, { time: [0.5, 1], channels: { a: [7, 8] } });
    expect(samples).toEqual({ time: [1], channels: { a: [1] } });
  });
});

describe("runs", () => {
  it("are counted by status, most first", () => {
    const runs = [finished({}), finished({ status: "failed" }), finished({})];
    expect(countByStatus(runs)).toEqual([
      ["done", 2],
      ["failed", 1],
    ]);
  });

  it("are live while they can change", () => {
    expect([isLive("starting"), isLive("paused"), isLive("stopped"), isLive(undefined)]).toEqual([
      true,
      true,
      false,
      false,
    ]);
  });

  it("have parameters with the shortest names that differ", () => {
    expect(shortNames(["a.b.x", "a.c.x", "q.y"])).toEqual({ "a.b.x": "b.x", "a.c.x": "c.x", "q.y": "y" });
  });
});

describe("schemas", () => {
  it("keep what stands beside a reference", () => {
    const root = { $defs: { T: { type: "object", title: "T" } } };
    expect(resolve({ $ref: "#/$defs/T", title: "Mine" }, root, {})).toEqual({
      type: "object",
      title: "Mine",
    });
  });

  it("merge all parts and survive a dangling reference", () => {
    expect(resolve({ allOf: [{ type: "number" }, { minimum: 1 }], unit: "m" }, {}, 1)).toEqual({
      type: "number",
      minimum: 1,
      unit: "m",
    });
    expect(resolve({ $ref: "#/$defs/None" }, {}, 1)).toEqual({});
  });
});
