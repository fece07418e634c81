/**
 * What a user may correct, and the tags of OpenStreetMap that say it.
 *
 * Keys and values as the wiki of OpenStreetMap defines them: lanes counts both directions, lanes:forward and
 * lanes:backward one each; maxspeed is in km/h when no unit is given; width is that of the whole carriageway in metres;
 * turn:lanes has one entry per lane, from left to right as one drives.
 */

import type { Plan, PlanLane, PlanRoad, Tags } from "./map";

export type Arrow = "left" | "slight_left" | "through" | "slight_right" | "right";

export const ARROWS: readonly Arrow[] = ["left", "slight_left", "through", "slight_right", "right"];

export const ARROW_SIGNS: Record<Arrow, string> = {
  left: "←",
  slight_left: "↖",
  through: "↑",
  slight_right: "↗",
  right: "→",
};

/** What a road is taken to be: lanes along its way and against it, speed [km/h] and width of a lane [m]. */
export interface Profile {
  /** Whether this road runs in the direction in which its way was drawn. */
  along: boolean;
  forward: number;
  backward: number;
  speed: number;
  laneWidth: number;
}

/** What a user may change of a way, `null` where nothing is to be changed. */
export interface Change {
  forward: number | null;
  backward: number | null;
  speed: number | null;
  laneWidth: number | null;
  /** The arrows of this road's lanes, from left to right. */
  turns: Arrow[][] | null;
}

/** What of a way is asked for. */
export type Part = "lanes" | "speed" | "width" | "turns";

export const ALL_PARTS: readonly Part[] = ["lanes", "speed", "width", "turns"];

export const UNCHANGED: Change = { forward: null, backward: null, speed: null, laneWidth: null, turns: null };

/** What is allowed, with units; the width of a lane as the import takes it. */
export const LIMITS = {
  lanes: { least: 1, most: 16, unit: "" },
  speed: { least: 5, most: 250, unit: "km/h" },
  laneWidth: { least: 2.5, most: 4.5, unit: "m" },
  height: { least: 1, most: 900, unit: "m" },
} as const;

/** The name by which corrections call a way. */
export const wayElement = (way: number): string => `way ${way}`;

/** Roads that run against the direction of their way have a minus before their name. */
const runsAlong = ({ id }: PlanRoad): boolean => !id.startsWith("-");

/** What a way is taken to be, seen from one of its roads. */
export function profileOf(plan: Plan, road: PlanRoad, way: number): Profile {
  const sharing = plan.roads.filter(({ ways }) => ways.includes(way));
  const most = (along: boolean) =>
    Math.max(0, ...sharing.filter((other) => runsAlong(other) === along).map(({ lanes }) => lanes.length));
  const lanes = lanesOf(plan, road);
  return {
    along: runsAlong(road),
    forward: most(true),
    backward: most(false),
    speed: Math.round((lanes[0]?.speed ?? 0) * 3.6),
    laneWidth: Math.round((lanes[0]?.width ?? 0) * 100) / 100,
  };
}

/** The lanes of a road, the kerb lane first. */
export function lanesOf(plan: Plan, { lanes }: PlanRoad): PlanLane[] {
  const own = new Set(lanes);
  return plan.lanes.filter(({ id }) => own.has(id)).sort((one, other) => one.index - other.index);
}

/** The road that a way is seen by, when only the way is known: the one along it, or else the first. */
export function roadOf(plan: Plan, way: number): PlanRoad | undefined {
  const sharing = plan.roads.filter(({ ways }) => ways.includes(way));
  return sharing.find(runsAlong) ?? sharing[0];
}

/** The number of a way or node in `way 4711`. */
export function numberOf(element: string, type: string): number | undefined {
  const [kind, number] = element.split(" ");
  return kind === type && number !== undefined && /^-?\d+$/.test(number) ? Number(number) : undefined;
}

/** The tags of a change. */
export function tagsOf(change: Change, before: Profile): Tags {
  const forward = change.forward ?? before.forward;
  const backward = change.backward ?? before.backward;
  const tags: Tags = {};
  if (change.forward !== null || change.backward !== null) {
    tags.lanes = String(forward + backward);
    if (forward > 0 && backward > 0) {
      tags["lanes:forward"] = String(forward);
      tags["lanes:backward"] = String(backward);
    }
  }
  if (change.speed !== null) tags.maxspeed = String(change.speed);
  if (change.laneWidth !== null) tags.width = plain(change.laneWidth * (forward + backward));
  if (change.turns !== null) tags[turnKey(before, forward, backward)] = turnText(change.turns);
  return tags;
}

/** The same, with what was not changed as it is taken to be: a guess may also be confirmed. */
export const settled = (change: Change, before: Profile, parts: readonly Part[]): Change => ({
  forward: change.forward ?? (parts.includes("lanes") ? before.forward : null),
  backward: change.backward ?? (parts.includes("lanes") ? before.backward : null),
  speed: change.speed ?? (parts.includes("speed") ? before.speed : null),
  laneWidth: change.laneWidth ?? (parts.includes("width") ? before.laneWidth : null),
  turns: change.turns,
});

/** A two-way way has arrows for each direction. */
const turnKey = ({ along }: Profile, forward: number, backward: number): string =>
  forward > 0 && backward > 0 ? `turn:lanes:${along ? "forward" : "backward"}` : "turn:lanes";

/** `left|through|through;right`; a lane without arrows is empty. */
export const turnText = (turns: readonly (readonly Arrow[])[]): string =>
  turns.map((lane) => ARROWS.filter((arrow) => lane.includes(arrow)).join(";")).join("|");

/** A number to the centimetre, without a tail of zeros. */
const plain = (value: number): string => String(Math.round(value * 100) / 100);

/** Which tag takes a signal at a node away, or puts it there. */
export const signalTags = (there: boolean): { tags: Tags; remove: string[] } =>
  there ? { tags: { highway: "traffic_signals" }, remove: [] } : { tags: {}, remove: ["highway"] };

/** What is wrong with a change; empty when it can be sent. */
export function wrong(change: Change): string {
  const { forward, backward, speed, laneWidth } = change;
  for (const [value, { least, most, unit }, name] of [
    [forward, LIMITS.lanes, "Lanes"],
    [backward, LIMITS.lanes, "Lanes"],
    [speed, LIMITS.speed, "Speed limit"],
    [laneWidth, LIMITS.laneWidth, "Lane width"],
  ] as const) {
    if (value !== null && !(value >= least && value <= most)) return `${name}: ${least} to ${most} ${unit}`.trim();
    if (value !== null && unit === "" && !Number.isInteger(value)) return `${name}: a whole number`;
  }
  return "";
}

/** Whether a change changes anything. */
export const isChanged = (change: Change): boolean => Object.values(change).some((value) => value !== null);
