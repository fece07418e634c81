/** What is under the pointer on a plan: the nearest mark, or the lane that is driven on there. */

import type { Line } from "./map";
import { type Bounds, meet, type Point } from "./view";

/** A lane as picking needs it. */
export interface Strip {
  centre: Line;
  width: number;
  bounds: Bounds;
}

/** Lanes, ready to be picked. */
export const strips = <Lane extends { centre: Line }>(lanes: readonly Lane[]): (Lane & { bounds: Bounds })[] =>
  lanes.filter(({ centre }) => centre.length > 1).map((lane) => ({ ...lane, bounds: boundsOf(lane.centre) }));

/** The bounds of a line [m]. */
export function boundsOf(line: readonly (readonly [number, number])[]): Bounds {
  const [xs, ys] = [line.map(([x]) => x), line.map(([, y]) => y)];
  return [Math.min(...xs), Math.min(...ys), Math.max(...xs), Math.max(...ys)];
}

/** Distance of a point from a line [m]. */
export function distance(line: Line, { x, y }: Point): number {
  let least = Number.POSITIVE_INFINITY;
  for (let at = 0; at + 1 < line.length; at += 1) {
    const [[ax, ay], [bx, by]] = [line[at] as [number, number], line[at + 1] as [number, number]];
    const [dx, dy] = [bx - ax, by - ay];
    const square = dx * dx + dy * dy;
    const along = square > 0 ? Math.min(1, Math.max(0, ((x - ax) * dx + (y - ay) * dy) / square)) : 0;
    least = Math.min(least, Math.hypot(x - ax - along * dx, y - ay - along * dy));
  }
  return least;
}

/** The strip whose edge is nearest, at most `reach` away [m]; on a strip, the one whose middle is nearest. */
export function pickStrip<Kind extends Strip>(among: readonly Kind[], point: Point, reach: number): Kind | undefined {
  let [found, least] = [undefined as Kind | undefined, Number.POSITIVE_INFINITY];
  for (const strip of among) {
    const most = strip.width / 2 + reach;
    if (!meet(strip.bounds, [point.x - most, point.y - most, point.x + most, point.y + most])) continue;
    const away = distance(strip.centre, point);
    if (away <= most && away < least) [found, least] = [strip, away];
  }
  return found;
}

/** The nearest point within `reach` [m]; of equally near ones the last, which is drawn on top. */
export function pickPoint<Kind extends Point>(points: readonly Kind[], at: Point, reach: number): Kind | undefined {
  let [found, least] = [undefined as Kind | undefined, reach];
  for (const point of points) {
    const away = Math.hypot(point.x - at.x, point.y - at.y);
    if (away <= least) [found, least] = [point, away];
  }
  return found;
}

/** Points that would lie on one another on the screen. */
export interface Cluster<Kind extends Point> extends Point {
  members: Kind[];
}

/**
 * Points that are nearer than about `size` [m] as one.
 *
 * The cells stand still on the ground and grow by doubling, so that nothing flickers while the plan is moved.
 */
export function clustered<Kind extends Point>(points: readonly Kind[], size: number): Cluster<Kind>[] {
  const cell = 2 ** Math.round(Math.log2(size));
  const cells = new Map<string, Kind[]>();
  for (const point of points) {
    const key = `${Math.floor(point.x / cell)} ${Math.floor(point.y / cell)}`;
    const members = cells.get(key);
    if (members) members.push(point);
    else cells.set(key, [point]);
  }
  return [...cells.values()].map((members) => ({ members, x: mean(members, "x"), y: mean(members, "y") }));
}

const mean = (points: readonly Point[], axis: "x" | "y"): number =>
  points.reduce((sum, point) => sum + point[axis], 0) / points.length;
