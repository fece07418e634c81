import { describe, expect, it } from "vitest";
import { document, kinds, source } from "../test/scenario";
import {
  changedIn,
  exchanged,
  exchangesOf,
  type Field,
  fieldsOf,
  fromSet,
  type KnownKind,
  matching,
  placed,
  refusal,
  type Source,
  sameChanges,
  sections,
  suggesting,
  unitAt,
  unitsOf,
  valueAt,
  withChange,
  withoutSaved,
} from "./form";
import type { Changes, Tree } from "./run";

const field = (path: string, changes = {}): Field => {
  const found = fieldsOf(sections(source(changes))).find((one) => one.path === path);
  if (!found) throw new Error(`no field ${path}`);
  return found;
};
const paths = (changes = {}) => fieldsOf(sections(source(changes))).map(({ path }) => path);

describe("the form", () => {
  it("has one section per part, what is tuned most first, and none for empty or other places", () => {
    expect(sections(source()).map(({ path }) => path)).toEqual([
      "applications",
      "radio",
      "vehicles",
      "script",
    ]);
  });

  it("marks what neither the file nor the user says as a default, with its value", () => {
    const model = "vehicles.leader.model";
    expect(field(model)).toMatchObject({ value: "bmw_320i", isDefault: true });
    expect(field(model, { [model]: "ford_escort" })).toMatchObject({ value: "ford_escort", isDefault: false });
    expect(field("radio.delay").isDefault).toBe(false);
    expect(field("applications.platoon.parameters.standstill")).toMatchObject({ value: 2, isDefault: true });
    const acc = { "applications.platoon.application": "acc" };
    expect(field("applications.platoon.parameters.standstill", acc)).toMatchObject({ value: 3, isDefault: true });
    expect(field("applications.platoon.parameters.headway", acc)).toMatchObject({ value: 0.6, isDefault: false });
  });

  it("gives a number its unit, its range and its words", () => {
    expect(field("radio.delay")).toMatchObject({
      label: "Delay",
      unit: "s",
      minimum: 0,
      maximum: 1,
      kind: "number",
      value: 0.02,
      changed: false,
    });
    expect(field("radio.delay").allowed).toBe("at least 0, at most 1 s");
    expect(field("radio.loss")).toMatchObject({ unit: "", allowed: "at least 0, below 1" });
  });

  it("knows choices, colours, lists and what may be empty", () => {
    expect(field("vehicles.leader.model")).toMatchObject({
      kind: "choice",
      choices: ["bmw_320i", "ford_escort"],
    });
    expect(field("vehicles.leader.colour").kind).toBe("colour");
    expect(field("applications.platoon.vehicles").kind).toBe("list");
    expect(field("vehicles.leader.position.along")).toMatchObject({
      kind: "number",
      nullable: true,
      value: null,
    });
    expect(field("radio.delay").nullable).toBe(false);
  });

  it("chooses the variant that a constant names, and shows no constant", () => {
    expect(paths()).toContain("script.0.width");
    expect(paths()).not.toContain("script.0.duration");
    expect(paths()).not.toContain("script.0.kind");
  });

  it("names entries by their keys and properties by their titles", () => {
    const vehicles = sections(source()).find(({ path }) => path === "vehicles");
    expect(vehicles?.sections[0]?.title).toBe("Leader");
    expect(vehicles?.sections[0]?.sections[0]?.title).toBe("Start");
  });

  it("says in the title which of several kinds it is, and has nothing for an end that is not there", () => {
    const actions = { limit: { speed: { type: "number", unit: "m/s" } }, friction: { width: { type: "number" } } };
    const alternative = ([kind, properties]: [string, object]) => ({
      type: "object",
      properties: { kind: { const: kind }, ...properties },
    });
    const time = alternative(["time", { at: { type: "number", unit: "s" } }]);
    const entry = {
      type: "object",
      properties: {
        do: { oneOf: Object.entries(actions).map(alternative), sort: "action", title: "Do" },
        until: { anyOf: [{ oneOf: [time], sort: "condition" }, { type: "null" }], title: "Until" },
      },
    };
    const kind = (sort: string, name: string) => ({ sort, name, title: name, description: "", source: "", settings: null, gives: [], presets: [] });
    const happening = {
      ...source(),
      kinds: [kind("action", "limit"), kind("action", "friction"), kind("condition", "time"), kind("condition", "gap")],
      schema: { properties: { script: { type: "object", additionalProperties: entry, title: "Script" } } },
      document: {
        script: {
          slow: { do: { kind: "limit", speed: 8.3 }, until: null },
          ice: { do: { kind: "friction", width: 2 }, until: { kind: "time", at: 3 } },
        },
      },
    };
    const [all] = sections(happening);
    expect(all?.sections.map((one) => one.sections.map(({ title }) => title))).toEqual([
      ["Do: limit"],
      ["Do: friction", "Until: time"],
    ]);
    expect(fieldsOf([all as never]).map(({ path }) => path)).toEqual([
      "script.slow.do.speed",
      "script.ice.do.width",
      "script.ice.until.at",
    ]);
  });

  it("marks what is changed and counts it", () => {
    const changed = sections(source({ "radio.delay": 0.3 }));
    expect(field("radio.delay", { "radio.delay": 0.3 })).toMatchObject({
      value: 0.3,
      initial: 0.02,
      changed: true,
    });
    expect(changed.map(changedIn)).toEqual([0, 1, 0, 0]);
  });

  it("takes back a change that sets what the document says", () => {
    const once = withChange({}, field("radio.delay"), 0.3);
    expect(once).toEqual({ "radio.delay": 0.3 });
    expect(withChange(once, field("radio.delay"), 0.02)).toEqual({});
  });
});

