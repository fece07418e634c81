import { expect, test } from "vitest";
import { addParameter, addRun, chosen, guesses, interval, type Kinds, mappingText, measured, overrideOf, placedAt, removeParameter, removeRun, type Run, type Said, shareOf, sourcesOf, takeBackOverride } from "./validation";

const run = (log: string): Run => ({ log, begin: 0, end: null, mapping: null });
const said = (more: Partial<Said> = {}): Said => ({
  title: "Mine",
  vehicle: "bmw_320i",
  mapping: null,
  confidence: "two-sided",
  maneuvers: {},
  calibration: {},
  overrides: [],
  ...more,
});
const kinds = {
  signals: [
    { name: "yaw_rate", unit: "rad/s", meaning: "", units: ["rad/s", "deg/s"] },
    { name: "speed", unit: "m/s", meaning: "", units: ["m/s", "km/h"] },
  ],
} as unknown as Kinds;

test("the first run of a kind makes its maneuver, the next one joins it", () => {
  const cut = { log: "day.csv", begin: 61.504, end: 68 };
  expect(addRun(said(), "j_turn", "validation", cut)).toEqual([
    { op: "add", path: "/maneuvers/j_turn", value: { kind: "j_turn", validation: [{ log: "day.csv", begin: 61.5, end: 68 }] } },
  ]);
  const having = said({ maneuvers: { turn: { kind: "j_turn", calibration: [], validation: [run("a.csv")] } } });
  expect(addRun(having, "j_turn", "validation", cut)[0]?.path).toBe("/maneuvers/turn/validation/-");
  expect(addRun(having, "j_turn", "calibration", cut)[0]).toEqual({
    op: "add",
    path: "/maneuvers/turn/calibration",
    value: [{ log: "day.csv", begin: 61.5, end: 68 }],
  });
});

test("the last run takes its maneuver along", () => {
  const one = said({ maneuvers: { turn: { kind: "j_turn", calibration: [], validation: [run("a.csv")] } } });
  expect(removeRun(one, "turn", "validation", 0)).toEqual([{ op: "remove", path: "/maneuvers/turn" }]);
  const two = said({ maneuvers: { turn: { kind: "j_turn", calibration: [run("b.csv")], validation: [run("a.csv")] } } });
  expect(removeRun(two, "turn", "validation", 0)).toEqual([{ op: "remove", path: "/maneuvers/turn/validation" }]);
});

test("a parameter makes its step where there is none", () => {
  expect(addParameter(said(), "lateral", "body.mass", 1000, 2000)[0]?.path).toBe("/calibration");
  const having = said({ calibration: { lateral: { parameters: {}, maneuvers: [] } } });
  expect(addParameter(having, "lateral", "body.mass", 1, 2)[0]?.path).toBe("/calibration/lateral/parameters/body.mass");
});

test("what a person judged otherwise is found by its criterion and taken back", () => {
  const judged = (criterion: string) => ({ maneuver: "turn", criterion, reason: "the sensor was askew" });
  const having = said({ overrides: [judged("gain"), judged("lag")] });
  expect([overrideOf(having, "turn", "lag"), overrideOf(having, "turn", "zone"), overrideOf(having, "lane", "lag")]).toEqual([1, -1, -1]);
  expect(takeBackOverride(having, 1)).toEqual([{ op: "remove", path: "/overrides/1" }]);
  expect(takeBackOverride(said({ overrides: [judged("gain")] }), 0)).toEqual([{ op: "remove", path: "/overrides" }]);
});

test("the last parameter of a step takes the step with it, and the last step all of calibration", () => {
  const range = { low: 0, high: 1, prior: null, spread: null };
  const two = { "body.mass": range, "tyres.front_cornering": range };
  const having = said({ calibration: { lateral: { parameters: two, maneuvers: [] }, drag: { parameters: { "body.mass": range }, maneuvers: [] } } });
  expect(removeParameter(having, "lateral", "body.mass")).toEqual([{ op: "remove", path: "/calibration/lateral/parameters/body.mass" }]);
  expect(removeParameter(having, "drag", "body.mass")).toEqual([{ op: "remove", path: "/calibration/drag" }]);
  const last = said({ calibration: { drag: { parameters: { "body.mass": range }, maneuvers: [] } } });
  expect(removeParameter(last, "drag", "body.mass")).toEqual([{ op: "remove", path: "/calibration" }]);
});

