/**
 * A plan as pictures of one kind each, drawn from the ground up.
 *
 *     batch    one path for everything of one kind in a square of the ground; what is not seen is not drawn
 *     layer    the batches of one kind, with how they are painted
 */

import type { DriveSide, Line, Outline, Plan, PlanLane, PlanSignal } from "../model/map";
import { boundsOf } from "../model/picking";
import { type Bounds, meet, type Size, seen, type View } from "../model/view";

interface Batch {
  bounds: Bounds;
  path: Path2D;
}

type Colour = keyof (typeof COLOURS)["light"];

interface Layer {
  batches: Batch[];
  colour: Colour;
  /** Width of the stroke [m]; without one the layer is filled. */
  width?: number;
  /** Width of the stroke [px], when it is the same at every scale. */
  thin?: number;
  /** The scale from which on the layer is drawn [px/m]. */
  from?: number;
}

/** Everything that is drawn below the marks. */
export interface Ground {
  bounds: Bounds;
  /** Where there are roads or buildings; the part that was asked for may be much larger. */
  extent: Bounds;
  layers: Layer[];
}

const COLOURS = {
  light: {
    outside: "#dfe3e8",
    ground: "#f4f4f0",
    green: "#cfe5c3",
    water: "#a9cfe6",
    parking: "#dcdcea",
    other: "#e6e2d8",
    building: "#cfc8bf",
    wall: "#a79f95",
    edge: "#ffffff",
    asphalt: "#868c95",
    closed: "#b08f8f",
    tunnel: "#c9cbc9",
    bore: "#7d8288",
    casing: "#3f454d",
    marking: "#ffffff",
    arrow: "#e9ecef",
    stop: "#ffffff",
    signal: "#c2255c",
  },
  dark: {
    outside: "#151719",
    ground: "#1f2225",
    green: "#24382a",
    water: "#1c3a52",
    parking: "#2b2d3c",
    other: "#2a2a27",
    building: "#3b3a3f",
    wall: "#5a585f",
    edge: "#14161a",
    asphalt: "#6b7280",
    closed: "#7d5a5a",
    tunnel: "#33383d",
    bore: "#868e96",
    casing: "#dee2e6",
    marking: "#dee2e6",
    arrow: "#ced4da",
    stop: "#ffffff",
    signal: "#ff6b9d",
  },
};

/** Side of the squares that batches are made for [m]. */
const SQUARE = 250;

/** The layers of a plan, which are made once and drawn often. */
export function groundOf(plan: Plan): Ground {
  const lanes = plan.lanes.filter(({ centre }) => centre.length > 1).flatMap(onLand);
  const aloft = plan.lanes.flatMap(offLand);
  const outside = lanes.filter(({ internal }) => !internal);
  const junctions = batched(plan.junctions, boundsOf, addRing);
  const { between, middle } = markings(outside, plan.drive_side);
  const kinds = [...new Set(plan.areas.map(({ kind }) => kind))].sort();
  const layers: Layer[] = [
    ...kinds.map((kind) => ({
      colour: colourOf(kind),
      batches: batched(plan.areas.filter((area) => area.kind === kind), outlineBounds, addOutline),
    })),
    { colour: "building", batches: batched(plan.buildings, outlineBounds, addOutline) },
    { colour: "wall", thin: 1, from: 0.4, batches: batched(plan.buildings, outlineBounds, addOutline) },
    ...tunnels(aloft.filter(({ lift }) => lift < 0)),
    ...stripes(outside, "edge", 0.8),
    ...stripes(lanes.filter(({ open }) => open), "asphalt", 0),
    { colour: "asphalt", batches: junctions },
    // Over the seam between a junction and its lanes.
    { colour: "asphalt", width: 0.5, batches: junctions },
    ...stripes(outside.filter(({ open }) => !open), "closed", 0),
    { colour: "marking", width: 0.15, from: 2.2, batches: batched(between, boundsOf, addDashes) },
    { colour: "marking", width: 0.15, from: 2.2, batches: batched(middle, boundsOf, addLine) },
    { colour: "arrow", from: 1.6, batches: batched(outside.flatMap(directions), boundsOf, addRing) },
    { colour: "stop", width: 0.5, from: 0.8, batches: batched(stopLines(plan), boundsOf, addLine) },
    ...bridges(aloft.filter(({ lift }) => lift > 0), plan.drive_side),
    { colour: "signal", from: 0.8, batches: batched(plan.signals.map(lamp), boundsOf, addRing) },
  ];
  return {
    bounds: plan.bounds_m,
    extent: extentOf(plan),
    layers: layers.filter(({ batches }) => batches.length > 0),
  };
}

