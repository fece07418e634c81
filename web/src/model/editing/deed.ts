/** What becomes of the document when something is placed, moved, turned, copied: the edits that the server is asked to do. */

import type { Json, Server, Tree } from "../run";
import { isTree } from "../schema";
import type { Point } from "../view";
import { type Deed, type Editing, type Item, freshName, named, owner } from "./item";
import { foot, pointAt, rounded } from "./line";
import { type Lane, onLane } from "./snap";

type Operation = Server["Operation"];

/** A value of the document, by a path with points. */
export function at(document: Json | undefined, path: string): Json | undefined {
  return path.split(".").reduce<Json | undefined>((node, key) => {
    if (Array.isArray(node)) return node[Number(key)];
    return isTree(node) ? node[key] : undefined;
  }, document);
}

const pointer = (path: string): string => path.split(".").map((key) => `/${key}`).join("");
const replace = (path: string, value: Json): Operation => ({ op: "replace", path: pointer(path), value }) as unknown as Operation;
const add = (path: string, value: Json): Operation => ({ op: "add", path: pointer(path), value }) as unknown as Operation;
const numberOf = (value: Json | undefined): number => (typeof value === "number" ? value : 0);

/** How far everything that is chosen has been dragged: from where it was taken hold of to where it was let go [m]. */
export interface Drag {
  from: Point;
  to: Point;
}

/** Where a vehicle may be on its own way: the drag leaves it there as long as it is so near to it [m]. */
const ON_WAY = 2.2;

/** The drag of everything chosen, or in words why it cannot be. A single vehicle that leaves its way is told by `elsewhere`. */
export function moved(state: Editing, chosen: readonly Item[], drag: Drag, lanes: readonly Lane[]): Deed | undefined {
  const patch = chosen.flatMap((item) => shifted(state, item, drag, lanes));
  return patch.length ? { name: `Move ${named(chosen.map(({ path }) => path))}`, patch } : undefined;
}

/** Those that a drag leaves where they are: vehicles that would come off their way, and what does not lie anywhere by itself. */
export const staying = (state: Editing, chosen: readonly Item[], drag: Drag, lanes: readonly Lane[]): Item[] =>
  chosen.filter((item) => shifted(state, item, drag, lanes).length === 0);

/** Whether a deed says what shall stand at a place whatever stands there now, so that it may follow one's own steps unseen. */
export const isAbsolute = ({ patch = [] }: Deed): boolean => patch.every(({ op, path }) => op === "replace" && !path.includes("/of/"));

/** Where a vehicle is when it is dragged: on its way, beside it on another lane of its roads, or off its way. */
export type Whereabouts = { is: "along"; station: number } | { is: "lane"; road: string; lane: number; offset: number } | { is: "off" };

export function whereabouts(state: Editing, item: Item, to: Point, lanes: readonly Lane[]): Whereabouts {
  const line = item.figures[0]?.line ?? [];
  const own = foot(line, to);
  if (own && Math.hypot(own.x - to.x, own.y - to.y) <= ON_WAY) return { is: "along", station: own.along };
  const roads = at(state.document, `routes.${item.route}.roads`);
  const place = onLane(lanes, to);
  if (place && Array.isArray(roads) && roads.includes(place.road))
    return { is: "lane", road: place.road, lane: place.lane, offset: place.foot.along };
  return { is: "off" };
}

/** The operations that shift one item. */
function shifted(state: Editing, item: Item, { from, to }: Drag, lanes: readonly Lane[]): Operation[] {
  const [dx, dy] = [to.x - from.x, to.y - from.y];
  const figure = item.figures[0];
  const anchor = figure?.anchor ?? undefined;
  switch (item.group) {
    case "vehicle": {
      if (!anchor) return [];
      const place = whereabouts(state, item, { x: anchor[0] + dx, y: anchor[1] + dy }, lanes);
      const position = positionOf(item, place);
      return position ? [replace(`${item.path}.position`, position)] : [];
    }
    case "station": {
      if (!anchor) return [];
      return [replace(`${item.path}.position`, { x: rounded(anchor[0] + dx), y: rounded(anchor[1] + dy) })];
    }
    case "area":
    case "radio":
      return shiftedArea(state, item, { from, to }, lanes);
    case "route":
      return [];
    default:
      return shiftedEntry(state, item, { from, to }, lanes);
  }
}

