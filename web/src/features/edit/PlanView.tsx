/** The plan of the editor: what is looked at, what the pointer does, and what is drawn of that. */

import { type MouseEvent, type PointerEvent, type RefObject, useCallback, useEffect, useImperativeHandle, useMemo, useRef, useState, type WheelEvent } from "react";
import { flushSync } from "react-dom";
import type { Drag } from "../../model/editing/deed";
import { boundsOfItems, hit, placeOf, within } from "../../model/editing/hit";
import type { Editing, Item } from "../../model/editing/item";
import type { Line } from "../../model/editing/line";
import type { Knob } from "../../model/editing/shape";
import { type Lane, onLane } from "../../model/editing/snap";
import type { Plan } from "../../model/map";
import { type Bounds, dragged, fitted, pinched, type Point, scaleBar, type Size, toGround, toScreen, type View, zoomed } from "../../model/view";
import { useDark } from "../../ui/dark";
import { Fingers, TREMBLE } from "../../charts/finger";
import type { Board, Picture } from "./Board";
import classes from "./Edit.module.css";
import { draggedThings, type Grip, ghostFor, gripsOf, grippedThing, type Held, letGo, nearest, type Tool } from "./grip";
import { Knobs } from "./Knobs";

/** What the page may ask the plan to show. */
export interface Looker {
  focus: (items: readonly Item[]) => void;
  all: () => void;
  middle: () => Point;
}

interface Props {
  looker: RefObject<Looker | null>;
  plan: Plan;
  state: Editing;
  lanes: readonly Lane[];
  /** Those that are not hidden. */
  items: readonly Item[];
  chosen: readonly string[];
  locked: readonly string[];
  tool: Tool;
  names: boolean;
  onChoose: (paths: string[]) => void;
  onMove: (items: Item[], drag: Drag) => void;
  onTurn: (item: Item, heading: number) => void;
  onPoint: (point: Point) => void;
  /** A point of a shape is where it is dragged to, or taken out. */
  onPull: (item: Item, knob: Knob, to: Point) => void;
  onTakeOut: (item: Item, knob: Knob) => void;
  onHandle: (handle: number, to: Point | undefined) => void;
  onMenu: (at: Point, ground: Point, item: Item | undefined) => void;
  onEnough: () => void;
}

/** A press that moves by less is a click [px]; a finger trembles. */
const stillOf = ({ pointerType }: PointerEvent): number => (pointerType === "touch" ? TREMBLE : 4);
/** The pointer reaches so far around thin things [px]. */
const REACH = 7;
/** And a finger so far around what it takes hold of [px]. */
const FINGER = 20;
const HOLD = 9;
/** How far before its middle the handle to turn something by lies [px]. */
const ARM = 34;

type Press =
  /** Two fingers, or one that has rested: nothing is held until all of them are gone. */
  | { is: "fingers" }
  | { is: "pan"; last: Point; moved: boolean }
  | { is: "rectangle"; from: Point; add: boolean; moved: boolean }
  | { is: "things"; items: Item[]; from: Point; start: Point; moved: boolean; click: string[] }
  | { is: "grip"; grip: Grip; moved: boolean; start: Point }
  | { is: "point"; start: Point };