function extentOf({ lanes, buildings, bounds_m }: Plan): Bounds {
  const parts = [...lanes.map(({ centre }) => boundsOf(centre)), ...buildings.map(outlineBounds)];
  return parts.length > 0 ? parts.reduce(joined) : bounds_m;
}

const colourOf = (kind: string): Colour => (kind === "green" || kind === "water" || kind === "parking" ? kind : "other");

/** Lanes of equal width are one layer. */
function stripes(lanes: readonly PlanLane[], colour: Colour, more: number): Layer[] {
  const widths = [...new Set(lanes.map(({ width }) => rounded(width)))].sort();
  return widths.map((width) => ({
    colour,
    width: width + more,
    batches: batched(lanes.filter((lane) => rounded(lane.width) === width), ({ centre }) => boundsOf(centre), (path, { centre }) => addLine(path, centre)),
  }));
}

const rounded = (width: number): number => Math.round(width * 4) / 4;

// -- levels --------------------------------------------------------------------------------------

/** A part of a lane that lies above the land, or below it [m]. */
export interface Stretch extends PlanLane {
  lift: number;
}

/** The parts of a lane on the land, as lanes. */
export const onLand = (lane: PlanLane): PlanLane[] =>
  lane.land ? lane.land.filter((centre) => centre.length > 1).map((centre) => ({ ...lane, centre })) : [lane];

/** The parts of a lane that lie off the land, as lanes. */
export const offLand = (lane: PlanLane): Stretch[] =>
  (lane.aloft ?? []).filter(({ centre }) => centre.length > 1).map(({ lift, centre }) => ({ ...lane, centre, lift }));

/** Below everything else: pale, between broken lines. */
function tunnels(lanes: readonly Stretch[]): Layer[] {
  const sides = lanes.flatMap(({ centre, width }) => [beside(centre, width / 2), beside(centre, -width / 2)]);
  return [...stripes(lanes, "tunnel", 0), { colour: "bore", width: 0.4, batches: batched(sides, boundsOf, addDashes) }];
}

/** Storey after storey, each over those below it: between dark lines. */
function bridges(lanes: readonly Stretch[], side: DriveSide): Layer[] {
  const storeys = [...new Set(lanes.map(storeyOf))].sort((one, other) => one - other);
  return storeys.flatMap((storey) => {
    const own = lanes.filter((lane) => storeyOf(lane) === storey);
    const outside = own.filter(({ internal }) => !internal);
    const { between, middle } = markings(outside, side);
    return [
      ...stripes(own, "casing", 1.4),
      ...stripes(own.filter(({ open }) => open), "asphalt", 0.2),
      ...stripes(own.filter(({ open }) => !open), "closed", 0),
      { colour: "marking" as const, width: 0.15, from: 2.2, batches: batched(between, boundsOf, addDashes) },
      { colour: "marking" as const, width: 0.15, from: 2.2, batches: batched(middle, boundsOf, addLine) },
      { colour: "arrow" as const, from: 1.6, batches: batched(outside.flatMap(directions), boundsOf, addRing) },
    ];
  });
}

const STOREY = 4; // [m]
/** On which storey a part of a lane is drawn. */
export const storeyOf = ({ lift }: Stretch): number => Math.round(lift / STOREY);

// -- batches -------------------------------------------------------------------------------------

/** One path for each square of the ground in which something lies. */
function batched<Kind>(all: readonly Kind[], bounds: (one: Kind) => Bounds, add: (path: Path2D, one: Kind) => void): Batch[] {
  const squares = new Map<string, Batch>();
  for (const one of all) {
    const own = bounds(one);
    const key = `${Math.floor((own[0] + own[2]) / 2 / SQUARE)} ${Math.floor((own[1] + own[3]) / 2 / SQUARE)}`;
    const square = squares.get(key) ?? { bounds: own, path: new Path2D() };
    square.bounds = joined(square.bounds, own);
    add(square.path, one);
    squares.set(key, square);
  }
  return [...squares.values()];
}

