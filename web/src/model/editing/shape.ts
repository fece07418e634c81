/**
 * The shape of things, corner by corner: the outline of an area, the way of somebody who moves, a wall by its two ends, a circle by its
 * radius. A corner is moved, put on an edge, and taken out, as long as enough are left.
 */

import type { Json, Server, Tree } from "../run";
import { isTree } from "../schema";
import type { Point } from "../view";
import { at, entry } from "./deed";
import { type Deed, type Editing, type Item, named, owner } from "./item";
import { rounded } from "./line";

type Corner = [number, number];

/** Corners that can be taken hold of. */
export interface Shape {
  /** Where they stand in the document. */
  path: string;
  corners: Corner[];
  /** Whether the last is joined to the first. */
  closed: boolean;
  /** So many have to be left, and so many may be. */
  least: number;
  most: number;
}

/** The corners of an item; nothing of what has none on the map: along a route they are stations. */
export function shapeOf(state: Editing, { path, group }: Item): Shape | undefined {
  const ring = at(state.document, `${path}.corners`);
  if ((group === "area" || group === "radio") && isLine(ring)) return { path: `${path}.corners`, corners: ring, closed: true, least: 3, most: 64 };
  const deed = at(state.document, `${path}.do`);
  if (!isTree(deed) || typeof deed.route === "string" || !isLine(deed.line)) return undefined;
  return { path: `${path}.do.line`, corners: deed.line, closed: false, least: deed.kind === "mover" ? 1 : 2, most: 200 };
}

const isLine = (value: Json | undefined): value is Corner[] =>
  Array.isArray(value) && value.length > 0 && value.every((each) => Array.isArray(each) && each.length === 2);

/** The edges of a shape, each by its two corners. */
export function edgesOf({ corners, closed }: Shape): [Corner, Corner][] {
  const ends = closed ? [...corners.slice(1), corners[0] as Corner] : corners.slice(1);
  return ends.map((end, number) => [corners[number] as Corner, end]);
}

export const halfway = ([[ax, ay], [bx, by]]: [Corner, Corner]): Point => ({ x: (ax + bx) / 2, y: (ay + by) / 2 });

/** The corners with one moved. */
export const withCorner = (corners: readonly Corner[], number: number, to: Point): Corner[] => corners.map((each, n) => (n === number ? cornerAt(to) : each));

/** The corners with one more behind the corner of a number. */
export const withMore = (corners: readonly Corner[], behind: number, to: Point): Corner[] => [...corners.slice(0, behind + 1), cornerAt(to), ...corners.slice(behind + 1)];

const cornerAt = ({ x, y }: Point): Corner => [rounded(x), rounded(y)];

/** A change of the corners of an item, as they are now. */
function reshaped(state: Editing, item: Item, change: (shape: Shape) => Corner[] | undefined): Deed | undefined {
  const shape = shapeOf(state, item);
  const corners = shape && change(shape);
  if (!shape || !corners || corners.length < shape.least || corners.length > shape.most) return undefined;
  return { name: `Reshape ${named([item.path])}`, patch: [replace(shape.path, corners)] };
}

/** One corner somewhere else. */
export const cornerMoved = (state: Editing, item: Item, number: number, to: Point): Deed | undefined =>
  reshaped(state, item, ({ corners }) => (number < corners.length ? withCorner(corners, number, to) : undefined));

/** One more corner on the edge of a number, halfway or where it was dragged to. */
export const cornerAdded = (state: Editing, item: Item, edge: number, to?: Point): Deed | undefined =>
  reshaped(state, item, (shape) => {
    const found = edgesOf(shape)[edge];
    return found && withMore(shape.corners, edge, to ?? halfway(found));
  });

/** One corner fewer; nothing when the others would be no shape. */
export const cornerRemoved = (state: Editing, item: Item, number: number): Deed | undefined =>
  reshaped(state, item, ({ corners }) => corners.filter((_, n) => n !== number));

const replace = (path: string, value: Json) => ({ op: "replace", path: `/${path.split(".").join("/")}`, value }) as unknown as Server["Operation"];

// -- walls ---------------------------------------------------------------------------------------

/** A piece of wall is at most so long, and at least [m]. */
export const LONGEST_WALL = 50;
const SHORTEST_WALL = 0.1;

/** The two ends of a wall. */
export function endsOf(state: Editing, item: Item): [Corner, Corner] | undefined {
  const deed = at(state.document, `${item.path}.do`);
  const length = item.figures[0]?.length;
  if (!isTree(deed) || deed.kind !== "object" || deed.shape !== "wall" || !length) return undefined;
  const { x, y, heading } = deed as { x: number; y: number; heading: number };
  const [u, v] = [(Math.cos(heading) * length) / 2, (Math.sin(heading) * length) / 2];
  return [
    [x - u, y - v],
    [x + u, y + v],
  ];
}

/** A wall between two places, in the words of the file. */
const between = ([ax, ay]: Corner, [bx, by]: Corner): Tree => ({
  x: rounded((ax + bx) / 2),
  y: rounded((ay + by) / 2),
  heading: rounded(Math.atan2(by - ay, bx - ax), 3),
  length: rounded(Math.hypot(bx - ax, by - ay)),
});

const isWall = ([ax, ay]: Corner, [bx, by]: Corner): boolean => {
  const length = Math.hypot(bx - ax, by - ay);
  return length >= SHORTEST_WALL && length <= LONGEST_WALL;
};