/** Where a vehicle starts, in the words of the file; on its way as far as that says where its first road begins. */
function positionOf(item: Item, place: Whereabouts): Json | undefined {
  if (place.is === "off") return undefined;
  if (place.is === "lane") return { road: place.road, lane: place.lane, offset: rounded(Math.max(0, place.offset)) };
  if (typeof item.along === "number") return { along: rounded(Math.max(0, place.station)) };
  return { road: item.road ?? "", lane: item.lane ?? 0, offset: rounded(Math.max(0, (item.offset ?? 0) + place.station - (item.station ?? 0))) };
}

function shiftedArea(state: Editing, item: Item, { from, to }: Drag, lanes: readonly Lane[]): Operation[] {
  const area = at(state.document, item.path);
  if (!isTree(area)) return [];
  const [dx, dy] = [to.x - from.x, to.y - from.y];
  if (typeof area.x === "number" && typeof area.y === "number")
    return [replace(`${item.path}.x`, rounded(area.x + dx)), replace(`${item.path}.y`, rounded(area.y + dy))];
  if (Array.isArray(area.corners) && area.corners.length > 0) return [replace(`${item.path}.corners`, translated(area.corners, dx, dy))];
  return shiftedStretch(state, item.path, area, { from, to }, lanes);
}

/** Of an entry of the script what lies somewhere: an object at its place, a line of corners, a stretch of road. */
function shiftedEntry(state: Editing, item: Item, drag: Drag, lanes: readonly Lane[]): Operation[] {
  const [path, deed] = [`${item.path}.do`, at(state.document, `${item.path}.do`)];
  if (!isTree(deed)) return [];
  const [dx, dy] = [drag.to.x - drag.from.x, drag.to.y - drag.from.y];
  if (typeof deed.x === "number" && typeof deed.y === "number")
    return [replace(`${path}.x`, rounded(deed.x + dx)), replace(`${path}.y`, rounded(deed.y + dy))];
  if (Array.isArray(deed.line)) return [replace(`${path}.line`, shiftedLine(state, deed, deed.line, drag))];
  return shiftedStretch(state, path, deed, drag, lanes);
}

/** Corners on the map are shifted as they are; those along a route by as much along it and beside it. */
function shiftedLine(state: Editing, deed: Tree, line: Json[], { from, to }: Drag): Json {
  const way = typeof deed.route === "string" ? lineOf(state, deed.route) : undefined;
  const [was, is] = way ? [foot(way, from), foot(way, to)] : [];
  if (was && is) return translated(line, is.along - was.along, is.left - was.left);
  return translated(line, to.x - from.x, to.y - from.y);
}

const translated = (line: readonly Json[], dx: number, dy: number): Json =>
  line.map((corner) => (Array.isArray(corner) ? [rounded(numberOf(corner[0]) + dx), rounded(numberOf(corner[1]) + dy)] : corner));

function shiftedStretch(state: Editing, path: string, part: Tree, { from, to }: Drag, lanes: readonly Lane[]): Operation[] {
  const line = stretchLine(state, part, lanes);
  if (!line || typeof part.start !== "number" || typeof part.end !== "number") return [];
  const by = (foot(line, to)?.along ?? 0) - (foot(line, from)?.along ?? 0);
  const start = Math.max(0, part.start + by);
  return [replace(`${path}.end`, rounded(part.end + start - part.start)), replace(`${path}.start`, rounded(start))];
}

/** The line that the stations of a stretch count along. */
function stretchLine(state: Editing, part: Tree, lanes: readonly Lane[]): readonly [number, number][] | undefined {
  if (typeof part.route === "string") return lineOf(state, part.route);
  return lanes.find(({ road, index }) => road === part.road && index === numberOf(part.lane))?.centre as [number, number][] | undefined;
}

/** The line of a route. */
export const lineOf = ({ items }: Editing, route: string): [number, number][] | undefined =>
  items.find(({ path }) => path === `routes.${route}`)?.figures[0]?.line;

// -- turned --------------------------------------------------------------------------------------

/** The path of the heading that can be turned by hand; nothing of what has none. */
export function headingPath(state: Editing, item: Item): string | undefined {
  if (item.group === "station") return `${item.path}.heading`;
  if (item.group === "object" && typeof at(state.document, `${item.path}.do.heading`) === "number") return `${item.path}.do.heading`;
  return undefined;
}

