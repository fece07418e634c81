/**
 * The plan of the editor, drawn by deck.gl on the graphics card: the map, what is in the scenario, and what is being done.
 *
 * It only draws. What is under the pointer is found by the model, on the ground, so that it does not depend on pixels.
 */

import { Deck, type Layer, OrthographicView } from "@deck.gl/core";
import { PathLayer, ScatterplotLayer, SolidPolygonLayer } from "@deck.gl/layers";
import { beside, coloursOf, dashes, directions, markings, offLand, onLand, type Stretch, storeyOf } from "../../charts/ground";
import type { Figure, Item } from "../../model/editing/item";
import { corners, type Line } from "../../model/editing/line";
import type { DriveSide, Plan, PlanArea, PlanLane } from "../../model/map";
import type { Point, View } from "../../model/view";

/** A body that is not there yet, or no more where it was. */
export interface Ghost extends Point {
  heading: number;
  length: number;
  width: number;
}

/** What is drawn over the map. */
export interface Picture {
  plan: Plan;
  items: readonly Item[];
  chosen: readonly string[];
  hovered: string | undefined;
  /** By how much what is chosen is dragged [m]. */
  ghosts: readonly Ghost[];
  /** Outlines that a drag would give. */
  outlines: readonly Line[];
  /** Lines that are being made: a route, a tape, the corners of an area. */
  lines: readonly Line[];
  /** Points to take hold of. */
  handles: readonly Point[];
  /** Points to make a corner of. */
  middles: readonly Point[];
  dark: boolean;
}

/** What of deck.gl's loop is not told to the outside. */
interface Loop {
  _requestAnimationFrame?: () => void;
}

/** [ms] After something was told, in which deck.gl may still have something to draw. */
const AWAKE_MS = 1000;

type Colour = [number, number, number, number];

export class Board {
  private readonly deck: Deck<OrthographicView>;
  private readonly canvas: HTMLCanvasElement;
  /** When something was told last [ms]. */
  private told = 0;
  private wake = () => undefined as void;
  private ground: { of: Plan; dark: boolean; layers: Layer[] } | undefined;

  constructor(canvas: HTMLCanvasElement, size: { width: number; height: number }) {
    this.canvas = canvas;
    this.deck = new Deck<OrthographicView>({
      canvas,
      ...size,
      views: new OrthographicView({ id: "plan", flipY: false }),
      viewState: { target: [0, 0, 0], zoom: 0 },
      controller: false,
      layers: [],
      getCursor: () => "inherit",
      // Nothing is drawn while nothing changes.
      _animate: false,
      onLoad: () => this.rest(),
      onResize: () => this.wake(),
    });
  }

  /**
   * deck.gl asks at every frame whether there is something to draw; it rests until it is told something, a moment after the last time.
   *
   * It hears of its size later than we do, on a busy machine much later: until what it has drawn is as large as its place, it does not rest,
   * or the picture would stay stretched.
   */
  private rest(): void {
    const loop = (this.deck as unknown as { animationLoop?: Loop }).animationLoop;
    if (!loop?._requestAnimationFrame) return;
    const next = loop._requestAnimationFrame.bind(loop);
    let asleep = false;
    loop._requestAnimationFrame = () => {
      const fits = this.fits();
      asleep = fits && performance.now() > this.told + AWAKE_MS && !this.deck.needsRedraw({ clearRedrawFlags: false });
      if (!fits) this.deck.redraw("the place has another size");
      if (!asleep) next();
    };
    this.wake = () => {
      this.told = performance.now();
      if (asleep) next();
      asleep = false;
    };
    this.wake();
  }

  /** Whether the picture has as many pixels as its place; one that is not seen has. */
  private fits(): boolean {
    const { clientWidth, clientHeight, width, height } = this.canvas;
    const isNear = (pixels: number, css: number) => Math.abs(pixels - css * window.devicePixelRatio) <= 2;
    return clientWidth === 0 || clientHeight === 0 || (isNear(width, clientWidth) && isNear(height, clientHeight));
  }

  close(): void {
    this.deck.finalize();
  }

  resize(width: number, height: number): void {
    this.deck.setProps({ width, height });
    this.wake();
  }

