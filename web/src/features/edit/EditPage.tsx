/** The editor: everything in a scenario in a list and on a plan from above, its form, and what happens when. */

import { Alert, Button } from "@mantine/core";
import { useLocalStorage } from "@mantine/hooks";
import { Link } from "@tanstack/react-router";
import { useCallback, useMemo, useRef, useState } from "react";
import { findWay, type Made, type Make, useEdited, useEditing, useNews } from "../../api/editing";
import * as deeds from "../../model/editing/deed";
import { type Deed, type Editing, type Item, named, OPEN, owner, present, toggled, type Veil } from "../../model/editing/item";
import { cornerRemoved, LONGEST_WALL, type Knob, pulled, walls } from "../../model/editing/shape";
import { type Lane, onLane } from "../../model/editing/snap";
import type { Plan } from "../../model/map";
import { strips } from "../../model/picking";
import type { Problem } from "../../model/run";
import type { Point } from "../../model/view";
import { Icon } from "../../ui/Icon";
import { notify, notifyError } from "../../ui/notify";
import { ProblemList } from "../../ui/Problems";
import { Failure, Loading } from "../../ui/State";
import classes from "./Edit.module.css";
import { Head } from "./Head";
import { useKeys } from "./keys";
import { Outline } from "./Outline";
import type { Tool } from "./grip";
import { type Looker, PlanView } from "./PlanView";
import { PointMenu, type Pointed } from "./PointMenu";
import { Properties } from "./Properties";
import { type Onlooker, SceneBoard } from "./SceneBoard";
import { Timetable } from "./Timetable";
import { Toolbar } from "./Toolbar";

interface Props {
  id: string;
  /** What is chosen, paths with commas between them: it stands in the address. */
  at: string | undefined;
  onAt: (at: string | undefined) => void;
}

export function EditPage({ id, at, onAt }: Props) {
  const { state, plan } = useEdited(id);
  if (state.error && !state.data) return <Broken id={id} error={state.error} onRetry={() => void state.refetch()} />;
  if (plan.error) return <Failure error={plan.error} onRetry={() => void plan.refetch()} />;
  if (!state.data) return <Loading what="the scenario" />;
  if (!plan.data) return <Loading what="the map" />;
  return (
    <Editor id={id} at={at} onAt={onAt} state={state.data} plan={plan.data} broken={state.error} />
  );
}

/** A file that is no scenario now can be mended as text. */
const Broken = ({ id, error, onRetry }: { id: string; error: Error; onRetry: () => void }) => (
  <>
    <Failure error={error} onRetry={onRetry} />
    <Button m="md" component={Link} to="/scenarios/$scenario/text" params={{ scenario: id } as never}>
      Mend it as text
    </Button>
  </>
);

const LYING = "Routes are drawn with their own tool, and vehicles stand on lanes of their way.";
const SELECT: Tool = { is: "select" };
const NOTHING: string[] = [];
/** What was copied last, also from another scenario. */
let clipboard: deeds.Copied[] = [];