export function PlanView(props: Props) {
  const { looker, plan, state, lanes, items, chosen, locked, tool, names } = props;
  const place = useRef<HTMLDivElement>(null);
  const canvas = useRef<HTMLCanvasElement>(null);
  const dark = useDark();
  const [size, setSize] = useState<Size>({ width: 0, height: 0 });
  const [view, setView] = useState<View>();
  const [press, setPress] = useState<Press>();
  const [pointer, setPointer] = useState<Point>();
  const board = useBoard(canvas, size);

  useEffect(() => {
    // Within the frame in which the place changes: nothing on the plan is ever drawn where it was before.
    const watcher = new ResizeObserver(([entry]) => entry && flushSync(() => setSize({ width: entry.contentRect.width, height: entry.contentRect.height })));
    watcher.observe(place.current as HTMLElement);
    return () => watcher.disconnect();
  }, []);
  const frame = useCallback((bounds: Bounds, margin: number, most: number) => {
    const found = fitted(bounds, size, margin);
    setView({ ...found, scale: Math.min(found.scale, most) });
  }, [size]);
  // What is in the scenario is looked at first, and of the map as much as is around it.
  useEffect(() => {
    if (view || size.width === 0) return;
    frame(boundsOfItems(state.items.filter(({ group }) => group !== "route").map(({ figures, ...each }) => ({ ...each, figures: figures.map((f) => ({ ...f, line: f.shape === "body" ? [] : (f.line ?? []) })) }))) ?? plan.bounds_m, 120, 6);
  }, [view, size, state, plan, frame]);
  useImperativeHandle(looker, () => ({
    focus: (wanted) => frame(boundsOfItems(wanted) ?? plan.bounds_m, 140, 9),
    all: () => frame(plan.bounds_m, 24, 60),
    middle: () => ({ x: view?.x ?? 0, y: view?.y ?? 0 }),
  }), [frame, plan, view]);

  const reach = REACH / (view?.scale ?? 1);
  const pickable = useMemo(() => items.filter(({ path }) => !locked.includes(path)), [items, locked]);
  const ground = pointer && view ? toGround(view, size, pointer) : undefined;
  const hovered = ground && !press && tool.is === "select" ? hit(pickable, ground, reach) : undefined;
  const mine = items.filter(({ path }) => chosen.includes(path));
  const grips = useMemo(() => (view ? gripsOf(state, mine, locked, tool, armAt(view)) : []), [state, mine, locked, tool, view]);
  const drag: Drag | undefined = press?.is === "things" && press.moved && ground ? { from: press.from, to: ground } : undefined;
  const picture = useMemo(
    () => pictureOf({ plan, items, chosen, dark, hovered: hovered?.path, tool, ground, lanes, state, drag, press, grips }),
    [plan, items, chosen, dark, hovered, tool, ground, lanes, state, drag, press, grips],
  );
  useEffect(() => board?.show(picture), [board, picture]);
  useEffect(() => view && board?.look(view), [board, view]);

  const local = (event: { clientX: number; clientY: number }): Point => {
    const box = (place.current as HTMLElement).getBoundingClientRect();
    return { x: event.clientX - box.left, y: event.clientY - box.top };
  };

  const hasRested = useRef(false);
  const rest = useRef<(at: Point) => void>(undefined);
  rest.current = (at) => {
    if (!view) return;
    const on = toGround(view, size, at);
    const { left, top } = (place.current as HTMLElement).getBoundingClientRect();
    setPress({ is: "fingers" });
    hasRested.current = true;
    props.onMenu({ x: left + at.x, y: top + at.y }, on, hit(items, on, FINGER / view.scale));
  };
  const [fingers] = useState(() => new Fingers((at) => rest.current?.(at)));

  const down = (event: PointerEvent) => {
    if (!view || (event.target as HTMLElement).closest("[data-over]")) return;
    const isFinger = event.pointerType === "touch";
    hasRested.current = false;
    if (isFinger) fingers.press(event.pointerId, local(event));
    if (isFinger && fingers.count > 1) return setPress({ is: "fingers" });
    (event.currentTarget as HTMLElement).focus({ preventScroll: true });
    (event.currentTarget as HTMLElement).setPointerCapture(event.pointerId);
    const screen = local(event);
    const on = toGround(view, size, screen);
    setPointer(screen);
    if (event.button === 1 || event.button === 2) return setPress({ is: "pan", last: screen, moved: false });
    const held = nearest(grips, (point) => distance(toScreen(view, size, point), screen), event.pointerType === "touch" ? FINGER : HOLD);
    if (held) {
      focusKnob(place.current, held.grip);
      return setPress({ is: "grip", grip: held.grip, moved: false, start: screen });
    }
    if (tool.is !== "select") return setPress({ is: "point", start: screen });
    const found = hit(pickable, on, reach);
    const add = event.shiftKey || event.ctrlKey || event.metaKey;
    if (!found) return setPress({ is: "rectangle", from: screen, add, moved: false });
    const already = chosen.includes(found.path);
    const next = add ? (already ? chosen.filter((path) => path !== found.path) : [...chosen, found.path]) : [found.path];
    if (!already) props.onChoose(next);
    const taken = already ? chosen : next;
    setPress({ is: "things", items: pickable.filter(({ path }) => taken.includes(path)), from: on, start: screen, moved: false, click: next });
  };

  const move = (event: PointerEvent) => {
    const screen = local(event);
    const pair = fingers.move(event.pointerId, screen);
    if (pair) return setView((now) => now && pinched(now, size, pair.before, pair.after));
    setPointer(screen);
    if (!press || !view || press.is === "fingers") return;
    const STILL = stillOf(event);
    if (press.is === "pan") {
      if (!press.moved && distance(press.last, screen) < STILL) return;
      setView(dragged(view, screen.x - press.last.x, screen.y - press.last.y));
      return setPress({ ...press, last: screen, moved: true });
    }
    if (press.is !== "point" && !press.moved && distance(startOf(press), screen) >= STILL) setPress({ ...press, moved: true });
  };

  const up = (event: PointerEvent) => {
    fingers.lift(event.pointerId);
    if (press?.is === "fingers" && fingers.count > 0) return;
    if (!press || !view || press.is === "fingers") return setPress(undefined);
    const STILL = stillOf(event);
    setPress(undefined);
    const screen = local(event);
    const on = toGround(view, size, screen);
    // A quick drag is over before its moves were drawn.
    const isMoved = "moved" in press && (press.moved || distance(press.is === "pan" ? press.last : startOf(press), screen) >= STILL);
    switch (press.is) {
      case "pan":
        if (isMoved && !press.moved) setView(dragged(view, screen.x - press.last.x, screen.y - press.last.y));
        if (!isMoved && event.button === 2) props.onMenu({ x: event.clientX, y: event.clientY }, on, hit(items, on, reach));
        return;
      case "rectangle": {
        const found = isMoved ? within(pickable, spanned(toGround(view, size, press.from), on)).map(({ path }) => path) : [];
        return props.onChoose(press.add ? [...new Set([...chosen, ...found])] : found);
      }
      case "things":
        if (isMoved) props.onMove(press.items, { from: press.from, to: on });
        else props.onChoose(press.click);
        return;
      case "grip":
        return letGo(press.grip, isMoved, on, props);
      case "point":
        if (distance(press.start, screen) < 3 * STILL) props.onPoint(on);
    }
  };

  const wheel = (event: WheelEvent) => {
    if (!view) return;
    setView(zoomed(view, size, Math.exp(-event.deltaY * (event.deltaMode === 1 ? 0.05 : 0.0015)), local(event)));
  };

  const bar = view ? scaleBar(view.scale) : undefined;
  return (
    <div
      ref={place}
      className={classes.plan}
      data-tool={tool.is}
      data-hit={hovered ? true : undefined}
      tabIndex={0}
      role="application"
      aria-label="Plan of the scenario"
      onPointerDown={down}
      onPointerMove={move}
      onPointerUp={up}
      onPointerCancel={(event) => {
        fingers.lift(event.pointerId);
        setPress(undefined);
      }}
      onPointerLeave={() => setPointer(undefined)}
      // The mouse that the browser plays after a finger would close the menu that the finger has opened.
      onTouchEnd={(event) => hasRested.current && event.preventDefault()}
      onWheel={wheel}
      onDoubleClick={(event) => {
        if (tool.is !== "select") return props.onEnough();
        const grip = view && nearest(grips, (point) => distance(toScreen(view, size, point), local(event)), FINGER)?.grip;
        if (grip?.is === "knob" && grip.knob.is === "corner") props.onTakeOut(grip.item, grip.knob);
        if (grip?.is === "knob" && grip.knob.is === "edge") props.onPull(grip.item, grip.knob, grip.knob);
      }}
      onContextMenu={(event: MouseEvent) => event.preventDefault()}
    >
      <canvas ref={canvas} className={classes.canvas} aria-hidden="true" />
      {view ? <Names items={items} chosen={chosen} hovered={hovered?.path} view={view} size={size} all={names} /> : null}
      {view ? <Knobs held={knobbed(grips)} place={(point) => toScreen(view, size, point)} onPull={props.onPull} onTakeOut={props.onTakeOut} /> : null}
      {view && tool.is === "route" ? <Numbers points={grips.map(({ point }) => point)} view={view} size={size} /> : null}
      {press?.is === "rectangle" && press.moved && pointer ? <Rectangle from={press.from} to={pointer} /> : null}
      {view && tool.is === "measure" ? <Tape points={tool.points} to={ground} view={view} size={size} /> : null}
      <span className={classes.corner} aria-hidden="true">
        <span className={classes.bar} style={{ width: bar?.pixels }}>
          {bar?.label}
        </span>
        {ground ? ` ${ground.x.toFixed(1)} m east, ${ground.y.toFixed(1)} m north` : ""}
      </span>
      <span className={classes.attribution}>{plan.attribution}</span>
    </div>
  );
}

