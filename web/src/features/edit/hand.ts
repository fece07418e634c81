/**
 * The hand in the 3D scene: what the pointer does there is the same as on the plan, by the same commands. The frame tells it rays of sight,
 * and draws the marks that it answers with; it knows nothing of either.
 */

import type { Stretch } from "../../charts/ground";
import type { Drag } from "../../model/editing/deed";
import type { Editing, Figure, Item } from "../../model/editing/item";
import { placeOf } from "../../model/editing/hit";
import { corners, type Line } from "../../model/editing/line";
import type { Marks, Question } from "../../model/editing/mark";
import { liftOf, onLevel, type Place, type Ray, seen } from "../../model/editing/sight";
import type { Lane } from "../../model/editing/snap";
import { distance } from "../../model/picking";
import type { Point } from "../../model/view";
import type { Ghost, Picture } from "./Board";
import { type Doer, draggedThings, type Grip, ghostFor, gripsOf, grippedThing, type Held, letGo, nearest, type Tool } from "./grip";

/** What is there, and who does what the hand wants. */
export interface World extends Doer {
  state: Editing;
  /** Those that are not hidden. */
  items: readonly Item[];
  chosen: readonly string[];
  locked: readonly string[];
  tool: Tool;
  lanes: readonly Lane[];
  /** What of the lanes lies on bridges. */
  aloft: readonly Stretch[];
  /** Whether everything has its name, and not only what is chosen. */
  names: boolean;
  onChoose: (paths: string[]) => void;
  onMove: (items: Item[], drag: Drag) => void;
  onPoint: (point: Point) => void;
  onMenu: (at: Point, ground: Point, item: Item | undefined) => void;
  /** What was held is not there any more. */
  onGone: (items: readonly Item[]) => void;
}

type Press = { start: Point; height: number; to: Point; moved: boolean } & (
  | { is: "things"; items: Item[]; from: Point; click: string[] }
  | { is: "grip"; grip: Grip }
  /** On the frame [px]: what lies within it is chosen, too. */
  | { is: "rectangle"; corner: Point }
);

/** A press that moves by less is a click [px]. */
const STILL = 4;
/** So near a grip is taken hold of [px]. */
const HOLD = 12;
const MOST_NAMES = 80;
/** How far before its end the handle to turn something by lies [m]. */
const BEFORE = 1.5;
const arm = (length: number) => length / 2 + BEFORE;

export class Hand {
  private press: Press | undefined;
  private over: Item | undefined;
  private ground: Point | undefined;

  constructor(
    private readonly world: () => World,
    private readonly show: (marks: Marks) => void,
  ) {}

  /** What the pointer does; whether the hand has taken it, so that the camera stays. */
  readonly ask = (question: Question): boolean => {
    const taken = this.answer(question);
    this.show(this.marks());
    return taken;
  };

  /** Lets go without doing anything; whether anything was held. */
  readonly cancel = (): boolean => {
    const held = this.press !== undefined;
    this.press = undefined;
    this.show(this.marks());
    return held;
  };

  /** The world has changed: what is held may be gone. */
  readonly renew = (): void => {
    const { state, onGone } = this.world();
    const gone = this.heldItems().filter(({ path }) => !state.items.some((item) => item.path === path));
    if (this.over && !state.items.includes(this.over)) this.over = undefined;
    if (gone.length > 0) {
      this.press = undefined;
      onGone(gone);
    }
    this.show(this.marks());
  };

  private heldItems(): readonly Item[] {
    if (!this.press || this.press.is === "rectangle") return [];
    if (this.press.is === "things") return this.press.items;
    return "item" in this.press.grip ? [this.press.grip.item] : [];
  }

  private answer(question: Question): boolean {
    switch (question.phase) {
      case "down":
        return this.down(question);
      case "move":
        return this.press ? this.drag(this.press, question) : this.hover(question);
      case "up":
        return this.up(question);
      case "click":
        return this.click(question);
      case "menu":
        return this.menu(question);
      default:
        this.press = this.over = this.ground = undefined;
        return false;
    }
  }