function Editor({ id, at, onAt, state, plan, broken }: Props & { state: Editing; plan: Plan; broken: Error | null }) {
  const choosing = useMemo(() => ({ wanted: at ? at.split(",") : NOTHING, choose: (paths: string[]) => onAt(paths.length ? paths.join(",") : undefined) }), [at, onAt]);
  const editor = useEditor(id, state, plan, choosing);
  const { tool, setTool, chosen, choose, items, veil, looker } = editor;
  const news = useNews(id);
  const [names, setNames] = useState(true);
  const [scene, setScene] = useLocalStorage({ key: "scene beside the plan", defaultValue: false, getInitialValueInEffect: false });
  const onlooker = useRef<Onlooker>(null);
  const [pointed, setPointed] = useState<Pointed>();
  const mine = state.items.filter(({ path }) => chosen.includes(path));
  const focus = (wanted: readonly Item[]) => {
    looker.current?.focus(wanted);
    onlooker.current?.focus(wanted);
  };
  const menu = (screen: Point, ground: Point, item: Item | undefined) => {
    if (item && !chosen.includes(item.path)) choose([item.path]);
    setPointed({ screen, ground, item });
  };
  const common = {
    plan,
    state,
    lanes: editor.lanes,
    items,
    chosen,
    locked: veil.locked,
    tool,
    names,
    onChoose: choose,
    onMove: editor.move,
    onTurn: editor.turn,
    onPoint: editor.point,
    onPull: editor.pull,
    onHandle: editor.handle,
    onMenu: menu,
  };
  useKeys({
    undo: editor.undo,
    redo: editor.redo,
    copy: editor.copy,
    paste: editor.paste,
    duplicate: editor.duplicate,
    delete: editor.remove,
    all: () => choose(items.filter(({ group }) => group !== "route").map(({ path }) => path)),
    focus: () => focus(mine.length ? mine : state.items),
    measure: () => setTool(tool.is === "measure" ? SELECT : { is: "measure", points: [] }),
    names: () => setNames(!names),
    route: () => editor.routeOf && setTool(tool.is === "route" ? SELECT : { is: "route", route: editor.routeOf }),
    scene: () => setScene(!scene),
    escape: () => onlooker.current?.cancel() || (tool.is === "select" ? choose([]) : editor.back()),
    enough: editor.enough,
    nudge: editor.nudge,
  });
  return (
    <div className={classes.page}>
      <Head state={state} news={news} onUndo={editor.undo} onRedo={editor.redo} />
      {broken ? <Stale id={id} error={broken} /> : null}
      {state.sealed ? <Sealed id={id} why={state.sealed} /> : null}
      <Toolbar tool={tool} onTool={setTool} route={editor.routeOf} names={names} onNames={setNames} scene={scene} onScene={setScene} onEvent={editor.event} onEnough={editor.enough} state={state} onAnew={editor.anew} chosen={mine} />
      <div className={classes.main}>
        <Outline
          items={state.items}
          turns={state.turns}
          chosen={chosen}
          veil={veil}
          onVeil={editor.setVeil}
          onChoose={(paths, add) => choose(add ? paths.reduce(toggled, chosen as string[]) : paths)}
          onFocus={(item) => focus([item])}
        />
        <div className={classes.boards}>
          <PlanView {...common} looker={looker} onTakeOut={editor.takeOut} onEnough={editor.enough} />
          {scene ? <SceneBoard {...common} id={id} onlooker={onlooker} /> : null}
        </div>
        <Properties
          id={id}
          state={state}
          chosen={chosen}
          onDeed={editor.attempt}
          onRenamed={(path) => choose([path])}
          middle={() => looker.current?.middle() ?? { x: 0, y: 0 }}
          actions={mine.length ? <Actions editor={editor} /> : null}
        />
      </div>
      <Timetable turns={state.turns} duration={state.duration} chosen={chosen} onChoose={(path) => choose([path])} />
      <PointMenu pointed={pointed} onClose={() => setPointed(undefined)} editor={editor} onFocus={() => focus(mine)} />
    </div>
  );
}

/** What is shown is not what stands in the file, or the server is not there. */
const Stale = ({ id, error }: { id: string; error: Error & { problems?: Problem[] } }) => (
  <Alert color="red" variant="light" py={6} radius={0} icon={<Icon name="warning" />} title={error.message}>
    <ProblemList problems={error.problems ?? []} />
    Shown is how it was before.{" "}
    <Link to="/scenarios/$scenario/text" params={{ scenario: id } as never}>
      Mend it as text
    </Link>
  </Alert>
);

const Sealed = ({ id, why }: { id: string; why: string }) => (
  <Alert color="yellow" variant="light" py={6} radius={0} icon={<Icon name="warning" />}>
    {why}{" "}
    <Link to="/scenarios" search={{ q: id } as never}>
      Duplicate it among the scenarios
    </Link>
  </Alert>
);

function Actions({ editor }: { editor: Editor }) {
  return (
    <div className={classes.actions}>
      <Button size="compact-xs" variant="default" leftSection={<Icon name="copy" size={13} />} onClick={editor.duplicate}>
        Duplicate
      </Button>
      {editor.routeOf ? (
        <Button size="compact-xs" variant="default" leftSection={<Icon name="route" size={13} />} onClick={() => editor.setTool({ is: "route", route: editor.routeOf as string })}>
          Edit route
        </Button>
      ) : null}
      <Button size="compact-xs" variant="default" color="red" leftSection={<Icon name="trash" size={13} />} onClick={editor.remove}>
        Delete
      </Button>
    </div>
  );
}

