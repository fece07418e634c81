/** A map and what hangs on it, as the API tells them. Coordinates are local metres, x east, y north. */

import type { Problem } from "./run";

export type Sure = "high" | "medium" | "low";
export type DriveSide = "left" | "right";
export type Line = [number, number][];
export type Tags = Record<string, string>;

export interface MapRow {
  id: string;
  title: string;
  kind: "import" | "file";
  source: string;
  attribution: string;
  licence: string;
  drive_side: DriveSide | null;
  lane_km: number | null;
  bytes: number;
  problem: string | null;
}

interface Noted {
  number: number;
  where: string;
  /** `way 4711`, `node 7`; empty where it is none. */
  element: string;
  x: number;
  y: number;
  latitude: number;
  longitude: number;
}

/** Something that was taken without being mapped; the tag `key` of the element settles it. */
export interface Guess extends Noted {
  kind: string;
  what: string;
  key: string;
  source: string;
  sure: Sure;
}

/** Something mapped that is not in the network, and why. */
export interface Skipped extends Noted {
  kind: string;
  what: string;
  reason: string;
}

/** A correction of the user that the import has applied; `before` is what the map said. */
export interface Corrected extends Noted {
  tags: Tags;
  removed: string[];
  before: Tags;
}

export interface Report {
  drive_side: DriveSide;
  drive_side_why: string;
  country: string;
  lane_km: number;
  junctions: number;
  signals: { in_map: number; placed: number; groups: number };
  turn_lanes: { tagged_lanes: number; matching: number };
  speed_limits: { mapped_ways: number; guessed_ways: number; lane_km: Record<string, number> };
  buildings: { placed: number; height_mapped: number; height_guessed: number };
  parking: { areas: number; spaces: number };
  guesses: Guess[];
  skipped: Skipped[];
  corrected: Corrected[];
  seconds: number;
}

/** Tags that a user has set on an element of the map, or taken away. */
export interface Correction {
  element: string;
  tags: Tags;
  removed: string[];
}

export interface MapDetail extends MapRow {
  digest: string;
  report: Report;
  corrections: Correction[];
}

export interface PlanLane {
  id: number;
  road: string;
  /** 0 is the lane at the kerb. */
  index: number;
  width: number;
  speed: number;
  internal: boolean;
  open: boolean;
  centre: Line;
}

/** Lanes in one direction between two junctions, and the OpenStreetMap ways that they are made of. */
export interface PlanRoad {
  id: string;
  name: string;
  lanes: number[];
  ways: number[];
}

export interface Outline {
  outline: Line;
  holes: Line[];
}

export interface PlanArea extends Outline {
  kind: string;
}

/** The stop line of a lane, and which way one drives over it [rad]. */
export interface PlanSignal {
  x: number;
  y: number;
  heading: number;
  lane: number;
}

export interface Plan {
  bounds_m: [number, number, number, number];
  drive_side: DriveSide;
  attribution: string;
  lanes: PlanLane[];
  roads: PlanRoad[];
  junctions: Line[];
  buildings: Outline[];
  areas: PlanArea[];
  signals: PlanSignal[];
}

/** An import that goes on, or is over. */
export interface MapJob {
  id: number;
  map: string;
  status: "running" | "done" | "failed" | "cancelled";
  stage: string;
  /** Null where nobody knows. */
  share: number | null;
  seconds: number;
  problem: { message: string; problems: Problem[] } | null;
}