const joined = (one: Bounds, other: Bounds): Bounds => [
  Math.min(one[0], other[0]),
  Math.min(one[1], other[1]),
  Math.max(one[2], other[2]),
  Math.max(one[3], other[3]),
];

const outlineBounds = ({ outline }: Outline): Bounds => boundsOf(outline);

function addLine(path: Path2D, line: Line): void {
  line.forEach(([x, y], at) => (at === 0 ? path.moveTo(x, y) : path.lineTo(x, y)));
}

function addRing(path: Path2D, ring: Line): void {
  addLine(path, turning(ring, 1));
  path.closePath();
}

/** Holes turn the other way round, so that shapes may lie on one another in one path. */
function addOutline(path: Path2D, { outline, holes }: Outline): void {
  addRing(path, outline);
  for (const hole of holes) {
    addLine(path, turning(hole, -1));
    path.closePath();
  }
}

/** The ring counter-clockwise (1) or clockwise (-1). */
function turning(ring: Line, sense: 1 | -1): Line {
  const area = ring.reduce((sum, [x, y], at) => {
    const [nextX, nextY] = ring[(at + 1) % ring.length] as [number, number];
    return sum + x * nextY - nextX * y;
  }, 0);
  return area * sense < 0 ? [...ring].reverse() : ring;
}

const DASH = { line: 3, gap: 4.5 }; // [m]

/** Dashes as lines of their own: a dash pattern would be computed anew for every picture. */
function addDashes(path: Path2D, line: Line): void {
  for (const dash of dashes(line)) addLine(path, dash);
}

/** The dashes along a line. */
export function dashes(line: Line): Line[] {
  const found: Line[] = [];
  let along = 0;
  for (let at = 0; at + 1 < line.length; at += 1) {
    const [[ax, ay], [bx, by]] = [line[at] as [number, number], line[at + 1] as [number, number]];
    const length = Math.hypot(bx - ax, by - ay);
    const period = DASH.line + DASH.gap;
    for (let start = Math.floor(along / period) * period; start < along + length; start += period) {
      const [from, to] = [Math.max(0, start - along), Math.min(length, start + DASH.line - along)];
      if (to <= from) continue;
      const [u, v] = [from / length, to / length];
      found.push([
        [ax + (bx - ax) * u, ay + (by - ay) * u],
        [ax + (bx - ax) * v, ay + (by - ay) * v],
      ]);
    }
    along += length;
  }
  return found;
}

// -- what is on a lane ---------------------------------------------------------------------------

/** The edges of lanes towards the middle of the road: between lanes of one road, and beside the innermost ones. */
export function markings(lanes: readonly PlanLane[], side: DriveSide): { between: Line[]; middle: Line[] } {
  const last = new Map<string, number>();
  for (const { road, index } of lanes) last.set(road, Math.max(last.get(road) ?? 0, index));
  const towardsMiddle = side === "right" ? 1 : -1;
  const edge = ({ centre, width }: PlanLane) => beside(centre, (towardsMiddle * width) / 2);
  const isInnermost = ({ road, index }: PlanLane) => index === last.get(road);
  return {
    between: lanes.filter((lane) => !isInnermost(lane)).map(edge),
    middle: lanes.filter(isInnermost).map(edge),
  };
}

/** The line shifted to its left [m]. */
export function beside(line: Line, left: number): Line {
  return line.map(([x, y], at) => {
    const [ax, ay] = line[Math.max(0, at - 1)] as [number, number];
    const [bx, by] = line[Math.min(line.length - 1, at + 1)] as [number, number];
    const length = Math.hypot(bx - ax, by - ay) || 1;
    return [x - ((by - ay) / length) * left, y + ((bx - ax) / length) * left];
  });
}

const EVERY = 40; // [m] between arrows along a lane