describe("two forms", () => {
  it("are the same in whatever order they were filled in", () => {
    expect(sameChanges({ a: 1, b: [2] }, { b: [2], a: 1 })).toBe(true);
    expect(sameChanges({ a: 1 }, { a: 1, b: 2 })).toBe(false);
    expect(sameChanges({ a: null }, { b: null })).toBe(false);
  });
});

describe("exchanging a kind", () => {
  const [exchange, sensor] = exchangesOf(sections(source()));
  if (!exchange || !sensor) throw new Error("the fixture has an application and a sensor to exchange");
  const before = {
    "applications.platoon.parameters.headway": 0.9,
    "applications.platoon.parameters.k_p": 0.5,
    "vehicles.leader.sensors.front.range": 80,
    "vehicles.leader.sensors.front.rate_noise": 0.2,
    "radio.delay": 0.1,
  };
  const after = exchanged(before, exchange, "acc");
  const [front, lidar] = ["vehicles.leader.sensors.front", exchanged({}, sensor, "lidar")];

  it("finds the places, and what may stand there", () => {
    expect(exchange).toMatchObject({ path: "applications.platoon.application", sort: "application", initial: "cacc" });
    expect(sensor).toMatchObject({ path: `${front}.kind`, base: front, value: "radar", description: "by radio waves" });
    expect(sensor.choices.map(({ title }) => title)).toEqual(["Beams", "Radar"]);
  });

  it("keeps settings that the new one has too and drops the others", () => {
    expect(after).toEqual({
      "applications.platoon.parameters.headway": 0.9,
      "vehicles.leader.sensors.front.range": 80,
      "vehicles.leader.sensors.front.rate_noise": 0.2,
      "radio.delay": 0.1,
      "applications.platoon.application": "acc",
    });
    expect(exchanged(before, sensor, "lidar")).toEqual({
      "applications.platoon.parameters.headway": 0.9,
      "applications.platoon.parameters.k_p": 0.5,
      [`${front}.range`]: 80,
      "radio.delay": 0.1,
      [`${front}.kind`]: "lidar",
    });
  });

  it("shows the new one's settings, as the file gives them, or else its own defaults", () => {
    expect(paths(after)).toContain("applications.platoon.parameters.gap_gain");
    expect(paths(after)).not.toContain("applications.platoon.parameters.k_p");
    expect(field("applications.platoon.parameters.gap_gain", after).value).toBe(0.1);
    expect(field("applications.platoon.parameters.headway", exchanged({}, exchange, "acc")).value).toBe(0.6);
    expect(field("applications.platoon.parameters.standstill", after).value).toBe(3);
    expect(field(`${front}.range`, lidar)).toMatchObject({ value: 60, unit: "m", minimum: 0, changed: false });
    expect(paths(lidar)).not.toContain(`${front}.rate_noise`);
  });

  it("shows a setting that has to be given as an empty one", () => {
    expect(field(`${front}.beams`, lidar)).toMatchObject({ value: null, kind: "integer" });
  });

  it("lays out objects that a program has set", () => {
    expect(fromSet({ "applications.platoon.parameters": { headway: 1 }, seed: 2 })).toEqual({
      "applications.platoon.parameters.headway": 1,
      seed: 2,
    });
  });

  it("is no change when it goes back", () => {
    expect(exchanged(lidar, sensor, "radar")).toEqual({});
    expect(changedIn(sections(source(lidar))[2] as never)).toBe(1);
  });
});