  look({ x, y, scale }: View): void {
    this.deck.setProps({ viewState: { target: [x, y, 0], zoom: Math.log2(scale) } as never });
    this.wake();
  }

  show(picture: Picture): void {
    const { plan, dark } = picture;
    if (this.ground?.of !== plan || this.ground.dark !== dark) this.ground = { of: plan, dark, layers: groundLayers(plan, dark) };
    this.deck.setProps({ layers: [...this.ground.layers, ...thingLayers(picture)] });
    this.wake();
  }
}

// -- the map -------------------------------------------------------------------------------------

function groundLayers(plan: Plan, dark: boolean): Layer[] {
  const colours = coloursOf(dark);
  const [x0, y0, x1, y1] = plan.bounds_m;
  const lanes = plan.lanes.filter(({ centre }) => centre.length > 1).flatMap(onLand);
  const aloft = plan.lanes.flatMap(offLand);
  const outside = lanes.filter(({ internal }) => !internal);
  const { between, middle } = markings(outside, plan.drive_side);
  const colourOf = (kind: string) => colours[kind === "green" || kind === "water" || kind === "parking" ? kind : "other"];
  const ring: [number, number][] = [[x0, y0], [x1, y0], [x1, y1], [x0, y1]];
  return [
    polygons("ground", [{ outline: ring, holes: [] }], () => colours.ground),
    polygons<PlanArea>("areas", plan.areas, ({ kind }) => colourOf(kind)),
    polygons("buildings", plan.buildings, () => colours.building),
    ...tunnels(aloft.filter(({ lift }) => lift < 0), colours),
    stripes("edges", outside, colours.edge, 0.8),
    stripes("lanes", lanes.filter(({ open }) => open), colours.asphalt, 0),
    polygons("junctions", plan.junctions.map((outline) => ({ outline, holes: [] })), () => colours.asphalt),
    stripes("closed", outside.filter(({ open }) => !open), colours.closed, 0),
    thin("between", between, colours.marking, 0.12),
    thin("middle", middle, colours.marking, 0.18),
    arrows("arrows", outside, colours.arrow),
    ...bridges(aloft.filter(({ lift }) => lift > 0), plan.drive_side, colours),
    new ScatterplotLayer({ id: "signals", data: plan.signals, getPosition: ({ x, y }) => [x, y], getRadius: 0.9, radiusUnits: "common", getFillColor: rgba(colours.signal) }),
  ];
}

type Colours = ReturnType<typeof coloursOf>;

/** Below all other roads: pale, between broken lines. */
const tunnels = (lanes: Stretch[], colours: Colours): Layer[] => [
  stripes("tunnels", lanes, colours.tunnel, 0),
  thin("bores", lanes.flatMap(({ centre, width }) => [...dashes(beside(centre, width / 2)), ...dashes(beside(centre, -width / 2))]), colours.bore, 0.4),
];

/** Storey after storey, each over those below it: between dark lines. */
function bridges(lanes: Stretch[], side: DriveSide, colours: Colours): Layer[] {
  const storeys = [...new Set(lanes.map(storeyOf))].sort((one, other) => one - other);
  return storeys.flatMap((storey) => {
    const own = lanes.filter((lane) => storeyOf(lane) === storey);
    const outside = own.filter(({ internal }) => !internal);
    const { between, middle } = markings(outside, side);
    return [
      stripes(`casing ${storey}`, own, colours.casing, 1.4),
      stripes(`decks ${storey}`, own.filter(({ open }) => open), colours.asphalt, 0.2),
      stripes(`closed ${storey}`, own.filter(({ open }) => !open), colours.closed, 0),
      thin(`between ${storey}`, between, colours.marking, 0.12),
      thin(`middle ${storey}`, middle, colours.marking, 0.18),
      arrows(`arrows ${storey}`, outside, colours.arrow),
    ];
  });
}

const arrows = (id: string, lanes: PlanLane[], colour: string) =>
  polygons(id, lanes.flatMap(directions).map((outline) => ({ outline: outline as [number, number][], holes: [] })), () => colour);