test("a mapping is guessed by name, with the unit of the log where it is one", () => {
  const found = guesses([{ name: "Gierrate", unit: "deg/s" }, { name: "VehicleSpeed", unit: "mph?" }], kinds);
  expect(found.yaw_rate).toMatchObject({ from: ["Gierrate"], unit: "deg/s" });
  expect(found.speed).toMatchObject({ from: ["VehicleSpeed"], unit: "m/s" });
});

test("a signal that is chosen by hand comes in the unit that the log gives it", () => {
  const recorded = [{ name: "Rate", unit: "deg/s" }, { name: "Bare", unit: "" }];
  expect(chosen("Rate", recorded, ["rad/s", "deg/s"])).toMatchObject({ from: ["Rate"], unit: "deg/s" });
  expect(chosen("Bare", recorded, ["rad/s", "deg/s"])).toEqual({ from: ["Bare"], combine: "mean" });
  expect(chosen("", recorded, ["rad/s", "deg/s"]).from).toEqual([]);
});

test("a mapping is written without what goes without saying", () => {
  const text = mappingText({
    yaw_rate: { from: ["Gierrate: links"], unit: "deg/s", combine: "mean", sign: -1, offset: 0.4, delay: 0 },
    speed: { from: [], unit: "m/s", combine: "mean", sign: 1, offset: 0, delay: 0 },
  });
  expect(text).toBe('signals:\n  yaw_rate: {from: "Gierrate: links", unit: "deg/s", sign: -1, offset: 0.4}\n');
});

test("the place of a sensor is written, and taken away when it is the centre of gravity", () => {
  const at = placedAt(placedAt(null, 0, 1.4), 1, -0.3);
  const entry = { from: ["AccY"], unit: "g", combine: "mean", sign: 1, offset: 0, delay: 0, at } as const;
  expect(mappingText({ lateral_acceleration: entry })).toContain("at: [1.4, -0.3, 0]}");
  expect(placedAt(placedAt(at, 0, 0), 1, 0)).toBeNull();
});

test("a mapping that was kept is written again as it was: its DBC, its lists, what they become", () => {
  const rest = { sign: 1, offset: 0, delay: 0 } as const;
  const kept = {
    dbc: "car.dbc",
    signals: { speed: { from: ["v[0]", "v[1]"], unit: "m/s", combine: "norm", ...rest }, yaw_rate: { from: "w", unit: "", combine: "mean", ...rest } },
  } as const;
  const sources = sourcesOf(structuredClone(kept) as never, kinds);
  expect(mappingText(sources, kept.dbc)).toBe(
    'dbc: "car.dbc"\nsignals:\n  yaw_rate: {from: "w"}\n  speed: {from: ["v[0]","v[1]"], unit: "m/s", combine: norm}\n',
  );
  expect(sourcesOf({ dbc: null, signals: {} }, kinds).speed?.from).toEqual([]);
});

test("one-sided bounds of 95 % are drawn as the interval of 90 % that they are", () => {
  expect(shareOf("95 % confidence interval of the mean, two-sided, t(0.975, n - 1)")).toBe("95 % confidence interval");
  expect(shareOf("one-sided 95 % bounds of the mean, t(0.95, n - 1): a two-sided interval of 90 %")).toBe("90 % confidence interval");
});

test("a number of a verdict has its unit, a share is in per cent, and what an older studio judged has none", () => {
  expect(measured(0.3541, "rad/s")).toBe("0.3541 rad/s");
  expect(measured(-0.0285, "1")).toBe("\u22122.85 %");
  expect(measured(0.07, "1")).toBe("7 %");
  expect(measured(0.3541, undefined)).toBe("0.3541");
  expect(measured(null, "s")).toBe("–");
  expect(interval(0.1, 0.25, "s")).toBe("0.1 to 0.25 s");
  expect(interval(null, 1, "s")).toBe("–");
});
