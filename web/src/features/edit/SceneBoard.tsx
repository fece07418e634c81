/** The 3D scene beside the plan: the scenario as it would start, where everything can be chosen, dragged, turned and placed as on the plan. */

import { Button } from "@mantine/core";
import { useQuery } from "@tanstack/react-query";
import { type RefObject, useCallback, useEffect, useImperativeHandle, useMemo, useRef, useState } from "react";
import { board, onBoard } from "../../api/stage";
import type { SceneVehicle } from "../../api/types";
import { offLand } from "../../charts/ground";
import { boundsOfItems } from "../../model/editing/hit";
import { type Editing, type Item, named } from "../../model/editing/item";
import type { Marks, Question } from "../../model/editing/mark";
import { liftOf, type Place } from "../../model/editing/sight";
import type { Plan } from "../../model/map";
import { useDark } from "../../ui/dark";
import { notify } from "../../ui/notify";
import { useBridge, useMap } from "../../api/bridge";
import classes from "./Edit.module.css";
import { Hand, type World } from "./hand";

/** What the page may ask the scene. */
export interface Onlooker {
  focus: (items: readonly Item[]) => void;
  /** Lets go of what is dragged, and nothing changes; whether anything was. */
  cancel: () => boolean;
}

interface Props extends Omit<World, "aloft" | "onGone" | "state"> {
  onlooker: RefObject<Onlooker | null>;
  id: string;
  plan: Plan;
  state: Editing;
}

const NOBODY: SceneVehicle[] = [];
const nothing = () => undefined;

export function SceneBoard(props: Props) {
  const { onlooker, id, plan, state } = props;
  const frame = useRef<HTMLIFrameElement>(null);
  const dark = useDark();
  const stage = useQuery(board);
  const shown = useQuery(onBoard(id, state.revision, stage.data?.number));
  const { refetch } = shown;
  const { ready, send } = useBridge(frame, nothing, useCallback(() => void refetch(), [refetch]));
  const there = useMap(frame, shown.data?.map ?? "");
  const vehicles = shown.data?.vehicles ?? NOBODY;
  const onMenu: Props["onMenu"] = (at, ground, item) => {
    const { left = 0, top = 0 } = frame.current?.getBoundingClientRect() ?? {};
    props.onMenu({ x: left + at.x, y: top + at.y }, ground, item);
  };
  const rectangle = useRef<HTMLDivElement>(null);
  const hand = useHand({ ...props, onMenu }, frame, rectangle, ready, send);

  // A scene that has just come up, or was built again, must be told everything.
  useEffect(() => send({ studio: "theme", dark }), [dark, ready, send]);
  useEffect(() => send({ studio: "cast", cars: vehicles }), [vehicles, ready, send]);
  useImperativeHandle(onlooker, () => ({ cancel: hand.cancel, focus: (items) => lookAt(frame.current, items) }), [hand]);

  const problem = stage.error?.message || (shown.data ? "" : shown.error?.message);
  return (
    <section className={classes.scene} aria-label="Scene of the scenario">
      {stage.data ? <iframe ref={frame} title="3D scene" src={stage.data.place} className={classes.frame} /> : null}
      <div ref={rectangle} className={classes.rectangle} hidden data-testid="rectangle-in-scene" />
      {there && !problem ? (
        <div className={classes.views}>
          <Button size="compact-xs" variant="default" onClick={() => send({ studio: "view", preset: "overview" })}>
            Overview
          </Button>
          <Button size="compact-xs" variant="default" onClick={() => send({ studio: "view", preset: "top" })}>
            From above
          </Button>
        </div>
      ) : (
        <div className={classes.cover} role="status" aria-label="The scene is loading">
          {problem || (shown.data ? "The browser loads the map …" : "The server puts up streets, houses and cars …")}
        </div>
      )}
      <span className={classes.attribution}>{plan.attribution}</span>
    </section>
  );
}

/** The hand, which sees what is there now, and whose marks go to the scene past React, as often as the pointer moves. */
function useHand(props: Props, frame: RefObject<HTMLIFrameElement | null>, rectangle: RefObject<HTMLDivElement | null>, ready: number, send: ReturnType<typeof useBridge>["send"]): Hand {
  const { plan } = props;
  const aloft = useMemo(() => plan.lanes.flatMap(offLand), [plan]);
  const world = useRef<World>(undefined as never);
  world.current = { ...props, aloft, onGone: tellGone };
  const last = useRef("");
  const [hand] = useState(
    () =>
      new Hand(
        () => world.current,
        ({ rectangle: corners, ...marks }) => {
          span(rectangle.current, corners);
          // Only what differs from what was shown last.
          const text = JSON.stringify(marks);
          if (text !== last.current) send({ studio: "marks", marks });
          last.current = text;
        },
      ),
  );
  const { state, items, chosen, locked, tool, names } = props;
  // What is drawn depends on all of them.
  useEffect(() => hand.renew(), [hand, state, items, chosen, locked, tool, names]);
  useEffect(() => {
    // A scene that has just come up, or was built again, knows of no hand and has no marks.
    const found = handIn(frame.current);
    if (found) found.ask = hand.ask;
    if (ready > 1 && hand.cancel()) notify("The scene was lost while something was dragged.", "Nothing was changed: drag it again.", "yellow");
    last.current = "";
    hand.renew();
  }, [hand, frame, ready]);
  useEffect(() => {
    // What is dragged is let go of when the window is left by other means than the pointer.
    const leave = () => hand.cancel();
    addEventListener("pagehide", leave);
    return () => removeEventListener("pagehide", leave);
  }, [hand]);
  return hand;
}

/** Draws the rectangle over the frame, or takes it away. */
function span(element: HTMLElement | null, corners: Marks["rectangle"]): void {
  if (!element) return;
  element.hidden = !corners;
  const [a, b] = corners ?? [];
  if (!a || !b) return;
  const [left, top, width, height] = [Math.min(a.x, b.x), Math.min(a.y, b.y), Math.abs(a.x - b.x), Math.abs(a.y - b.y)];
  Object.assign(element.style, { left: `${left}px`, top: `${top}px`, width: `${width}px`, height: `${height}px` });
}

const tellGone = (items: readonly Item[]) =>
  notify(`${named(items.map(({ path }) => path))} is not there any more.`, "Somebody has deleted it while it was dragged; nothing else was changed.", "yellow");

interface HandFrame extends Window {
  __studioHand?: { ask: ((question: Question) => boolean) | null; look: (place: Place, distance: number) => void };
}

const handIn = (frame: HTMLIFrameElement | null) => (frame?.contentWindow as HandFrame | null)?.__studioHand;

/** [m] */
const NEAREST = 25;

function lookAt(frame: HTMLIFrameElement | null, items: readonly Item[]): void {
  const bounds = boundsOfItems(items.map((item) => ({ ...item, figures: item.figures.map((each) => (each.shape === "body" ? { ...each, line: [] } : each)) })));
  if (!bounds) return;
  const [x0, y0, x1, y1] = bounds;
  const lift = items[0] ? liftOf(items[0]) : 0;
  handIn(frame)?.look([(x0 + x1) / 2, (y0 + y1) / 2, lift], Math.max(NEAREST, 1.2 * Math.hypot(x1 - x0, y1 - y0)));
}