/** How far the handle to turn by lies from the middle [px]: not where the end is, which has a handle of its own. */
const armAt =
  ({ scale }: View) =>
  (length: number): number => {
    const end = (length / 2) * scale;
    return (Math.abs(end - ARM) < 2 * HOLD ? end + ARM : ARM) / scale;
  };

/** The points of shapes among what can be taken hold of. */
const knobbed = (grips: readonly Held[]) => grips.flatMap(({ grip }) => (grip.is === "knob" ? [{ item: grip.item, knob: grip.knob }] : []));

/** What was taken hold of by the pointer is what the keys then move and take out. */
function focusKnob(place: HTMLElement | null, grip: Grip): void {
  if (grip.is === "knob") place?.querySelector<HTMLElement>(`[data-knob="${grip.knob.is} ${grip.knob.number}"]`)?.focus({ preventScroll: true });
}

/** Where on the screen a press began. */
const startOf = (press: Exclude<Press, { is: "pan" | "fingers" }>): Point => (press.is === "rectangle" ? press.from : press.start);

const distance = (a: Point, b: Point): number => Math.hypot(a.x - b.x, a.y - b.y);

const spanned = (a: Point, b: Point): Bounds => [Math.min(a.x, b.x), Math.min(a.y, b.y), Math.max(a.x, b.x), Math.max(a.y, b.y)];

