/** What the API answers besides runs and comparisons. */

import type { MetricDifference, ParameterDifference } from "../model/compare";
import type { Application } from "../model/form";
import type { MapDetail, MapJob, MapRow, Plan, Report } from "../model/map";
import type { LiveStatus, Problem, Run, RunDetail, Trace, Tree } from "../model/run";
import type { Schema } from "../model/schema";
import type { components } from "./schema";

export interface Info {
  version: string;
  code_version: string;
  db: string;
  scenarios_folder: string;
  compiling: Compiling | null;
}

/** How far the first compilation on a machine is. */
export interface Compiling {
  done: number;
  of: number;
  seconds: number;
  latest: string;
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
  status: LiveStatus;
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

type Server = components["schemas"];

/** True when the page's type has exactly the server's fields, each at least as narrow. */
type Same<Page, Theirs> = Page extends Theirs ? (keyof Page extends keyof Theirs ? true : never) : never;

/** One entry per answer that the page reads: what the server changes, stops compiling here. */
type Agreed = [
  Same<Info, Server["Info"]>,
  Same<ScenarioRow, Server["ScenarioRow"]>,
  Same<keyof Scenario, keyof Server["ScenarioDetail"]>,
  Same<Check, Server["Check"]>,
  Same<keyof Application, keyof Server["Application"]>,
  Same<Run, Server["Run"]>,
  Same<RunDetail, Server["RunDetail"]>,
  Same<Trace, Server["Trace"]>,
  Same<Comparison, Server["Comparison"]>,
  Same<LiveRow, Server["Live"]>,
  Same<Scene, Server["SceneCast"]>,
  Same<MapRow, Server["MapRow"]>,
  Same<keyof MapDetail, keyof Server["MapDetail"]>,
  Same<Report["guesses"][number], Server["MapGuess"]>,
  Same<Report["skipped"][number], Server["MapSkipped"]>,
  Same<Report["corrected"][number], Server["MapCorrected"]>,
  Same<MapDetail["corrections"][number], Server["MapCorrection"]>,
  Same<keyof Plan, keyof Server["MapPlan"]>,
  Same<Plan["lanes"][number], Server["PlanLane"]>,
  Same<Plan["roads"][number], Server["PlanRoad"]>,
  Same<MapJob, Server["MapJob"]>,
];

/** Asks the compiler to look at every entry. */
export const agreed: Agreed = [
  ...[true, true, true, true, true, true, true, true, true, true, true] as const,
  ...[true, true, true, true, true, true, true, true, true, true] as const,
];
