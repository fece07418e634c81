import { describe, expect, it } from "vitest";
import { applications, document, source } from "../test/scenario";
import {
  changedIn,
  exchanged,
  exchangesOf,
  type Field,
  fieldsOf,
  fromSet,
  matching,
  placed,
  refusal,
  sameChanges,
  sections,
  suggesting,
  unitAt,
  unitsOf,
  valueAt,
  withChange,
} from "./form";

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
    const kinds = { limit: { speed: { type: "number", unit: "m/s" } }, friction: { width: { type: "number" } } };
    const alternative = ([kind, properties]: [string, object]) => ({
      type: "object",
      properties: { kind: { const: kind }, ...properties },
    });
    const time = alternative(["time", { at: { type: "number", unit: "s" } }]);
    const entry = {
      type: "object",
      properties: {
        do: { oneOf: Object.entries(kinds).map(alternative), title: "Do" },
        until: { anyOf: [{ oneOf: [time] }, { type: "null" }], title: "Until" },
      },
    };
    const happening = {
      ...source(),
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

describe("exchanging an application", () => {
  const [exchange] = exchangesOf(sections(source()));
  const acc = applications[1];
  if (!exchange || !acc) throw new Error("the fixture has an application to exchange");
  const before = {
    "applications.platoon.parameters.headway": 0.9,
    "applications.platoon.parameters.k_p": 0.5,
    "radio.delay": 0.1,
  };
  const after = exchanged(before, exchange, acc);

  it("finds the select of its group", () => {
    expect(exchange).toMatchObject({
      path: "applications.platoon.application",
      group: "platoon",
      initial: "cacc",
    });
  });

  it("keeps parameters that the new one has too and drops the others", () => {
    expect(after).toEqual({
      "applications.platoon.parameters.headway": 0.9,
      "radio.delay": 0.1,
      "applications.platoon.application": "acc",
    });
  });

  it("shows the new one's parameters, with its defaults where the document has none", () => {
    expect(paths(after)).toContain("applications.platoon.parameters.gap_gain");
    expect(paths(after)).not.toContain("applications.platoon.parameters.k_p");
    expect(field("applications.platoon.parameters.gap_gain", after).value).toBe(0.1);
  });

  it("lays out objects that a program has set", () => {
    expect(fromSet({ "applications.platoon.parameters": { headway: 1 }, seed: 2 })).toEqual({
      "applications.platoon.parameters.headway": 1,
      seed: 2,
    });
  });

  it("is no change when it goes back", () => {
    const cacc = applications[0];
    expect(cacc && exchanged(after, exchange, cacc)).toEqual({
      "applications.platoon.parameters.headway": 0.9,
      "radio.delay": 0.1,
    });
  });
});

describe("search and problems", () => {
  it("finds fields by path, label and description, all words at once", () => {
    expect(fieldsOf(matching(sections(source()), "radio sender")).map(({ path }) => path)).toEqual([
      "radio.delay",
    ]);
    expect(matching(sections(source()), "nothing like this")).toEqual([]);
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
  it("finds the unit of an exchanged application's parameter by its name", () => {
    const units = unitsOf(source());
    expect(unitAt(units, "radio.delay")).toBe("s");
    expect(unitAt(units, "applications.platoon.parameters.gap_gain")).toBe("1/s");
    expect(unitAt(units, "radio.unknown")).toBe("");
  });

  it("reads through objects and lists", () => {
    expect(valueAt(document, "script.0.width")).toBe(2);
    expect(valueAt(document, "radio.nothing.deeper")).toBeUndefined();
  });
});