/** The drawing of the graphics card: loaded when it is wanted. */
function useBoard(canvas: RefObject<HTMLCanvasElement | null>, size: Size): Board | undefined {
  const [board, setBoard] = useState<Board>();
  const ready = size.width > 0;
  useEffect(() => {
    if (!ready) return;
    let [made, gone] = [undefined as Board | undefined, false];
    void import("./Board").then(({ Board: Made }) => {
      if (gone || !canvas.current) return;
      made = new Made(canvas.current, { width: canvas.current.clientWidth, height: canvas.current.clientHeight });
      setBoard(made);
    });
    return () => {
      gone = true;
      made?.close();
      setBoard(undefined);
    };
  }, [canvas, ready]);
  useEffect(() => board?.resize(size.width, size.height), [board, size]);
  return board;
}

interface Scene {
  plan: Plan;
  items: readonly Item[];
  chosen: readonly string[];
  dark: boolean;
  hovered: string | undefined;
  tool: Tool;
  ground: Point | undefined;
  lanes: readonly Lane[];
  state: Editing;
  drag: Drag | undefined;
  press: Press | undefined;
  grips: readonly Held[];
}

function pictureOf({ plan, items, chosen, dark, hovered, tool, ground, lanes, state, drag, press, grips }: Scene): Picture {
  const isMiddle = ({ grip }: Held) => grip.is === "knob" && grip.knob.is === "edge";
  const base: Picture = {
    plan, items, chosen, dark, hovered, ghosts: [], outlines: [], lines: [],
    handles: grips.filter((each) => !isMiddle(each)).map(({ point }) => point),
    middles: grips.filter(isMiddle).map(({ point }) => point),
  };
  if (drag && press?.is === "things") return { ...base, ...draggedThings(state, press.items, drag, lanes) };
  if (press?.is === "grip" && press.moved && ground) return { ...base, ...grippedThing(press.grip, ground, state) };
  if (tool.is === "measure" || tool.is === "area" || tool.is === "walls") {
    const made = tool.is === "measure" ? tool.points : tool.corners;
    const line = [...made, ...(ground ? [ground] : [])].map(({ x, y }) => [x, y] as [number, number]);
    return { ...base, lines: line.length > 1 ? [line] : [], outlines: tool.is === "area" && line.length > 2 ? [line] : [], handles: made };
  }
  if (tool.is === "add" && ground) return { ...base, ghosts: [ghostFor(tool.what, ground, lanes)] };
  if (tool.is === "route") {
    const line = state.items.find(({ path }) => path === `routes.${tool.route}`)?.figures[0]?.line ?? [];
    const lane = ground ? onLane(lanes, ground)?.foot : undefined;
    return { ...base, lines: line.length > 1 ? [line] : [], ghosts: lane ? [{ ...lane, length: 1.5, width: 1.5 }] : [] };
  }
  return base;
}