/** One end of a wall somewhere else, the other where it is; nothing when it would be too long. */
export function endMoved(state: Editing, item: Item, number: number, to: Point): Deed | undefined {
  const ends = endsOf(state, item);
  if (!ends) return undefined;
  const [a, b] = withCorner(ends, number, to) as [Corner, Corner];
  if (!isWall(a, b)) return undefined;
  const set = Object.fromEntries(Object.entries(between(a, b)).map(([key, value]) => [`${item.path}.do.${key}`, value]));
  return { name: `Reshape ${named([item.path])}`, set: set as NonNullable<Deed["set"]> };
}

/** Walls from corner to corner, each side a piece of its own; those that are too long are cut into equal ones. */
export function walls(state: Editing, corners: readonly Point[]): { deed: Deed; paths: string[] } | undefined {
  const pieces = corners.slice(1).flatMap((to, n) => cut(cornerAt(corners[n] as Point), cornerAt(to)));
  let now = state;
  const made = pieces.map(([a, b]) => {
    const { deed, path } = entry(now, "wall", { do: { kind: "object", shape: "wall", ...between(a, b) } });
    now = { ...now, given: { ...now.given, script: { ...((now.given.script as Tree | undefined) ?? {}), [path.split(".")[1] as string]: {} } } };
    return { deed, path };
  });
  if (made.length === 0) return undefined;
  const paths = made.map(({ path }) => path);
  return { deed: { name: `Add ${named(paths)}`, patch: made.flatMap(({ deed }) => deed.patch ?? []) }, paths };
}

function cut(a: Corner, b: Corner): [Corner, Corner][] {
  const length = Math.hypot(b[0] - a[0], b[1] - a[1]);
  if (length < SHORTEST_WALL) return [];
  const count = Math.ceil(length / LONGEST_WALL);
  const along = (n: number): Corner => [a[0] + ((b[0] - a[0]) * n) / count, a[1] + ((b[1] - a[1]) * n) / count];
  return Array.from({ length: count }, (_, n) => [along(n), along(n + 1)]);
}

// -- circles -------------------------------------------------------------------------------------

/** The radius of a circular area. */
export function circleOf(state: Editing, { path, group }: Item): { x: number; y: number; radius: number } | undefined {
  const area = group === "area" || group === "radio" ? at(state.document, path) : undefined;
  if (!isTree(area) || typeof area.x !== "number" || typeof area.y !== "number" || typeof area.radius !== "number") return undefined;
  return { x: area.x, y: area.y, radius: area.radius };
}

/** A circle whose rim goes through a place. */
export function rimMoved(state: Editing, item: Item, to: Point): Deed | undefined {
  const circle = circleOf(state, item);
  const radius = circle && rounded(Math.hypot(to.x - circle.x, to.y - circle.y));
  return radius ? { name: `Reshape ${named([item.path])}`, set: { [`${item.path}.radius`]: radius } } : undefined;
}

// -- what can be taken hold of -------------------------------------------------------------------

/** A point of a shape to take hold of: a corner, the middle of an edge, the end of a wall, the rim of a circle. */
export interface Knob extends Point {
  is: "corner" | "edge" | "end" | "rim";
  number: number;
}

export function knobsOf(state: Editing, item: Item): Knob[] {
  const [shape, ends, circle] = [shapeOf(state, item), endsOf(state, item), circleOf(state, item)];
  if (ends) return ends.map(([x, y], number) => ({ is: "end", number, x, y }));
  if (circle) return [{ is: "rim", number: 0, x: circle.x + circle.radius, y: circle.y }];
  if (!shape) return [];
  const corners = shape.corners.map(([x, y], number): Knob => ({ is: "corner", number, x, y }));
  const middles = shape.corners.length < shape.most ? edgesOf(shape).map((edge, number): Knob => ({ is: "edge", number, ...halfway(edge) })) : [];
  return [...corners, ...middles];
}

/** What a knob is called. */
export const nameOf = ({ is, number }: Knob, { path }: Item): string => {
  const of = owner(path).split(".")[1] ?? "";
  if (is === "rim") return `Radius of ${of}`;
  return is === "edge" ? `New corner of ${of} behind corner ${number + 1}` : `${is === "end" ? "End" : "Corner"} ${number + 1} of ${of}`;
};

/** What becomes of an item when a knob is dragged there. */
export function pulled(state: Editing, item: Item, { is, number }: Knob, to: Point): Deed | undefined {
  if (is === "corner") return cornerMoved(state, item, number, to);
  if (is === "edge") return cornerAdded(state, item, number, to);
  return is === "end" ? endMoved(state, item, number, to) : rimMoved(state, item, to);
}

/** How a shape would look with a knob there. */
export function preview(state: Editing, item: Item, { is, number }: Knob, to: Point): { corners: Corner[]; closed: boolean } | undefined {
  const shape = shapeOf(state, item);
  if (shape) return { corners: is === "edge" ? withMore(shape.corners, number, to) : withCorner(shape.corners, number, to), closed: shape.closed };
  const ends = endsOf(state, item);
  if (ends) return { corners: withCorner(ends, number, to), closed: false };
  const circle = circleOf(state, item);
  if (!circle) return undefined;
  const radius = Math.hypot(to.x - circle.x, to.y - circle.y);
  const turn = (n: number): Corner => [circle.x + radius * Math.cos((n * Math.PI) / 24), circle.y + radius * Math.sin((n * Math.PI) / 24)];
  return { corners: Array.from({ length: 48 }, (_, n) => turn(n)), closed: true };
}
