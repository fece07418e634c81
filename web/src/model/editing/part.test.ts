import { expect, test } from "vitest";
import type { KnownKind } from "../form";
import type { Editing } from "./item";
import { freeName, partsAt, unitOf, unitsFor, withoutPart, withPart } from "./part";

const given = { vehicles: { lead: {}, ego: {} }, applications: { acc: { application: "acc", units: ["ego"] } } };
const document = {
  vehicles: { lead: { sensors: { front: { kind: "front_radar", range: 150 } } }, ego: { sensors: {} } },
  applications: { acc: { application: "acc", units: ["ego"] } },
  goals: {},
};
const state = { given, document } as unknown as Editing;

test("a part goes beside those that stand in the file, under a name of its own", () => {
  expect(freeName(state, "applications", "acc")).toBe("acc_2");
  expect(freeName(state, "applications", "cacc")).toBe("cacc");
  expect(withPart(state, "applications", "cacc", { application: "cacc" })).toEqual([{ op: "add", path: "/applications/cacc", value: { application: "cacc" } }]);
  expect(withoutPart(state, "applications", "acc")).toEqual([{ op: "remove", path: "/applications/acc" }]);
});

test("the sensors that a vehicle has by default stay when it gets another one", () => {
  expect(partsAt(state, "vehicles.lead.sensors")).toEqual(["front"]);
  expect(withPart(state, "vehicles.lead.sensors", "rear", { kind: "blind_spot" })).toEqual([
    { op: "add", path: "/vehicles/lead/sensors", value: { front: { kind: "front_radar" }, rear: { kind: "blind_spot" } } },
  ]);
  expect(withoutPart(state, "vehicles.lead.sensors", "front")).toEqual([{ op: "add", path: "/vehicles/lead/sensors", value: {} }]);
});

test("a first goal begins the goals", () => {
  expect(withPart(state, "goals", "collisions", { most: 0 })).toEqual([{ op: "add", path: "/goals", value: { collisions: { most: 0 } } }]);
});

test("a new application is for who has none yet", () => {
  expect(unitsFor(state)).toEqual(["lead"]);
});

test("a goal has the unit of its measure", () => {
  const kinds = [{ sort: "metric", name: "min_ttc", gives: [{ unit: "s" }] }, { sort: "metric", name: "collisions", gives: [{ unit: "1" }] }] as unknown as KnownKind[];
  expect(unitOf(kinds, "min_ttc")).toBe("s");
  expect(unitOf(kinds, "collisions")).toBe("");
});