// -- over the drawing ----------------------------------------------------------------------------

const MOST_NAMES = 80;

function Names({ items, chosen, hovered, view, size, all }: { items: readonly Item[]; chosen: readonly string[]; hovered: string | undefined; view: View; size: Size; all: boolean }) {
  const isLit = ({ path }: Item) => path === hovered || chosen.includes(path);
  const shown = items
    .filter(({ path, group }) => (all && group !== "route") || path === hovered || chosen.includes(path))
    .flatMap((item) => {
      const place = placeOf(item);
      const screen = place && toScreen(view, size, place);
      const seen = screen && screen.x > -20 && screen.y > -20 && screen.x < size.width + 20 && screen.y < size.height + 20;
      return seen ? [{ item, screen }] : [];
    })
    .slice(0, MOST_NAMES)
    .sort((a, b) => Number(isLit(b.item)) - Number(isLit(a.item)))
    .reduce<Named[]>((kept, each) => (isLit(each.item) || kept.every((other) => !covers(other, each)) ? [...kept, each] : kept), []);
  return (
    <div className={classes.names}>
      {shown.map(({ item: { path, name, told }, screen }) => (
        <span key={path} className={classes.name} data-testid={`on-plan-${path}`} data-chosen={chosen.includes(path) || undefined} style={{ left: screen.x, top: screen.y }}>
          {name}
          {path === hovered ? <small> {told}</small> : null}
        </span>
      ))}
    </div>
  );
}

interface Named {
  item: Item;
  screen: Point;
}

/** About how wide a letter is, and how high a name [px]. */
const LETTER = 6.5;
const LINE = 17;

/** Whether one name would lie on another. */
const covers = (one: Named, other: Named): boolean =>
  Math.abs(one.screen.y - other.screen.y) < LINE &&
  Math.abs(one.screen.x - other.screen.x) < 5 + (LETTER * (one.item.name.length + other.item.name.length)) / 2;

/** The points of a route, in the order in which they are driven. */
const Numbers = ({ points, view, size }: { points: readonly Point[]; view: View; size: Size }) =>
  points.map((point, number) => {
    const { x, y } = toScreen(view, size, point);
    return (
      <span key={`${number} ${point.x}`} className={classes.name} data-chosen data-testid={`route-point-${number + 1}`} style={{ left: x, top: y }}>
        {number + 1}
      </span>
    );
  });

const Rectangle = ({ from, to }: { from: Point; to: Point }) => (
  <div
    className={classes.rectangle}
    style={{ left: Math.min(from.x, to.x), top: Math.min(from.y, to.y), width: Math.abs(to.x - from.x), height: Math.abs(to.y - from.y) }}
  />
);

/** The length of the tape, at its end. */
function Tape({ points, to, view, size }: { points: readonly Point[]; to: Point | undefined; view: View; size: Size }) {
  const all = [...points, ...(to ? [to] : [])];
  const line: Line = all.map(({ x, y }) => [x, y] as const);
  const last = all.at(-1);
  if (all.length < 2 || !last) return null;
  const total = line.slice(1).reduce((sum, [x, y], n) => sum + Math.hypot(x - (line[n]?.[0] ?? x), y - (line[n]?.[1] ?? y)), 0);
  const screen = toScreen(view, size, last);
  return (
    <span className={classes.name} data-chosen data-testid="tape" style={{ left: screen.x, top: screen.y }}>
      {total.toFixed(2)} m
    </span>
  );
}
