/** What can be taken hold of, and what is drawn while it is held: alike on the plan and in the 3D scene. */

import { type Addition, type Drag, ghostOf, isTurnable } from "../../model/editing/deed";
import { placeOf } from "../../model/editing/hit";
import type { Editing, Handle, Item } from "../../model/editing/item";
import { type Knob, knobsOf, preview } from "../../model/editing/shape";
import { type Lane, onLane } from "../../model/editing/snap";
import type { Point } from "../../model/view";
import type { Ghost, Picture } from "./Board";

/** What a click on the plan does. */
export type Tool =
  | { is: "select" }
  | { is: "add"; what: Addition }
  | { is: "area"; corners: Point[] }
  | { is: "walls"; corners: Point[] }
  | { is: "measure"; points: Point[] }
  | { is: "route"; route: string };

export type Grip = { is: "turn"; item: Item } | { is: "knob"; item: Item; knob: Knob } | { is: "handle"; handle: number };

export interface Held {
  grip: Grip;
  point: Point;
}

/** What can be taken hold of besides the things themselves; the handle to turn something by lies an arm [m] before its middle, by its length [m]. */
export function gripsOf(state: Editing, mine: readonly Item[], locked: readonly string[], tool: Tool, arm: (length: number) => number): Held[] {
  if (tool.is === "route") {
    const handles: Handle[] = state.items.find(({ path }) => path === `routes.${tool.route}`)?.figures[0]?.handles ?? [];
    return handles.map(({ x, y }, handle) => ({ grip: { is: "handle", handle }, point: { x, y } }));
  }
  const [item] = mine;
  if (!item || mine.length !== 1 || locked.includes(item.path) || tool.is !== "select") return [];
  const knobs = knobsOf(state, item).map((knob): Held => ({ grip: { is: "knob", item, knob }, point: { x: knob.x, y: knob.y } }));
  const middle = placeOf(item);
  if (!middle || !isTurnable(state, item)) return knobs;
  const { heading = 0, length = 0 } = item.figures[0] ?? {};
  const far = arm(length);
  return [...knobs, { grip: { is: "turn", item }, point: { x: middle.x + far * Math.cos(heading), y: middle.y + far * Math.sin(heading) } }];
}

/** Of what can be taken hold of the nearest within reach; the first of those that are as near. */
export function nearest(grips: readonly Held[], away: (point: Point) => number, reach: number): Held | undefined {
  const near = grips.map((held) => ({ held, by: away(held.point) })).filter(({ by }) => by <= reach);
  return near.sort((one, other) => one.by - other.by)[0]?.held;
}

/** Who does what a grip is for. */
export interface Doer {
  onTurn: (item: Item, heading: number) => void;
  /** A point of a shape is where it is dragged to. */
  onPull: (item: Item, knob: Knob, to: Point) => void;
  onHandle: (handle: number, to: Point | undefined) => void;
}

/** A grip is let go of somewhere, moved or not. */
export function letGo(grip: Grip, moved: boolean, on: Point, { onTurn, onPull, onHandle }: Doer): void {
  if (grip.is === "handle") return onHandle(grip.handle, moved ? on : undefined);
  if (!moved) return;
  if (grip.is === "knob") return onPull(grip.item, grip.knob, on);
  const middle = placeOf(grip.item);
  if (middle) onTurn(grip.item, Math.atan2(on.y - middle.y, on.x - middle.x));
}

/** Things that are dragged, where they would be. */
export function draggedThings(state: Editing, held: readonly Item[], drag: Drag, lanes: readonly Lane[]): Pick<Picture, "ghosts" | "outlines"> {
  const [dx, dy] = [drag.to.x - drag.from.x, drag.to.y - drag.from.y];
  const ghosts: Ghost[] = held.flatMap((item) =>
    item.figures.filter(({ shape }) => shape === "body" || shape === "point").map(({ length = 0, width = 0 }) => ({ ...ghostOf(state, item, drag, lanes), length: length || 2, width: width || 2 })),
  );
  const outlines = held.flatMap(({ figures }) =>
    figures.filter(({ shape }) => shape === "area" || shape === "patch").map(({ line = [] }) => line.map(([x, y]) => [x + dx, y + dy] as [number, number])),
  );
  return { ghosts, outlines };
}

/** What the thing would be whose grip is somewhere else. */
export function grippedThing(grip: Grip, to: Point, state: Editing): Partial<Picture> {
  if (grip.is === "handle") return { ghosts: [{ ...to, heading: 0, length: 1.5, width: 1.5 }] };
  if (grip.is === "knob") {
    const found = preview(state, grip.item, grip.knob, to);
    return found?.closed ? { outlines: [found.corners] } : { lines: found ? [found.corners] : [] };
  }
  const [figure, middle] = [grip.item.figures[0], placeOf(grip.item)];
  if (!figure || !middle) return {};
  const heading = Math.atan2(to.y - middle.y, to.x - middle.x);
  return { ghosts: [{ ...middle, heading, length: figure.length || 2, width: figure.width || 2 }], lines: [[[middle.x, middle.y], [to.x, to.y]]] };
}

/** About how large what is added will be [m]. */
const EXTENT: Partial<Record<Addition, [number, number]>> = { vehicle: [4.6, 1.8], friction: [20, 3.5], wall: [4, 0.3], barrier: [1.5, 0.3], radio: [100, 100], cyclist: [1.9, 0.6] };

/** What a click with a tool would put there. */
export function ghostFor(what: Addition, ground: Point, lanes: readonly Lane[]): Ghost {
  const foot = onLane(lanes, ground)?.foot;
  const snapped = what === "vehicle" || what === "friction";
  const [length, width] = EXTENT[what] ?? [1, 1];
  return { ...(snapped && foot ? foot : ground), heading: foot?.heading ?? 0, length, width };
}
