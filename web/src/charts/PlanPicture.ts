/**
 * A plan on a canvas that one can move and enlarge.
 *
 * The ground is drawn once, somewhat larger than the screen, and then only shifted; while somebody turns the wheel,
 * the old picture is stretched until there is time for a sharp one. The marks are drawn anew each time.
 */

import type { Finding } from "../model/finding";
import type { PlanLane } from "../model/map";
import { type Cluster, clustered, pickPoint, pickStrip, strips } from "../model/picking";
import {
  type Bounds,
  dragged,
  fitted,
  meet,
  type Point,
  type Size,
  pinched,
  SCALES,
  seen,
  toGround,
  toScreen,
  type View,
  zoomed,
} from "../model/view";
import { Fingers } from "./finger";
import { type Ground, outsideColour, paint } from "./ground";
import { paintMarks } from "./marks";

/** What the picture is of. */
export interface Content {
  ground: Ground;
  /** The lanes that can be picked. */
  lanes: readonly PlanLane[];
  findings: readonly Finding[];
  selected: Finding | undefined;
  /** The road that is selected. */
  road: string | undefined;
  dark: boolean;
}

/** What is under the pointer: one or several findings, a lane, or nothing. */
export interface Picked {
  members: Finding[];
  lane: PlanLane | undefined;
  at: Point;
}

interface Listener {
  onView: (view: View) => void;
  onPick: (picked: Picked) => void;
  /** Tells also when nothing is under the pointer any more. */
  onHover: (picked: Picked | undefined) => void;
}

/** So much of the screen's width and height is drawn beyond each edge. */
const MARGIN = 0.25;
/** After the last turn of the wheel, a sharp picture is drawn [ms]; at once if that takes less than so long. */
const CALM_MS = 90;
const QUICK_MS = 9;
/** Findings nearer to each other than this are one mark [px], and the pointer reaches so far around a mark. */
const APART = 26;
const REACH = 13;
/** A press that moves by less is a click [px]. */
const STILL = 4;
/** From this scale on, one looks at single lanes [px/m]. */
const NEAR = 4;

interface Sheet {
  canvas: HTMLCanvasElement;
  view: View;
  size: Size;
}