const polygons = <Kind extends { outline: [number, number][]; holes: [number, number][][] }>(id: string, data: Kind[], colour: (one: Kind) => string) =>
  new SolidPolygonLayer<Kind>({
    id,
    data: data.filter(({ outline }) => outline.length > 2),
    getPolygon: ({ outline, holes }) => (holes.length ? [outline, ...holes] : outline) as never,
    getFillColor: (one) => rgba(colour(one)),
    extruded: false,
  });

const stripes = (id: string, data: PlanLane[], colour: string, more: number) =>
  new PathLayer<PlanLane>({
    id,
    data,
    getPath: ({ centre }) => centre,
    getWidth: ({ width }) => width + more,
    widthUnits: "common",
    widthMinPixels: 1.2,
    getColor: rgba(colour),
    jointRounded: true,
  });

const thin = (id: string, data: readonly Line[], colour: string, width: number) =>
  new PathLayer<Line>({ id, data: data as Line[], getPath: (line) => line as never, getWidth: width, widthUnits: "common", getColor: rgba(colour) });

// -- what is in the scenario ---------------------------------------------------------------------

const INK = {
  light: { chosen: "#0b5ed7", route: "#7048e8", friction: "#1098ad", area: "#2f9e44", radio: "#e8590c", object: "#a0522d", person: "#c2255c", station: "#5f3dc4", event: "#e67700", line: "#0b5ed7", rim: "#ffffff" },
  dark: { chosen: "#74c0fc", route: "#b197fc", friction: "#3bc9db", area: "#69db7c", radio: "#ffa94d", object: "#d9a066", person: "#faa2c1", station: "#b197fc", event: "#ffd43b", line: "#74c0fc", rim: "#101113" },
};

interface Drawn {
  item: Item;
  figure: Figure;
  colour: string;
  chosen: boolean;
  hovered: boolean;
}