export type Editor = ReturnType<typeof useEditor>;

/** What is chosen and what is done with it. */
function useEditor(id: string, state: Editing, plan: Plan, { wanted, choose }: { wanted: string[]; choose: (paths: string[]) => void }) {
  const { edit, undo, redo } = useEditing(id);
  const looker = useRef<Looker>(null);
  const lanes: Lane[] = useMemo(() => strips(plan.lanes.filter(({ internal, open }) => !internal && open)), [plan]);
  const [veil, setVeil] = useLocalStorage<Veil>({ key: `veil ${id}`, defaultValue: OPEN, getInitialValueInEffect: false });
  const [tool, showTool] = useState<Tool>(SELECT);
  // On a busy machine clicks come faster than the page is drawn: each goes on from what the last one left, not from what was drawn last.
  const held = useRef<Tool>(SELECT);
  const setTool = (next: Tool) => showTool((held.current = next));
  const chosen = present(wanted, state.items);
  const items = useMemo(() => state.items.filter(({ path }) => !veil.hidden.includes(path)), [state.items, veil.hidden]);
  const mine = state.items.filter(({ path }) => chosen.includes(path));
  const free = mine.filter(({ path }) => !veil.locked.includes(path));
  const [single] = mine;
  const routeOf = mine.length !== 1 ? undefined : single?.group === "route" ? single.name : (single?.route ?? undefined);

  const { mutateAsync } = edit;
  const attempt = useCallback((make: Make) => mutateAsync({ make, seen: state }), [mutateAsync, state]);
  /** Does it, and tells when it is refused. */
  const perform = useCallback(
    (make: Make | undefined) => {
      if (!make) return;
      attempt(make).then((done) => done?.paths?.length && choose([...done.paths]), notifyError);
    },
    [attempt, choose],
  );

  const move = (held: Item[], drag: deeds.Drag) => {
    const [only] = held;
    if (held.length === 1 && only?.group === "vehicle") {
      const [x = 0, y = 0] = only.figures[0]?.anchor ?? [];
      const to = { x: x + drag.to.x - drag.from.x, y: y + drag.to.y - drag.from.y };
      if (deeds.whereabouts(state, only, to, lanes).is === "off") return elsewhere(only, to);
    }
    const deed = deeds.moved(state, held, drag, lanes);
    const stay = deeds.staying(state, held, drag, lanes).map(({ name }) => name);
    if (deed && stay.length > 0) notify(`${stay.join(", ")} ${stay.length > 1 ? "stay" : "stays"} behind.`, LYING, "yellow");
    if (deed)
      perform((now) => {
        const left = same(now, held);
        if (left.length === 0) notify(`${named(held.map(({ path }) => path))} is not there any more.`, "Somebody has deleted it meanwhile; nothing else was changed.", "yellow");
        return made(deeds.moved(now, left, drag, lanes));
      });
    else notify("It stays where it is.", LYING, "yellow");
  };

  /** A vehicle that was put onto another road gets a way from there on. */
  const elsewhere = (item: Item, to: Point) => {
    const place = onLane(lanes, to);
    if (!place) return notify(`${item.name} stays where it is.`, "Vehicles stand on lanes: let it go on a road.", "yellow");
    wayFrom(place, to, [item.name]).then((roads) => perform((now) => ofItem(now, item, (it) => deeds.rerouted(now, it, roads, spot(place)))), notifyError);
  };

  const wayFrom = (place: NonNullable<ReturnType<typeof onLane>>, to: Point, vehicles: string[] = []) =>
    findWay(id, { points: [[to.x, to.y]], roads: [place.road], onwards: true, vehicles }).then(({ roads }) => roads);

  const addVehicle = (to: Point) => {
    const place = onLane(lanes, to);
    if (!place) return notify("No road is there.", "Vehicles stand on lanes: click on a road.", "yellow");
    const speed = Math.min(13.9, lanes.find(({ road }) => road === place.road)?.speed ?? 13.9);
    wayFrom(place, to).then((roads) => perform((now) => one(deeds.vehicleOn(now, roads, spot(place), speed))), notifyError);
  };

  const point = (to: Point) => {
    const tool = held.current;
    if (tool.is === "measure") return setTool({ ...tool, points: [...tool.points, to] });
    if (tool.is === "area" || tool.is === "walls") return setTool({ ...tool, corners: [...tool.corners, to] });
    if (tool.is === "route") return extend(tool.route, to);
    if (tool.is !== "add") return;
    if (tool.what === "vehicle") return addVehicle(to);
    const { what } = tool;
    if (!deeds.placed(state, what, to, lanes)) return notify("No road is there.", "A friction patch lies on a lane: click on a road.", "yellow");
    perform((now) => {
      const made = deeds.placed(now, what, to, lanes);
      return made && { deed: made.deed, paths: [what === "radio" ? `${made.path}.do.area` : made.path] };
    });
  };

  const roadsOf = (now: Editing, route: string): string[] => {
    const roads = deeds.at(now.document, `routes.${route}.roads`);
    return Array.isArray(roads) ? roads.map(String) : [];
  };
  const isLocked = (route: string) => {
    const found = veil.locked.includes(`routes.${route}`);
    if (found) notify(`${route} is locked.`, "Unlock it in the list first.", "yellow");
    return found;
  };
  const rerouted = (route: string, roads: string[]): Made => ({
    deed: { name: `Change route ${route}`, patch: [{ op: "replace", path: `/routes/${route}/roads`, value: roads }] as Deed["patch"] & object },
  });
  const extend = (route: string, to: Point) => {
    if (isLocked(route)) return;
    perform(async (now) => {
      const before = roadsOf(now, route);
      const { roads } = await findWay(id, { points: [[to.x, to.y]], roads: before, onwards: false, vehicles: deeds.usersOf(now, route) });
      if (roads.length !== before.length) return rerouted(route, roads);
      notify("The route leads there already.", "Its last road is this one.", "yellow");
      return undefined;
    });
  };

  /** A point of a route that was dragged onto another road, or clicked, which takes it out. */
  const handle = (number: number, to: Point | undefined) => {
    if (tool.is !== "route" || isLocked(tool.route)) return;
    const { route } = tool;
    const roads = roadsOf(state, route);
    if (!to && roads.length < 2) return notify("A route needs at least one road.", "Drag its point onto another road instead.", "yellow");
    const place = to && onLane(lanes, to, 6);
    if (to && !place) return notify("No road is there.", "Let the point go on a road.", "yellow");
    perform((now) => {
      const before = roadsOf(now, route);
      // The point that was seen, wherever it is among the roads by now.
      const found = before[number] === roads[number] ? number : before.indexOf(roads[number] ?? "");
      if (found < 0) return undefined;
      const next = before.flatMap((road, at) => (at !== found ? [road] : place ? [place.road] : []));
      return rerouted(route, place ? next.filter((road, at) => road !== next[at - 1]) : next);
    });
  };

  /** The vehicle that is chosen gets a way of its own, which begins where it stands. */
  const anew = () => {
    if (single?.group !== "vehicle" || !single.road) return;
    const { path } = single;
    let way: ReturnType<typeof deeds.ownWay> | undefined;
    attempt((now) => {
      const item = now.items.find((each) => each.path === path);
      way = item && deeds.ownWay(now, item);
      return way;
    }).then(() => way && setTool({ is: "route", route: way.route }), notifyError);
  };

  /** A point of a shape somewhere else; where that cannot be, it is told why. */
  const pull = (item: Item, knob: Knob, to: Point) => {
    if (pulled(state, item, knob, to)) return perform((now) => ofItem(now, item, (it) => pulled(now, it, knob, to)));
    notify("It stays as it is.", knob.is === "end" ? `A piece of wall is at most ${LONGEST_WALL} m long.` : "That would be no shape.", "yellow");
  };
  const takeOut = (item: Item, knob: Knob) => {
    if (knob.is !== "corner") return;
    if (cornerRemoved(state, item, knob.number)) return perform((now) => ofItem(now, item, (it) => cornerRemoved(now, it, knob.number)));
    notify("The corner stays.", "With fewer corners it would be no shape: delete the whole of it instead.", "yellow");
  };

  const enough = () => {
    const tool = held.current;
    if (tool.is === "area" && tool.corners.length > 2) {
      const corners = tool.corners.filter((each, at, all) => at === 0 || Math.hypot(each.x - (all[at - 1]?.x ?? 0), each.y - (all[at - 1]?.y ?? 0)) > 0.2);
      perform((now) => one(deeds.area(now, corners)));
    }
    if (tool.is === "walls" && tool.corners.length > 1) perform((now) => walls(now, tool.corners));
    if (tool.is !== "select") setTool(SELECT);
  };

  /** Takes the last point back, or leaves the tool. */
  const back = () => {
    const tool = held.current;
    if ((tool.is === "area" || tool.is === "walls") && tool.corners.length > 0) return setTool({ ...tool, corners: tool.corners.slice(0, -1) });
    if (tool.is === "measure" && tool.points.length > 0) return setTool({ ...tool, points: tool.points.slice(0, -1) });
    setTool(SELECT);
  };

  const paste = () => perform((now) => deeds.pasted(now, clipboard));
  const copy = () => {
    clipboard = deeds.copied(state, chosen);
    if (clipboard.length) notify(`Copied ${named(clipboard.map(({ part, name }) => `${part}.${name}`))}`, "Ctrl+V puts it beside it, here or in another scenario.", "teal", { autoClose: 2500 });
  };
  const duplicate = () => perform((now) => deeds.pasted(now, deeds.copied(now, chosen)));
  const remove = () => {
    const paths = [...new Set(free.map(({ path }) => owner(path)))];
    if (paths.length === 0) return mine.length ? notify("It is locked.", "Unlock it in the list first.", "yellow") : undefined;
    perform({ name: `Delete ${named(paths)}`, remove: paths });
  };
  const turning = (way: "undo" | "redo") => () => {
    const tool = held.current;
    if ((tool.is === "area" || tool.is === "walls") && tool.corners.length > 0 && way === "undo") return back();
    if ((way === "undo" ? state.done : state.undone).length === 0) return;
    (way === "undo" ? undo : redo).mutate(undefined, { onError: notifyError });
  };
  const nudge = useNudge((dx, dy) =>
    perform((now) => made(deeds.nudged(now, same(now, free), dx, dy, lanes))),
  );
  const event = () =>
    perform((now) => {
      const name = deeds.eventName(now);
      return { deed: deeds.newEvent(now, name), paths: [`script.${name}`] };
    });

  return {
    looker, lanes, veil, setVeil, chosen, choose, tool, setTool, items, routeOf, attempt, event,
    move, turn: (item: Item, heading: number) => perform((now) => ofItem(now, item, (it) => deeds.turnedTo(now, it, heading))),
    point, handle, anew, pull, takeOut, enough, back, copy, paste, duplicate, remove, nudge,
    undo: turning("undo"), redo: turning("redo"), isEmpty: chosen.length === 0, canPaste: () => clipboard.length > 0,
  };
}

