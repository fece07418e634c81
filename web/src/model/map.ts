/** A map and what hangs on it, as the API tells them. Coordinates are local metres, x east, y north. */

import type { Server } from "./run";

export type MapRow = Server["MapRow"];
export type MapDetail = Server["MapDetail"];
export type Report = Server["MapReport"];
/** Something that was taken without being mapped; the tag `key` of the element settles it. */
export type Guess = Server["MapGuess"];
export type Sure = Guess["sure"];
/** Something mapped that is not in the network, and why. */
export type Skipped = Server["MapSkipped"];
/** A correction of the user that the import has applied; `before` is what the map said. */
export type Corrected = Server["MapCorrected"];
/** Tags that a user has set on an element of the map, or taken away. */
export type Correction = Server["MapCorrection"];
export type Tags = Correction["tags"];

export type Plan = Server["MapPlan"];
export type PlanLane = Server["PlanLane"];
/** Lanes in one direction between two junctions, and the OpenStreetMap ways that they are made of. */
export type PlanRoad = Server["PlanRoad"];
export type PlanArea = Server["PlanArea"];
/** The stop line of a lane, and which way one drives over it [rad]. */
export type PlanSignal = Server["PlanSignal"];
export type DriveSide = Plan["drive_side"];
export type Line = PlanLane["centre"];
/** What has a border, and perhaps holes: a building, a patch of ground. */
export type Outline = Pick<PlanArea, "outline" | "holes">;

/** An import that goes on, or is over. */
export type MapJob = Server["MapJob"];
