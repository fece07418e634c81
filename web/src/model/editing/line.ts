/** Lines on the ground: where a point lies along and beside them. */

import type { Point } from "../view";

/** Corners, east and north [m]. */
export type Line = readonly (readonly [number, number])[];

/** Along a line [m], to its left [m], the direction there [rad], and the point on it. */
export interface Foot extends Point {
  along: number;
  left: number;
  heading: number;
}

/** The nearest point of a line. */
export function foot(line: Line, { x, y }: Point): Foot | undefined {
  let [found, least, before] = [undefined as Foot | undefined, Number.POSITIVE_INFINITY, 0];
  for (let at = 0; at + 1 < line.length; at += 1) {
    const [[ax, ay], [bx, by]] = [line[at] as [number, number], line[at + 1] as [number, number]];
    const length = Math.hypot(bx - ax, by - ay);
    if (length === 0) continue;
    const [c, s] = [(bx - ax) / length, (by - ay) / length];
    const along = Math.min(length, Math.max(0, (x - ax) * c + (y - ay) * s));
    const [px, py] = [ax + along * c, ay + along * s];
    const away = Math.hypot(x - px, y - py);
    if (away < least) {
      least = away;
      found = { x: px, y: py, along: before + along, left: (y - py) * c - (x - px) * s, heading: Math.atan2(s, c) };
    }
    before += length;
  }
  return found;
}

/** The point at a station of a line [m], beyond its ends the ends. */
export function pointAt(line: Line, station: number): Foot {
  let before = 0;
  for (let at = 0; at + 1 < line.length; at += 1) {
    const [[ax, ay], [bx, by]] = [line[at] as [number, number], line[at + 1] as [number, number]];
    const length = Math.hypot(bx - ax, by - ay);
    if (before + length >= station || at + 2 === line.length) {
      const share = length > 0 ? Math.min(1, Math.max(0, (station - before) / length)) : 0;
      const heading = Math.atan2(by - ay, bx - ax);
      return { x: ax + share * (bx - ax), y: ay + share * (by - ay), along: before + share * length, left: 0, heading };
    }
    before += length;
  }
  const [x = 0, y = 0] = line[0] ?? [];
  return { x, y, along: 0, left: 0, heading: 0 };
}

/** Length of a line [m]. */
export const lengthOf = (line: Line): number =>
  line.slice(1).reduce((sum, [x, y], at) => sum + Math.hypot(x - (line[at]?.[0] ?? x), y - (line[at]?.[1] ?? y)), 0);

/** Whether a point lies in a polygon: a ray from it crosses the outline an odd number of times. */
export function inside(outline: Line, { x, y }: Point): boolean {
  let is = false;
  outline.forEach(([ax, ay], at) => {
    const [bx, by] = outline[(at + 1) % outline.length] as [number, number];
    if (ay > y !== by > y && x < ((bx - ax) * (y - ay)) / (by - ay) + ax) is = !is;
  });
  return is;
}

/** The corners of a body with its middle, heading [rad], length and width [m]. */
export function corners(x: number, y: number, heading: number, length: number, width: number): [number, number][] {
  const [c, s] = [Math.cos(heading), Math.sin(heading)];
  const signs = [[1, 1], [-1, 1], [-1, -1], [1, -1]] as const;
  return signs.map(([u, v]) => [x + (c * u * length - s * v * width) / 2, y + (s * u * length + c * v * width) / 2]);
}

/** Rounded as it is written into a file: a centimetre, or a milliradian. */
export const rounded = (value: number, digits = 2): number => Number(value.toFixed(digits));