function thingLayers({ items, chosen, hovered, ghosts, outlines, lines, handles, middles, dark }: Picture): Layer[] {
  const ink = dark ? INK.dark : INK.light;
  const colourOf = ({ group }: Item, figure: Figure) =>
    group === "vehicle" ? figure.colour || ink.chosen : (ink as Record<string, string>)[group] ?? ink.object;
  const all: Drawn[] = items.flatMap((item) =>
    item.figures.map((figure) => ({ item, figure, colour: colourOf(item, figure), chosen: chosen.includes(item.path), hovered: item.path === hovered })),
  );
  const bodies = all.filter(({ figure }) => figure.shape === "body");
  const surfaces = all.filter(({ figure }) => figure.shape === "patch" || figure.shape === "area");
  const ways = all.filter(({ figure, chosen: is }) => figure.shape === "line" || (is && (figure.line?.length ?? 0) > 1 && figure.shape === "body"));
  const points = all.filter(({ figure }) => figure.shape === "point");
  const lit = ({ chosen: is, hovered: near }: Drawn) => is || near;
  const outlineOf = ({ figure: { x = 0, y = 0, heading = 0, length = 0, width = 0 } }: Drawn) => corners(x, y, heading, length, width);
  return [
    new SolidPolygonLayer<Drawn>({ id: "surfaces", data: surfaces, getPolygon: ({ figure }) => figure.line as never, getFillColor: (one) => rgba(one.colour, lit(one) ? 130 : 70), extruded: false }),
    new PathLayer<Drawn>({ id: "surface rims", data: surfaces, getPath: ({ figure }) => closed(figure.line ?? []) as never, getWidth: (one) => (lit(one) ? 3 : 1.5), widthUnits: "pixels", getColor: (one) => rgba(one.chosen ? ink.chosen : one.colour) }),
    new PathLayer<Drawn>({ id: "ways", data: ways, getPath: ({ figure }) => figure.line as never, getWidth: (one) => (lit(one) ? 4 : 1.5), widthUnits: "pixels", getColor: (one) => rgba(one.item.group === "route" ? ink.route : one.colour, lit(one) ? 220 : 90), jointRounded: true, capRounded: true }),
    new SolidPolygonLayer<Drawn>({ id: "bodies", data: bodies, getPolygon: (one) => outlineOf(one) as never, getFillColor: ({ colour }) => rgba(colour), extruded: false }),
    new PathLayer<Drawn>({ id: "rims", data: bodies, getPath: (one) => closed(outlineOf(one)) as never, getWidth: (one) => (lit(one) ? 3 : 1), widthUnits: "pixels", getColor: (one) => rgba(lit(one) ? ink.chosen : ink.rim) }),
    // Something of every body is seen, however small the picture; the front of a car is told by a lighter nose.
    new ScatterplotLayer<Drawn>({ id: "dots", data: bodies, getPosition: ({ figure: { x = 0, y = 0 } }) => [x, y], getRadius: 0.2, radiusUnits: "common", radiusMinPixels: 4, getFillColor: ({ colour }) => rgba(colour), stroked: true, lineWidthUnits: "pixels", getLineWidth: (one) => (lit(one) ? 2 : 1), getLineColor: (one) => rgba(lit(one) ? ink.chosen : ink.rim) }),
    new PathLayer<Drawn>({ id: "noses", data: bodies.filter(({ item }) => item.group === "vehicle"), getPath: (one) => nose(one.figure) as never, getWidth: 0.35, widthUnits: "common", getColor: rgba(ink.rim, 220) }),
    new ScatterplotLayer<Drawn>({ id: "points", data: points, getPosition: ({ figure: { x = 0, y = 0 } }) => [x, y], getRadius: 1.2, radiusUnits: "common", radiusMinPixels: 6, getFillColor: ({ colour }) => rgba(colour), stroked: true, lineWidthUnits: "pixels", getLineWidth: (one) => (lit(one) ? 3 : 1.5), getLineColor: (one) => rgba(lit(one) ? ink.chosen : ink.rim) }),
    new SolidPolygonLayer<Ghost>({ id: "ghosts", data: ghosts as Ghost[], getPolygon: ({ x, y, heading, length, width }) => corners(x, y, heading, Math.max(length, 0.5), Math.max(width, 0.5)) as never, getFillColor: rgba(ink.chosen, 140), extruded: false }),
    new ScatterplotLayer<Ghost>({ id: "ghost dots", data: ghosts as Ghost[], getPosition: ({ x, y }) => [x, y], getRadius: 0.2, radiusUnits: "common", radiusMinPixels: 6, getFillColor: rgba(ink.chosen, 140) }),
    new PathLayer<Line>({ id: "ghost outlines", data: outlines as Line[], getPath: (line) => closed(line) as never, getWidth: 2, widthUnits: "pixels", getColor: rgba(ink.chosen, 200) }),
    new PathLayer<Line>({ id: "lines", data: lines as Line[], getPath: (line) => line as never, getWidth: 3, widthUnits: "pixels", getColor: rgba(ink.line, 230), jointRounded: true, capRounded: true }),
    new ScatterplotLayer<Point>({ id: "middles", data: middles as Point[], getPosition: ({ x, y }) => [x, y], getRadius: 4, radiusUnits: "pixels", getFillColor: rgba(ink.rim, 150), stroked: true, lineWidthUnits: "pixels", getLineWidth: 1.5, getLineColor: rgba(ink.chosen, 190) }),
    new ScatterplotLayer<Point>({ id: "handles", data: handles as Point[], getPosition: ({ x, y }) => [x, y], getRadius: 6, radiusUnits: "pixels", getFillColor: rgba(ink.rim), stroked: true, lineWidthUnits: "pixels", getLineWidth: 2.5, getLineColor: rgba(ink.chosen) }),
  ];
}

const closed = (line: Line): Line => [...line, ...line.slice(0, 1)];

/** A bar across the front of a body. */
function nose({ x = 0, y = 0, heading = 0, length = 0, width = 0 }: Figure): [number, number][] {
  const [c, s, ahead, aside] = [Math.cos(heading), Math.sin(heading), 0.32 * length, 0.36 * width];
  return [
    [x + c * ahead - s * aside, y + s * ahead + c * aside],
    [x + c * ahead + s * aside, y + s * ahead - c * aside],
  ];
}

function rgba(hex: string, alpha = 255): Colour {
  const part = (at: number) => Number.parseInt(hex.slice(at, at + 2), 16);
  return [part(1), part(3), part(5), alpha];
}