/** An item that looks in another direction [rad]; somebody on foot has the whole of his line turned about its beginning. */
export function turnedTo(state: Editing, item: Item, heading: number): Deed | undefined {
  const path = headingPath(state, item);
  const name = `Turn ${named([item.path])}`;
  if (path) return { name, set: { [path]: rounded(heading, 3) } };
  const deed = at(state.document, `${item.path}.do`);
  if (!isTree(deed) || !Array.isArray(deed.line) || deed.line.length < 2 || typeof deed.route === "string") return undefined;
  return { name, patch: [replace(`${item.path}.do.line`, turnedLine(deed.line, heading - (item.figures[0]?.heading ?? 0)))] };
}

function turnedLine(line: readonly Json[], by: number): Json {
  const [c, s] = [Math.cos(by), Math.sin(by)];
  const [x0, y0] = (line[0] as [number, number] | undefined) ?? [0, 0];
  return line.map((corner) => {
    const [x, y] = corner as [number, number];
    return [rounded(x0 + c * (x - x0) - s * (y - y0)), rounded(y0 + s * (x - x0) + c * (y - y0))];
  });
}

/** Whether an item has a handle to turn it by. */
export const isTurnable = (state: Editing, item: Item): boolean => turnedTo(state, item, item.figures[0]?.heading ?? 0) !== undefined;

// -- placed --------------------------------------------------------------------------------------

export const SHAPES = ["cuboid", "cylinder", "cone", "barrier", "wall", "tree"] as const;
export type Shape = (typeof SHAPES)[number];
export type Addition = "vehicle" | "pedestrian" | "cyclist" | "friction" | "station" | "radio" | Shape;