export class PlanPicture {
  private view: View = { x: 0, y: 0, scale: 1 };
  private size: Size = { width: 0, height: 0 };
  private ratio = 1;
  private content: Content | undefined;
  private strips: (PlanLane & { bounds: Bounds })[] = [];
  private roadLanes: PlanLane[] = [];
  private clusters: Cluster<Finding>[] = [];
  private clusteredFor = "";
  private sheet: Sheet | undefined;
  private stale = true;
  private cost = 0;
  private calm: ReturnType<typeof setTimeout> | undefined;
  private frame = 0;
  private fittedOnce = false;
  private hovered: Finding | undefined;
  private readonly fingers = new Fingers(() => undefined);
  private press: { x: number; y: number; moved: boolean } | undefined;
  private readonly watcher: ResizeObserver;
  private readonly ended = new AbortController();

  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly listener: Listener,
  ) {
    this.watcher = new ResizeObserver(() => this.resize());
    this.watcher.observe(canvas);
    const { signal } = this.ended;
    canvas.addEventListener("wheel", (event) => this.turned(event), { signal, passive: false });
    canvas.addEventListener("pointerdown", (event) => this.pressed(event), { signal });
    canvas.addEventListener("pointermove", (event) => this.moved(event), { signal });
    canvas.addEventListener("pointerup", (event) => this.released(event), { signal });
    canvas.addEventListener("pointercancel", (event) => this.cancelled(event), { signal });
    canvas.addEventListener("pointerleave", () => this.hover(undefined), { signal });
    this.resize();
  }

  close(): void {
    this.watcher.disconnect();
    this.ended.abort();
    clearTimeout(this.calm);
    cancelAnimationFrame(this.frame);
  }

  /** Show this from now on. */
  show(content: Content): void {
    const before = this.content;
    this.content = content;
    if (before?.ground !== content.ground || before.dark !== content.dark) this.stale = true;
    if (before?.lanes !== content.lanes) this.strips = strips(content.lanes.filter(({ internal }) => !internal));
    this.roadLanes = content.road === undefined ? [] : content.lanes.filter(({ road }) => road === content.road);
    this.clusteredFor = "";
    this.hovered = undefined;
    if (!this.fittedOnce) this.fit();
    this.redraw();
  }

  /** All of the map. */
  fit(): void {
    if (!this.content || this.size.width === 0) return;
    this.fittedOnce = true;
    this.look(fitted(this.content.ground.extent, this.size));
  }

  /** Bring a point into the middle, near enough to see single lanes. */
  centre({ x, y }: Point, scale = Math.max(this.view.scale, NEAR)): void {
    this.look({ x, y, scale });
  }

  /** All of these points, not nearer than is useful. */
  frameAll(points: readonly Point[]): void {
    const [xs, ys] = [points.map(({ x }) => x), points.map(({ y }) => y)];
    const view = fitted([Math.min(...xs), Math.min(...ys), Math.max(...xs), Math.max(...ys)], this.size, 80);
    this.look({ ...view, scale: Math.min(view.scale, 12) });
  }

  zoom(factor: number, at: Point = { x: this.size.width / 2, y: this.size.height / 2 }): void {
    this.look(zoomed(this.view, this.size, factor, at));
  }

  /** By a share of the screen to the right and up. */
  step(right: number, up: number): void {
    this.look(dragged(this.view, -right * this.size.width, up * this.size.height));
  }

  private look(view: View): void {
    this.view = view;
    this.listener.onView(view);
    this.redraw();
  }

  private resize(): void {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    if (width === 0 || height === 0) return;
    this.size = { width, height };
    this.ratio = window.devicePixelRatio || 1;
    this.canvas.width = Math.round(width * this.ratio);
    this.canvas.height = Math.round(height * this.ratio);
    this.stale = true;
    if (this.fittedOnce) this.listener.onView(this.view);
    else this.fit();
    // At once, because a canvas whose size was set is empty.
    this.draw();
  }

  // -- drawing -----------------------------------------------------------------------------------

  private redraw(): void {
    if (this.frame !== 0) return;
    this.frame = requestAnimationFrame(() => {
      this.frame = 0;
      this.draw();
    });
  }

  private draw(): void {
    const context = this.canvas.getContext("2d", { alpha: false });
    const { content } = this;
    if (!context || !content || this.size.width === 0) return;
    if (this.ratio !== (window.devicePixelRatio || 1)) return this.resize();
    if (this.stale || !this.sheetServes()) this.drawSheet(content);
    this.lay(context, content.dark);
    paintMarks(context, { ...this.marks(content), lanes: this.roadLanes }, this.view, this.size, this.ratio);
  }

  /** Whether the picture of the ground can be shifted, or stretched for a moment, to what is looked at. */
  private sheetServes(): boolean {
    if (!this.sheet) return false;
    const { view, size } = this.sheet;
    if (view.scale !== this.view.scale) {
      if (this.cost < QUICK_MS) return false;
      clearTimeout(this.calm);
      this.calm = setTimeout(() => {
        this.stale = true;
        this.redraw();
      }, CALM_MS);
      return true;
    }
    const [have, want] = [seen(view, size), seen(this.view, this.size)];
    return have[0] <= want[0] && have[1] <= want[1] && have[2] >= want[2] && have[3] >= want[3];
  }

  private drawSheet({ ground, dark }: Content): void {
    const size = {
      width: Math.ceil(this.size.width * (1 + 2 * MARGIN)),
      height: Math.ceil(this.size.height * (1 + 2 * MARGIN)),
    };
    const canvas = this.sheet?.canvas ?? document.createElement("canvas");
    const [width, height] = [Math.round(size.width * this.ratio), Math.round(size.height * this.ratio)];
    if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, { width, height });
    const context = canvas.getContext("2d", { alpha: false });
    if (!context) return;
    const began = performance.now();
    paint(context, ground, this.view, size, this.ratio, dark);
    this.cost = performance.now() - began;
    this.sheet = { canvas, view: this.view, size };
    this.stale = false;
  }

  /** Put the sheet where it belongs; at its own scale on whole pixels, so that it stays sharp. */
  private lay(context: CanvasRenderingContext2D, dark: boolean): void {
    if (!this.sheet) return;
    const { canvas, view, size } = this.sheet;
    const [west, , , north] = seen(view, size);
    const corner = toScreen(this.view, this.size, { x: west, y: north });
    const stretch = this.view.scale / view.scale;
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.fillStyle = outsideColour(dark);
    context.fillRect(0, 0, this.canvas.width, this.canvas.height);
    const [left, top] = [corner.x * this.ratio, corner.y * this.ratio];
    if (stretch === 1) context.drawImage(canvas, Math.round(left), Math.round(top));
    else context.drawImage(canvas, left, top, canvas.width * stretch, canvas.height * stretch);
  }

  /** The findings as they are drawn now. */
  private marks({ findings, selected }: Content) {
    const cell = APART / this.view.scale;
    const key = `${Math.round(Math.log2(cell))}`;
    if (key !== this.clusteredFor) {
      this.clusters = clustered(findings.filter((finding) => finding !== selected), cell);
      this.clusteredFor = key;
    }
    return { clusters: this.clusters, selected, hovered: this.hovered };
  }

  // -- the pointer -------------------------------------------------------------------------------

  private at({ clientX, clientY }: MouseEvent): Point {
    const { left, top } = this.canvas.getBoundingClientRect();
    return { x: clientX - left, y: clientY - top };
  }

  private turned(event: WheelEvent): void {
    event.preventDefault();
    // Lines and pages of some mice, in pixels.
    const turn = event.deltaY * ([1, 24, 240][event.deltaMode] ?? 1);
    this.zoom(Math.exp(-Math.max(-240, Math.min(240, turn)) * 0.0022), this.at(event));
  }

  private pressed(event: PointerEvent): void {
    if (event.button !== 0) return;
    if (event.pointerType === "touch") this.fingers.press(event.pointerId, this.at(event));
    this.press = { ...this.at(event), moved: false };
    this.canvas.setPointerCapture(event.pointerId);
  }

  private moved(event: PointerEvent): void {
    const at = this.at(event);
    const pair = this.fingers.move(event.pointerId, at);
    if (pair) {
      this.press = { ...at, moved: true };
      return this.look(pinched(this.view, this.size, pair.before, pair.after));
    }
    if (!this.press) return this.hover(this.pick(at));
    const [dx, dy] = [at.x - this.press.x, at.y - this.press.y];
    if (!this.press.moved && Math.hypot(dx, dy) < STILL) return;
    this.press = { ...at, moved: true };
    this.hover(undefined);
    this.canvas.style.cursor = "grabbing";
    this.look(dragged(this.view, dx, dy));
  }

  private released(event: PointerEvent): void {
    const clicked = this.press !== undefined && !this.press.moved;
    this.fingers.lift(event.pointerId);
    // The finger that stays goes on from where it is.
    if (this.fingers.count > 0) return void (this.press = undefined);
    this.let();
    if (clicked) this.listener.onPick(this.pick(this.at(event)));
  }

  private cancelled(event: PointerEvent): void {
    this.fingers.lift(event.pointerId);
    this.let();
  }

  private let(): void {
    this.press = undefined;
    this.canvas.style.cursor = "";
  }

  private hover(picked: Picked | undefined): void {
    const found = picked && (picked.members.length > 0 || picked.lane) ? picked : undefined;
    const [only] = found?.members.length === 1 ? found.members : [];
    if (only !== this.hovered) {
      this.hovered = only;
      this.redraw();
    }
    if (!this.press) this.canvas.style.cursor = found ? "pointer" : "";
    this.listener.onHover(found);
  }

  /** The marks lie over the roads. */
  private pick(at: Point): Picked {
    const ground = toGround(this.view, this.size, at);
    const reach = REACH / this.view.scale;
    const { content } = this;
    if (!content) return { members: [], lane: undefined, at };
    const { selected, clusters } = this.marks(content);
    const area: Bounds = [ground.x - reach, ground.y - reach, ground.x + reach, ground.y + reach];
    const near = clusters.filter(({ x, y }) => meet([x, y, x, y], area));
    const cluster = pickPoint(near, ground, reach);
    if (cluster) return { members: cluster.members, lane: undefined, at };
    const chosen = selected && pickPoint([selected], ground, reach);
    if (chosen) return { members: [chosen], lane: undefined, at };
    return { members: [], lane: pickStrip(this.strips, ground, 3 / this.view.scale), at };
  }

  /** Whether the plan cannot be enlarged any more. */
  get nearest(): boolean {
    return this.view.scale >= SCALES.most * 0.99;
  }
}