describe("search and problems", () => {
  it("finds fields by path, label and description, all words at once", () => {
    expect(fieldsOf(matching(sections(source()), "radio sender")).map(({ path }) => path)).toEqual([
      "radio.delay",
    ]);
    expect(matching(sections(source()), "nothing like this")).toEqual([]);
    const waves = matching(sections(source()), "radio waves");
    expect(exchangesOf(waves).map(({ path }) => path)).toEqual(["vehicles.leader.sensors.front.kind"]);
  });

  it("puts a problem at its field, and one of nowhere at the top", () => {
    const problem = { what: "x", value: "", allowed: "", remedy: "" };
    const map = placed(
      [
        { ...problem, where: "file.yaml: radio.delay" },
        { ...problem, where: "radio.loss" },
        { ...problem, where: "map.osm" },
      ],
      paths(),
    );
    expect([...map.keys()]).toEqual(["radio.delay", "radio.loss", ""]);
    const nested = { ...problem, where: "file.yaml: applications.platoon.parameters: headway" };
    expect([...placed([nested], paths()).keys()]).toEqual(["applications.platoon.parameters.headway"]);
  });
});

describe("the refusal of a form", () => {
  it("names the place in the form, not the file", () => {
    const problem = { what: "is too large", value: "7", allowed: "0 to 1 s", remedy: "take less" };
    expect(refusal([])).toBe("");
    expect(refusal([{ ...problem, where: "sample.yaml: radio.delay" }])).toBe(
      "The form has a problem: radio.delay: is too large (got 7); allowed: 0 to 1 s",
    );
    const two = [{ ...problem, where: "radio.loss", value: "", allowed: "" }, { ...problem, where: "x" }];
    expect(refusal(two)).toBe("The form has a problem: radio.loss: is too large, and 1 more");
  });
});

describe("suggestions", () => {
  it("stand at one field, however deep, and change no other", () => {
    const before = fieldsOf(sections(source()));
    const after = fieldsOf(suggesting(sections(source()), "vehicles.leader.colour", ["#000000"]));
    expect(after.filter((one, at) => one.suggestions !== before[at]?.suggestions && one.suggestions.length > 0).map(({ path }) => path)).toEqual(["vehicles.leader.colour"]);
    expect(after.map(({ suggestions: _, ...one }) => one)).toEqual(before.map(({ suggestions: _, ...one }) => one));
  });
});