/** Small arrow heads that tell which way a lane is driven. */
export function directions({ centre }: PlanLane): Line[] {
  const heads: Line[] = [];
  const total = centre.slice(1).reduce((sum, [x, y], at) => sum + Math.hypot(x - (centre[at]?.[0] ?? x), y - (centre[at]?.[1] ?? y)), 0);
  if (total < 8) return heads;
  const count = Math.max(1, Math.floor(total / EVERY));
  let [along, next] = [0, total / count / 2];
  for (let at = 0; at + 1 < centre.length; at += 1) {
    const [[ax, ay], [bx, by]] = [centre[at] as [number, number], centre[at + 1] as [number, number]];
    const length = Math.hypot(bx - ax, by - ay);
    for (; length > 0 && next <= along + length; next += total / count) {
      const share = (next - along) / length;
      heads.push(head(ax + (bx - ax) * share, ay + (by - ay) * share, (bx - ax) / length, (by - ay) / length));
    }
    along += length;
  }
  return heads;
}

/** An arrow head of 2.4 m by 1.2 m that points along (c, s). */
const head = (x: number, y: number, c: number, s: number): Line =>
  (
    [
      [1.2, 0],
      [-1.2, 0.6],
      [-0.7, 0],
      [-1.2, -0.6],
    ] as const
  ).map(([u, v]) => [x + c * u - s * v, y + s * u + c * v]);

/** Across each signalled lane. */
function stopLines({ signals, lanes }: Plan): Line[] {
  const widths = new Map(lanes.map(({ id, width }) => [id, width]));
  return signals.map(({ x, y, heading, lane }) => {
    const half = (widths.get(lane) ?? 3) / 2;
    const [c, s] = [Math.cos(heading) * half, Math.sin(heading) * half];
    return [
      [x - s, y + c],
      [x + s, y - c],
    ];
  });
}

/** A disc at the stop line, of 1 m radius. */
const lamp = ({ x, y }: PlanSignal): Line =>
  Array.from({ length: 12 }, (_, at) => [x + Math.cos((at * Math.PI) / 6), y + Math.sin((at * Math.PI) / 6)]);

// -- painting ------------------------------------------------------------------------------------

type Context = CanvasRenderingContext2D | OffscreenCanvasRenderingContext2D;

/** The context takes metres of the ground from now on. */
export function toMetres(context: Context, { x, y, scale }: View, { width, height }: Size, ratio: number): void {
  const pixels = scale * ratio;
  context.setTransform(pixels, 0, 0, -pixels, (width / 2) * ratio - x * pixels, (height / 2) * ratio + y * pixels);
}

/** Draw what is seen of the ground; `ratio` is device pixels per pixel. */
export function paint(context: Context, { bounds, layers }: Ground, view: View, size: Size, ratio: number, dark: boolean): void {
  const colours = dark ? COLOURS.dark : COLOURS.light;
  context.setTransform(1, 0, 0, 1, 0, 0);
  context.fillStyle = colours.outside;
  context.fillRect(0, 0, size.width * ratio, size.height * ratio);
  toMetres(context, view, size, ratio);
  context.fillStyle = colours.ground;
  context.fillRect(bounds[0], bounds[1], bounds[2] - bounds[0], bounds[3] - bounds[1]);
  context.lineJoin = "round";
  const part = seen(view, size, 8);
  for (const layer of layers) {
    if (view.scale < (layer.from ?? 0)) continue;
    const stroked = layer.width !== undefined || layer.thin !== undefined;
    context.fillStyle = colours[layer.colour];
    context.strokeStyle = colours[layer.colour];
    // A road stays visible, however small the picture.
    context.lineWidth = layer.thin !== undefined ? layer.thin / view.scale : Math.max(layer.width ?? 0, 1.2 / view.scale);
    for (const batch of layer.batches) {
      if (!meet(batch.bounds, part)) continue;
      if (stroked) context.stroke(batch.path);
      else context.fill(batch.path);
    }
  }
}

/** The colours of the ground by name. */
export const coloursOf = (dark: boolean) => (dark ? COLOURS.dark : COLOURS.light);

/** What lies around the map. */
export const outsideColour = (dark: boolean): string => (dark ? COLOURS.dark : COLOURS.light).outside;
