/** A small scenario with everything that a schema made by pydantic can hold. */

import type { KnownKind, Source } from "../model/form";
import type { ListedRun, Metric, Tree } from "../model/run";
import type { Schema } from "../model/schema";

const range = { type: "number", title: "Reach", unit: "m", minimum: 0 };
const radar = { range: { ...range, default: 120 }, rate_noise: { type: "number", unit: "m/s", default: 0.1 } };
const lidar = { range: { ...range, default: 60 }, beams: { type: "integer", unit: "1" } };

export const schema: Schema = {
  $defs: {
    Application: {
      type: "object",
      title: "Application",
      properties: {
        application: { type: "string", title: "Application" },
        vehicles: { type: "array", items: { type: "string" }, title: "On these vehicles" },
        parameters: { type: "object", title: "Parameters" },
      },
    },
    Radio: {
      type: "object",
      title: "Radio",
      properties: {
        delay: {
          type: "number",
          title: "Delay",
          description: "sender to receiver",
          unit: "s",
          minimum: 0,
          maximum: 1,
        },
        loss: { type: "number", title: "Loss rate", unit: "1", minimum: 0, exclusiveMaximum: 1 },
      },
    },
    Place: {
      type: "object",
      title: "Place",
      properties: {
        along: {
          anyOf: [{ type: "number", minimum: 0 }, { type: "null" }],
          unit: "m",
          default: null,
          title: "Along",
        },
      },
    },
    Vehicle: {
      type: "object",
      title: "Vehicle",
      properties: {
        position: { $ref: "#/$defs/Place", title: "Start" },
        model: { type: "string", enum: ["bmw_320i", "ford_escort"], title: "Model" },
        colour: { type: "string", title: "Colour" },
        sensors: {
          type: "object",
          title: "Sensors",
          patternProperties: {
            "^[a-z]+$": { oneOf: [{ $ref: "#/$defs/Radar" }, { $ref: "#/$defs/Lidar" }], sort: "sensor" },
          },
        },
      },
    },
    Radar: { type: "object", properties: { kind: { const: "radar" }, ...radar } },
    Lidar: { type: "object", properties: { kind: { const: "lidar" }, ...lidar } },
    Brake: {
      type: "object",
      properties: { kind: { const: "brake" }, duration: { type: "number", unit: "s" } },
    },
    Swerve: {
      type: "object",
      properties: { kind: { const: "swerve" }, width: { type: "number", unit: "m" } },
    },
  },
  type: "object",
  properties: {
    title: { type: "string" },
    seed: { type: "integer" },
    radio: { $ref: "#/$defs/Radio", title: "Radio" },
    vehicles: {
      type: "object",
      patternProperties: { "^[a-z][a-z0-9_]*$": { $ref: "#/$defs/Vehicle" } },
      title: "Vehicles",
    },
    applications: {
      type: "object",
      additionalProperties: { $ref: "#/$defs/Application" },
      title: "Applications",
    },
    script: { type: "array", items: { oneOf: [{ $ref: "#/$defs/Brake" }, { $ref: "#/$defs/Swerve" }] } },
    goals: { type: "object", additionalProperties: { type: "object" }, title: "Goals" },
  },
};

export const document: Tree = {
  title: "Test",
  seed: 1,
  radio: { delay: 0.02, loss: 0.01 },
  vehicles: {
    leader: {
      position: { along: null },
      model: "bmw_320i",
      colour: "#2f6fde",
      sensors: { front: { kind: "radar", range: 120, rate_noise: 0.3 } },
    },
  },
  applications: {
    platoon: { application: "cacc", vehicles: ["leader"], parameters: { headway: 0.6, standstill: 2, k_p: 0.2 } },
  },
  script: [{ kind: "swerve", width: 2 }],
  goals: {},
};

/** What of the document stands in the file. */
export const given: Tree = {
  ...document,
  vehicles: { leader: { position: { along: null }, sensors: { front: { kind: "radar", rate_noise: 0.3 } } } },
  applications: { platoon: { application: "cacc", vehicles: ["leader"], parameters: { headway: 0.6 } } },
};

const headway = { type: "number", title: "Time headway", unit: "s", minimum: 0.1, maximum: 5 };
const standstill = { type: "number", title: "Standstill", unit: "m" };

const kind = (sort: string, name: string, title: string, description: string, properties: Schema["properties"]) => ({
  sort,
  name,
  title,
  description,
  source: "built in",
  settings: { type: "object", properties } as Schema,
  gives: [],
  presets: [],
});

export const kinds: KnownKind[] = [
  kind("application", "cacc", "Cooperative", "by radio", {
    headway: { ...headway, default: 0.6 },
    standstill: { ...standstill, default: 2 },
    k_p: { type: "number", unit: "1/s²", default: 0.2 },
  }),
  kind("application", "acc", "Alone", "by radar", {
    headway: { ...headway, default: 1.2 },
    standstill: { ...standstill, default: 3 },
    gap_gain: { type: "number", unit: "1/s", default: 0.1 },
  }),
  kind("sensor", "lidar", "Beams", "by light", lidar),
  kind("sensor", "radar", "Radar", "by radio waves", radar),
];

export const source = (changes: Source["changes"] = {}): Source => ({ document, given, schema, kinds, changes });

/** A value of a metric that is about the whole run. */
export const metric = (value: number | null, unit: string, goal: Metric["goal"] = null): Metric => ({
  value,
  unit,
  goal,
  subject: [],
  time: null,
  kind: "",
  about: "",
});

/** A finished run, with whatever is to be different; it has been set to its parameters, and to nothing else. */
export const finished = (part: Partial<ListedRun>): ListedRun => ({
  run: 1,
  scenario: "test",
  scenario_hash: "",
  parent: null,
  seed: 1,
  status: "done",
  error: null,
  state_hash: null,
  code_version: "",
  created: "2026-01-01T00:00:00Z",
  sim_time_s: 60,
  wall_time_s: 1,
  parameters: {},
  unmet: [],
  metrics: {},
  verdict: "open",
  reason: "",
  name: "",
  tags: [],
  note: "",
  settings: part.parameters ?? {},
  ...part,
});