const COLOURS = ["#d55e00", "#0072b2", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#3a3a3a"];
const namesIn = (state: Editing, part: string): string[] => Object.keys((at(state.given, part) as Tree | undefined) ?? {});

/** What a click with a tool puts there; nothing where it cannot be. Lengths of new things are estimates, to be changed in their form. */
export function placed(state: Editing, what: Exclude<Addition, "vehicle">, point: Point, lanes: readonly Lane[]): { deed: Deed; path: string } | undefined {
  const lane = onLane(lanes, point);
  const [x, y] = [rounded(point.x), rounded(point.y)];
  if (what === "station") {
    const name = freshName("unit", [...namesIn(state, "stations"), ...namesIn(state, "vehicles")]);
    return fresh(state, "stations", name, { position: { x, y } });
  }
  if (what === "friction") {
    if (!lane) return undefined;
    const start = Math.max(0, lane.foot.along - 10);
    const deed = { kind: "friction", road: lane.road, lane: lane.lane, start: rounded(start), end: rounded(start + 20), friction: 0.3 };
    return entry(state, "patch", { do: deed });
  }
  if (what === "radio") return entry(state, "jam", { do: { kind: "jam", area: { x, y, radius: 50 } } });
  if (what === "pedestrian" || what === "cyclist") {
    const across = (lane?.foot.heading ?? 0) + (what === "pedestrian" ? Math.PI / 2 : 0);
    const far = what === "pedestrian" ? 12 : 60;
    const end = [rounded(point.x + far * Math.cos(across)), rounded(point.y + far * Math.sin(across))];
    const speed = what === "pedestrian" ? 1.39 : 4.17;
    return entry(state, what, { do: { kind: "mover", who: what, line: [[x, y], end], speed } });
  }
  return entry(state, what, { do: { kind: "object", shape: what, x, y, heading: rounded(lane?.foot.heading ?? 0, 3) } });
}

/** An area by its corners: an event that notes who comes in. */
export function area(state: Editing, corners: readonly Point[]): { deed: Deed; path: string } {
  const [vehicle = ""] = namesIn(state, "vehicles");
  const found = { kind: "in_area", vehicle, area: { corners: corners.map(({ x, y }) => [rounded(x), rounded(y)]) } };
  const { deed, path } = entry(state, "area", { when: found, do: { kind: "mark", text: `${vehicle} is in the area` } });
  return { deed, path: `${path}.when.area` };
}

/** A new entry of the script, called after what it is. */
export const entry = (state: Editing, base: string, value: Tree) =>
  fresh(state, "script", freshName(base, [...namesIn(state, "script"), ...namesIn(state, "vehicles")]), value);

/** A new thing in a part of the document, which need not be there yet. */
function fresh(state: Editing, part: string, name: string, value: Tree): { deed: Deed; path: string } {
  const patch = isTree(at(state.given, part)) ? [add(`${part}.${name}`, value)] : [add(part, { [name]: value })];
  return { deed: { name: `Add ${name}`, patch }, path: `${part}.${name}` };
}

/** A vehicle on a way that the server has found from there on. */
export function vehicleOn(state: Editing, way: readonly string[], place: { road: string; lane: number; offset: number }, speed: number) {
  const name = freshName("car", [...namesIn(state, "vehicles"), ...namesIn(state, "script"), ...namesIn(state, "stations")]);
  const { route, patch } = routeFor(state, way, place.road);
  const colour = COLOURS[namesIn(state, "vehicles").length % COLOURS.length] as string;
  const vehicle = { route, position: { ...place, offset: rounded(place.offset) }, speed: rounded(speed, 1), colour };
  return { deed: { name: `Add ${name}`, patch: [...patch, add(`vehicles.${name}`, vehicle)] }, path: `vehicles.${name}` };
}

/** A vehicle that was put onto a road off its way gets a way of its own from there. */
export function rerouted(state: Editing, item: Item, way: readonly string[], place: { road: string; lane: number; offset: number }): Deed {
  const { route, patch } = routeFor(state, way, place.road);
  const position = { ...place, offset: rounded(place.offset) };
  return { name: `Move ${item.name} to another road`, patch: [...patch, replace(`${item.path}.route`, route), replace(`${item.path}.position`, position)] };
}

/** The vehicles that drive a route. */
export function usersOf(state: Editing, route: string): string[] {
  const vehicles = (at(state.document, "vehicles") as Tree | undefined) ?? {};
  return Object.entries(vehicles).flatMap(([name, each]) => (isTree(each) && each.route === route ? [name] : []));
}

/** A route that names a road already, or a new one. */
function routeFor(state: Editing, way: readonly string[], road: string): { route: string; patch: Operation[] } {
  const known = (at(state.given, "routes") as Tree | undefined) ?? {};
  const found = Object.entries(known).find(([, each]) => isTree(each) && Array.isArray(each.roads) && each.roads.includes(road));
  if (found) return { route: found[0], patch: [] };
  const route = freshName("way", Object.keys(known));
  return { route, patch: [add(`routes.${route}`, { roads: [...way] })] };
}

// -- copied --------------------------------------------------------------------------------------

/** A piece of a scenario, as it stands in the file. */
export interface Copied {
  part: string;
  name: string;
  value: Tree;
}

/** What of the chosen can be copied: whole vehicles, stations, routes and entries of the script. */
export function copied(state: Editing, chosen: readonly string[]): Copied[] {
  return [...new Set(chosen.map(owner))].flatMap((path) => {
    const [part = "", name = ""] = path.split(".");
    const value = at(state.given, path);
    return isTree(value) ? [{ part, name, value }] : [];
  });
}

/** Copies a little farther on, so that they do not stand in each other. */
export function pasted(state: Editing, pieces: readonly Copied[]): { deed: Deed; paths: string[] } | undefined {
  const [patch, paths, taken]: [Operation[], string[], string[]] = [[], [], [...namesIn(state, "vehicles"), ...namesIn(state, "script"), ...namesIn(state, "stations"), ...namesIn(state, "routes")]];
  const made = new Set<string>();
  for (const { part, name, value } of pieces) {
    const called = freshName(name, taken);
    taken.push(called);
    const body = aside(state, part, value, paths.length + 1);
    if (isTree(at(state.given, part)) || made.has(part)) patch.push(add(`${part}.${called}`, body));
    else patch.push(add(part, { [called]: body }));
    made.add(part);
    paths.push(`${part}.${called}`);
  }
  return patch.length ? { deed: { name: `Copy ${named(pieces.map((each) => `${each.part}.${each.name}`))}`, patch }, paths } : undefined;
}

/** How far a copy lies from what it is of [m]: a car behind a car, anything else beside it. */
const BEHIND = 12;
const BESIDE = 3;

function aside(state: Editing, part: string, value: Tree, count: number): Tree {
  if (part === "vehicles" && isTree(value.position)) return { ...value, position: back(state, value, value.position, count) };
  if (part === "stations" && isTree(value.position)) {
    const { x, y } = value.position;
    return typeof x === "number" && typeof y === "number" ? { ...value, position: { x: x + BESIDE, y: y - BESIDE } } : value;
  }
  if (part !== "script" || !isTree(value.do)) return value;
  const deed = value.do;
  if (typeof deed.x === "number" && typeof deed.y === "number") return { ...value, do: { ...deed, x: rounded(deed.x + BESIDE), y: rounded(deed.y - BESIDE) } };
  if (Array.isArray(deed.line)) return { ...value, do: { ...deed, line: translated(deed.line, BESIDE, typeof deed.route === "string" ? 0 : -BESIDE) } };
  return value;
}

/** Behind the last car that shares the road, so that none is stood in. */
function back(state: Editing, value: Tree, position: Tree, count: number): Tree {
  const key = typeof position.along === "number" ? "along" : "offset";
  const others = Object.values((at(state.given, "vehicles") as Tree | undefined) ?? {}).filter(
    (each): each is Tree => isTree(each) && each.route === value.route && isTree(each.position) && key in each.position,
  );
  const taken = others.map(({ position: place }) => numberOf((place as Tree)[key]));
  const least = Math.min(numberOf(position[key]), ...taken) - BEHIND * count;
  const most = Math.max(numberOf(position[key]), ...taken) + BEHIND * count;
  return { ...position, [key]: rounded(least >= 5 ? least : most) };
}

/** How a way of an item goes on: of a nudge the shift in metres, on the ground. */
export function nudged(state: Editing, chosen: readonly Item[], dx: number, dy: number, lanes: readonly Lane[]): Deed | undefined {
  const patch = chosen.flatMap((item) => {
    const figure = item.figures[0];
    if (item.group !== "vehicle" || !figure) return shifted(state, item, { from: start(item), to: { x: start(item).x + dx, y: start(item).y + dy } }, lanes);
    const along = dx * Math.cos(figure.heading ?? 0) + dy * Math.sin(figure.heading ?? 0);
    const position = positionOf(item, { is: "along", station: (item.station ?? 0) + along });
    return position ? [replace(`${item.path}.position`, position)] : [];
  });
  return patch.length ? { name: `Move ${named(chosen.map(({ path }) => path))}`, patch } : undefined;
}

/** Where an item is taken hold of when nobody takes hold of it. */
function start({ figures }: Item): Point {
  const [x = 0, y = 0] = figures[0]?.anchor ?? figures[0]?.line?.[0] ?? [];
  return { x, y };
}

/** Where a vehicle would be after a drag: on its way, if that is near. */
export function ghostOf(state: Editing, item: Item, { from, to }: Drag, lanes: readonly Lane[]): Point & { heading: number } {
  const figure = item.figures[0];
  const [x, y] = [(figure?.x ?? 0) + to.x - from.x, (figure?.y ?? 0) + to.y - from.y];
  const anchor = figure?.anchor;
  if (item.group !== "vehicle" || !figure || !anchor) return { x, y, heading: figure?.heading ?? 0 };
  const target = { x: anchor[0] + to.x - from.x, y: anchor[1] + to.y - from.y };
  const place = whereabouts(state, item, target, lanes);
  const on = place.is === "along" ? pointAt(figure.line ?? [], place.station) : onLane(lanes, target)?.foot;
  if (!on) return { x, y, heading: figure.heading ?? 0 };
  const ahead = Math.hypot((figure.x ?? 0) - anchor[0], (figure.y ?? 0) - anchor[1]) * Math.sign(((figure.x ?? 0) - anchor[0]) * Math.cos(figure.heading ?? 0) + ((figure.y ?? 0) - anchor[1]) * Math.sin(figure.heading ?? 0));
  return { x: on.x + ahead * Math.cos(on.heading), y: on.y + ahead * Math.sin(on.heading), heading: on.heading };
}

/** The name that the next event gets. */
export const eventName = (state: Editing): string => freshName("event", [...namesIn(state, "script"), ...namesIn(state, "vehicles")]);

/** An event that notes a moment, to be made what one wants of it. */
export const newEvent = (state: Editing, name: string): Deed =>
  fresh(state, "script", name, { when: { kind: "time", at: Math.min(10, state.duration / 2) }, do: { kind: "mark", text: "" } }).deed;

/** A vehicle with a way of its own, which begins with the road that it stands on. */
export function ownWay(state: Editing, item: Item): { deed: Deed; route: string } {
  const route = freshName(`${item.name.slice(0, 30)}_way`, namesIn(state, "routes"));
  const position = { road: item.road ?? "", lane: item.lane ?? 0, offset: rounded(item.offset ?? 0) };
  const patch = [add(`routes.${route}`, { roads: [position.road] }), replace(`${item.path}.route`, route), replace(`${item.path}.position`, position)];
  return { deed: { name: `New route of ${item.name}`, patch }, route };
}
