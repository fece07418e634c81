/** What the API answers besides runs and comparisons. */

import type { MetricDifference, ParameterDifference } from "../model/compare";
import type { Problem, Run, Status, Tree } from "../model/run";
import type { Schema } from "../model/schema";

export interface Info {
  version: string;
  code_version: string;
  db: string;
  scenarios_folder: string;
}

export interface ScenarioRow {
  id: string;
  title: string;
  description: string;
  vehicles: number;
  duration_s: number;
  attribution: string;
  problem: string | null;
}

export interface Scenario {
  id: string;
  title: string;
  description: string;
  attribution: string;
  scenario_hash: string;
  document: Tree;
  schema: Schema;
}

export interface Check {
  ok: boolean;
  problems: Problem[];
  document: Tree;
}

export type Pace = number | "fast";

export interface LiveRow {
  run: number;
  scenario: string;
  status: Status;
  time: number;
  pace: Pace;
  duration_s: number;
}

export interface SceneVehicle {
  name: string;
  index: number;
  color: string;
}

export interface Scene {
  vehicles: SceneVehicle[];
  attribution: string;
}

export interface Comparison {
  a: Run;
  b: Run;
  parameters: ParameterDifference[];
  metrics: MetricDifference[];
}
