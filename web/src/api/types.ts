/** What the API answers besides runs and maps: named as the server describes it, with documents for what that leaves open. */

import type { KnownKind } from "../model/form";
import type { Filled, Server, Tree } from "../model/run";
import type { Schema } from "../model/schema";

export type Info = Server["Info"];
export type ScenarioRow = Server["ScenarioRow"];
export type Scenario = Filled<Server["ScenarioDetail"], { document: Tree; given: Tree; schema: Schema }>;
export type Kinds = Filled<Server["Kinds"], { kinds: KnownKind[] }>;
export type Check = Filled<Server["Check"], { document: Tree }>;
export type LiveRow = Server["Live"];
export type Pace = LiveRow["pace"];
export type SceneVehicle = Server["SceneVehicle"];
export type Scene = Server["SceneCast"];