describe("units and values by path", () => {
  it("gives a goal the unit of its measure, which stands with the kinds", () => {
    const bounds = { type: "object", properties: { least: { type: "number" }, most: { type: "number" } } };
    const schema = { type: "object", properties: { goals: { type: "object", additionalProperties: bounds } } };
    const of = (name: string, unit: string) =>
      ({ sort: "metric", name, title: name, description: "", source: "", settings: null, gives: [{ name, unit, size: 1, meaning: name }], presets: [] });
    const goals = { min_ttc: { least: 1.2, most: 9 }, collisions: { least: 0, most: 0 } };
    const made = sections({ document: { goals }, given: { goals }, schema, kinds: [of("min_ttc", "s"), of("collisions", "1")], changes: {} } as Parameters<typeof sections>[0]);
    expect(Object.fromEntries(fieldsOf(made).map(({ path, unit }) => [path, unit]))).toEqual({
      "goals.min_ttc.least": "s", "goals.min_ttc.most": "s", "goals.collisions.least": "", "goals.collisions.most": "",
    });
  });

  it("finds the unit of an exchanged kind's setting by its name", () => {
    const units = unitsOf(source());
    expect(unitAt(units, "radio.delay")).toBe("s");
    expect(unitAt(units, "applications.platoon.parameters.gap_gain")).toBe("1/s");
    expect(unitAt(units, "vehicles.leader.sensors.front.range")).toBe("m");
    expect(unitAt(units, "radio.unknown")).toBe("");
  });

  it("reads through objects and lists", () => {
    expect(valueAt(document, "script.0.width")).toBe(2);
    expect(valueAt(document, "radio.nothing.deeper")).toBeUndefined();
  });
});

describe("a preset", () => {
  const preset = (name: string, values: Tree) => ({ name, title: name, source: "measured", values });
  const presets: Record<string, KnownKind["presets"]> = {
    acc: [preset("series", { headway: 1.3, gap_gain: 0.55 })],
    radar: [preset("short", { range: 80, rate_noise: 0.2 })],
    lidar: [preset("roof", { beams: 64 })],
  };
  const nothing = { preset: null };
  const leader = document.vehicles as { leader: Tree };
  const filled = (changes: Changes): Source => ({
    ...source(changes),
    kinds: kinds.map((kind) => ({ ...kind, presets: presets[kind.name] ?? [] })),
    document: {
      ...document,
      applications: { platoon: { ...(document.applications as { platoon: Tree }).platoon, ...nothing } },
      vehicles: { leader: { ...leader.leader, sensors: { front: { kind: "radar", ...nothing, range: 120, rate_noise: 0.3 } } } },
    },
  });
  const platoon = "applications.platoon";
  const front = "vehicles.leader.sensors.front";
  const shown = (changes: Changes) =>
    Object.fromEntries(fieldsOf(sections(filled(changes))).map(({ path, value }) => [path, value]));

  it("shows its values of what the file does not give, as the run has them", () => {
    // The file gives the noise of the sensor, and no reach.
    expect(shown({ [`${front}.preset`]: "short" })).toMatchObject({ [`${front}.range`]: 80, [`${front}.rate_noise`]: 0.3 });
    const acc = { [`${platoon}.application`]: "acc", [`${platoon}.preset`]: "series" };
    expect(shown(acc)).toMatchObject({
      [`${platoon}.parameters.headway`]: 0.6,
      [`${platoon}.parameters.gap_gain`]: 0.55,
      [`${platoon}.parameters.standstill`]: 3,
    });
    expect(shown({ ...acc, [`${platoon}.parameters.gap_gain`]: 0.7 })).toMatchObject({ [`${platoon}.parameters.gap_gain`]: 0.7 });
  });

  it("can be chosen where the kind has some, also of a kind that was exchanged, and is let go with it", () => {
    const choices = (changes: Changes) =>
      fieldsOf(sections(filled(changes)))
        .filter(({ path }) => path.endsWith(".preset"))
        .map(({ path, choices: names, nullable }) => [path, names, nullable]);
    expect(choices({})).toEqual([[`${front}.preset`, ["short"], true]]);
    expect(choices({ [`${platoon}.application`]: "acc", [`${front}.kind`]: "lidar" })).toEqual([
      [`${platoon}.preset`, ["series"], true],
      [`${front}.preset`, ["roof"], true],
    ]);
    const [exchange] = exchangesOf(sections(filled({}))).filter(({ sort }) => sort === "application");
    if (!exchange) throw new Error("the platoon's application can be exchanged");
    expect(exchanged({ [`${platoon}.preset`]: "series" }, exchange, "cacc")).toEqual({});
  });
});

it("keeps what was changed while the rest was saved", () => {
  expect(withoutSaved({ a: 1, b: [2], c: 3 }, { a: 1, b: [2], c: 4 })).toEqual({ c: 3 });
});