  private down({ ray, at, add, spot }: Question): boolean {
    const { chosen, tool, onChoose } = this.world();
    const held = this.gripAt(at, spot);
    if (held) {
      const height = this.heightOf(held.grip);
      this.press = { is: "grip", grip: held.grip, start: at, height, to: held.point, moved: false };
      return true;
    }
    const found = tool.is === "select" ? seen(this.pickable(), ray) : undefined;
    if (!found && add && tool.is === "select") {
      // Without Shift or Ctrl the drag is the camera's.
      this.press = { is: "rectangle", start: at, corner: at, height: 0, to: at, moved: false };
      return true;
    }
    if (!found) return false;
    const { path } = found.item;
    const already = chosen.includes(path);
    const next = add ? (already ? chosen.filter((each) => each !== path) : [...chosen, path]) : [path];
    if (!already) onChoose(next);
    const taken = already ? chosen : next;
    // Taken hold of where one has pointed at, it stays under the pointer.
    const height = onLevel(ray, found.height) ? found.height : liftOf(found.item);
    const from = onLevel(ray, height) ?? { x: 0, y: 0 };
    this.press = { is: "things", items: this.pickable().filter((item) => taken.includes(item.path)), from, start: at, height, to: from, moved: false, click: next };
    return true;
  }

  private drag(press: Press, { ray, at }: Question): boolean {
    press.moved ||= Math.hypot(at.x - press.start.x, at.y - press.start.y) >= STILL;
    if (press.is === "rectangle") press.corner = at;
    else press.to = onLevel(ray, press.height) ?? press.to;
    return true;
  }

  private hover({ ray, at, spot }: Question): boolean {
    const isSelect = this.world().tool.is === "select";
    this.over = isSelect ? seen(this.pickable(), ray)?.item : undefined;
    this.ground = isSelect ? undefined : this.groundOf(ray);
    return this.over !== undefined || this.gripAt(at, spot) !== undefined;
  }

  private up(question: Question): boolean {
    const { press } = this;
    if (!press) return false;
    this.drag(press, question);
    this.press = undefined;
    const world = this.world();
    if (press.is === "rectangle") return this.choose(press, question.spot);
    if (press.is === "grip") letGo(press.grip, press.moved, press.to, world);
    else if (press.moved) world.onMove(press.items, { from: press.from, to: press.to });
    else world.onChoose(press.click);
    return true;
  }

  /** Chooses what lies within a rectangle, beside what is chosen. */
  private choose({ start, corner, moved }: Press & { is: "rectangle" }, spot: Question["spot"]): true {
    const { chosen, onChoose } = this.world();
    const [x, y] = [[start.x, corner.x], [start.y, corner.y]];
    const isIn = (item: Item) => {
      const place = item.group === "route" ? undefined : placeOf(item);
      const seenAt = place && spot([place.x, place.y, liftOf(item)]);
      return !!seenAt && seenAt[0] >= Math.min(...x) && seenAt[0] <= Math.max(...x) && seenAt[1] >= Math.min(...y) && seenAt[1] <= Math.max(...y);
    };
    if (moved) onChoose([...new Set([...chosen, ...this.pickable().filter(isIn).map(({ path }) => path)])]);
    return true;
  }

  private click({ ray, add }: Question): boolean {
    const { tool, onChoose, onPoint } = this.world();
    const ground = this.groundOf(ray);
    if (tool.is === "select" && !add) onChoose([]);
    if (tool.is !== "select" && ground) onPoint(ground);
    return true;
  }

  private menu({ ray, at }: Question): boolean {
    const ground = this.groundOf(ray);
    if (ground) this.world().onMenu(at, ground, seen(this.world().items, ray)?.item);
    return ground !== undefined;
  }

  private pickable(): Item[] {
    const { items, locked } = this.world();
    return items.filter(({ path }) => !locked.includes(path));
  }

  private grips(): Held[] {
    const { state, items, chosen, locked, tool } = this.world();
    return gripsOf(state, items.filter(({ path }) => chosen.includes(path)), locked, tool, arm);
  }

  private gripAt(at: Point, spot: Question["spot"]): Held | undefined {
    const grips = this.grips();
    const away = (point: Point) => {
      const found = spot([point.x, point.y, this.heightOf(grips.find((held) => held.point === point)?.grip)]);
      return found ? Math.hypot(found[0] - at.x, found[1] - at.y) : Number.POSITIVE_INFINITY;
    };
    return nearest(grips, away, HOLD);
  }

  private heightOf(grip: Grip | undefined): number {
    return grip && "item" in grip ? liftOf(grip.item) : 0;
  }

  /** Where a ray comes to the ground, or to a bridge above it. */
  private groundOf(ray: Ray): Point | undefined {
    const { aloft } = this.world();
    const bridges = [...new Set(aloft.map(({ lift }) => lift))].filter((lift) => lift > 0).sort((one, other) => other - one);
    const on = bridges.flatMap((level) => {
      const point = onLevel(ray, level);
      const is = point && aloft.some(({ lift, centre, width }) => lift === level && distance(centre, point) <= width / 2);
      return is ? [point] : [];
    });
    return on[0] ?? onLevel(ray, 0);
  }