const made = (deed: Deed | undefined): Made | undefined => deed && { deed };
/** Items as they are now. */
const same = (now: Editing, items: readonly Item[]): Item[] => now.items.filter(({ path }) => items.some((item) => item.path === path));
const ofItem = (now: Editing, item: Item, make: (item: Item) => Deed | undefined): Made | undefined => {
  const [found] = same(now, [item]);
  return found && made(make(found));
};
const one = ({ deed, path }: { deed: Deed; path: string }): Made => ({ deed, paths: [path] });

const spot = ({ road, lane, foot }: NonNullable<ReturnType<typeof onLane>>) => ({ road, lane, offset: foot.along });

/** Strokes of the arrow keys that come close together are one step. */
const CALM_MS = 350;

function useNudge(act: (dx: number, dy: number) => void) {
  const latest = useRef(act);
  latest.current = act;
  const waiting = useRef({ dx: 0, dy: 0, timer: undefined as ReturnType<typeof setTimeout> | undefined });
  return (dx: number, dy: number) => {
    const sum = waiting.current;
    clearTimeout(sum.timer);
    sum.dx += dx;
    sum.dy += dy;
    sum.timer = setTimeout(() => {
      latest.current(sum.dx, sum.dy);
      waiting.current = { dx: 0, dy: 0, timer: undefined };
    }, CALM_MS);
  };
}