  // -- what is drawn -------------------------------------------------------------------------------

  private marks(): Marks {
    const { items, chosen, names } = this.world();
    const mine = items.filter(({ path }) => chosen.includes(path));
    const picture = this.picture();
    const height = this.press?.is === "things" ? this.press.items.map(({ figures }) => figures[0]?.height ?? 0) : [];
    const lift = this.heldItems().map(liftOf)[0] ?? 0;
    const over = this.over && !this.press ? [this.over] : [];
    return {
      lines: [
        ...[...mine, ...over].flatMap((item) => item.figures.flatMap((figure) => rim(figure, chosen.includes(item.path)))),
        ...(picture.ghosts ?? []).flatMap((ghost, n) => boxed(ghost, height[n] ?? 0, lift)),
        ...(picture.outlines ?? []).map((line) => flat(line, lift, true)),
        ...(picture.lines ?? []).map((line) => flat(line, lift, false)),
      ],
      knobs: this.press?.moved ? [] : this.grips().map(({ grip, point }) => [point.x, point.y, this.heightOf(grip)] as const),
      words: [...new Set([...over, ...mine, ...(names ? items : [])])].slice(0, MOST_NAMES).flatMap((item) => named(item, mine.includes(item))),
      told: toldOf(mine, over, this.press?.moved ? this.heldItems() : []),
      rectangle: this.press?.is === "rectangle" && this.press.moved ? [this.press.start, this.press.corner] : undefined,
    };
  }

  /** What is being done, as the plan shows it too. */
  private picture(): Partial<Picture> {
    const { state, lanes, tool } = this.world();
    const { press, ground } = this;
    if (press?.moved && press.is !== "rectangle") {
      if (press.is === "things") return draggedThings(state, press.items, { from: press.from, to: press.to }, lanes);
      return grippedThing(press.grip, press.to, state);
    }
    if (tool.is === "add" && ground) return { ghosts: [ghostFor(tool.what, ground, lanes)] };
    if (tool.is === "area" || tool.is === "walls" || tool.is === "measure") {
      const made = tool.is === "measure" ? tool.points : tool.corners;
      return { lines: [[...made, ...(ground ? [ground] : [])].map(({ x, y }) => [x, y] as const)] };
    }
    return {};
  }
}

/** Above the road, so that a line is not in it [m]. */
const ABOVE = 0.06;
const raised = (line: Line, height: number): Place[] => line.map(([x, y]) => [x, y, height + ABOVE] as const);

const flat = (line: Line, height: number, closed: boolean): Marks["lines"][number] => ({ points: raised(line, height), closed, strong: true, filled: closed });

/** A box about a body: its foot, its top, and four posts. */
function boxed({ x, y, heading, length, width }: Ghost, height: number, lift: number, filled = true): Marks["lines"] {
  const foot = corners(x, y, heading, Math.max(length, 0.5), Math.max(width, 0.5));
  const top = raised(foot, lift + height);
  const line = (points: Place[], closed: boolean, full: boolean) => ({ points, closed, strong: true, filled: full });
  if (height < 0.1) return [line(raised(foot, lift), true, filled)];
  const posts = raised(foot, lift).map((point, n) => line([point, top[n] as Place], false, false));
  return [line(raised(foot, lift), true, filled), line(top, true, false), ...posts];
}

/** The rim of what is chosen, or under the pointer. */
function rim(figure: Figure, strong: boolean): Marks["lines"] {
  const { shape, height, lift, line } = figure;
  if (shape === "body") return boxed(figure, height, lift, false).map((each) => ({ ...each, strong }));
  if (shape === "point") return boxed({ ...figure, length: 1.5, width: 1.5 }, height, lift, false).map((each) => ({ ...each, strong }));
  return [{ ...flat(line, lift, shape !== "line"), strong }];
}

function named({ name, figures: [figure] }: Item, strong: boolean): Marks["words"] {
  if (!figure || (figure.shape !== "body" && figure.shape !== "point")) return [];
  return [{ at: [figure.x, figure.y, figure.lift + figure.height + 0.8], text: name, strong }];
}

function toldOf(mine: readonly Item[], over: readonly Item[], held: readonly Item[]): string {
  const list = (what: string, some: readonly Item[]) => (some.length ? [`${what} ${some.map(({ name }) => name).join(" ")}`] : []);
  return [...list("chosen", mine), ...list("under the pointer", over), ...list("held", held)].join(", ");
}
