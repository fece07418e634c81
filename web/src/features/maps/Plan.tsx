/** The place from above: a canvas that is moved and enlarged, with its scale, its north and its source. */

import { ActionIcon, Tooltip } from "@mantine/core";
import { type KeyboardEvent, type RefObject, useEffect, useMemo, useRef, useState } from "react";
import { groundOf } from "../../charts/ground";
import { type Picked, PlanPicture } from "../../charts/PlanPicture";
import type { Finding } from "../../model/finding";
import type { Plan as PlanData, PlanLane } from "../../model/map";
import { scaleBar, type View } from "../../model/view";
import { useDark } from "../../ui/dark";
import { Icon, type IconName } from "../../ui/Icon";
import { useShortcuts } from "../../ui/shortcut";
import classes from "./Maps.module.css";

interface Props {
  plan: PlanData;
  findings: readonly Finding[];
  selected: Finding | undefined;
  road: string | undefined;
  picture: RefObject<PlanPicture | undefined>;
  onPick: (picked: Picked) => void;
}

/** How much one press of a button or key enlarges. */
const STEP = 1.5;

export function Plan({ plan, findings, selected, road, picture, onPick }: Props) {
  const canvas = useRef<HTMLCanvasElement>(null);
  const bar = useRef<HTMLSpanElement>(null);
  const [hover, setHover] = useState<Picked>();
  const dark = useDark();
  const ground = useMemo(() => groundOf(plan), [plan]);
  const latest = useRef(onPick);
  latest.current = onPick;

  useEffect(() => {
    const made = new PlanPicture(canvas.current as HTMLCanvasElement, {
      onView: (view) => showScale(bar.current, view),
      onPick: (picked) => latest.current(picked),
      onHover: setHover,
    });
    picture.current = made;
    return () => {
      made.close();
      picture.current = undefined;
    };
  }, [picture]);
  useEffect(
    () => picture.current?.show({ ground, lanes: plan.lanes, findings, selected, road, dark }),
    [picture, ground, plan.lanes, findings, selected, road, dark],
  );

  const larger = () => picture.current?.zoom(STEP);
  const smaller = () => picture.current?.zoom(1 / STEP);
  const fit = () => picture.current?.fit();
  useShortcuts({ "+": larger, "=": larger, "-": smaller, f: fit, F: fit });
  const onKey = (event: KeyboardEvent) => {
    const step = STEPS[event.key];
    if (!step || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    event.stopPropagation();
    picture.current?.step(...step);
  };
  return (
    <div className={classes.plan}>
      <canvas
        ref={canvas}
        className={classes.canvas}
        data-testid="plan"
        tabIndex={0}
        role="img"
        aria-label="The map from above. Arrow keys move it, plus and minus enlarge and reduce it, f shows all of it."
        onKeyDown={onKey}
      />
      <Hover hover={hover} plan={plan} />
      <div className={classes.zoom}>
        <Press icon="plus" label="Enlarge (+)" onClick={larger} />
        <Press icon="minus" label="Reduce (−)" onClick={smaller} />
        <Press icon="fit" label="Show all of the map (f)" onClick={fit} />
      </div>
      <North />
      <span className={classes.scale} aria-hidden="true">
        <span ref={bar} className={classes.bar} data-testid="scale-bar" />
      </span>
      <span className={classes.attribution} data-testid="map-attribution">
        {plan.attribution}
      </span>
    </div>
  );
}

/** By which share of the screen an arrow key moves: to the right and up. */
const STEPS: Record<string, [number, number]> = {
  ArrowLeft: [-0.15, 0],
  ArrowRight: [0.15, 0],
  ArrowUp: [0, 0.15],
  ArrowDown: [0, -0.15],
};

/** Without React: the view changes with every frame of a drag. */
function showScale(bar: HTMLElement | null, { scale }: View): void {
  if (!bar) return;
  const { pixels, label } = scaleBar(scale);
  bar.style.width = `${pixels}px`;
  bar.textContent = label;
}

function Press({ icon, label, onClick }: { icon: IconName; label: string; onClick: () => void }) {
  return (
    <Tooltip label={label} position="right">
      <ActionIcon size={30} variant="default" aria-label={label} onClick={onClick}>
        <Icon name={icon} />
      </ActionIcon>
    </Tooltip>
  );
}

function North() {
  return (
    <svg className={classes.north} width="26" height="34" viewBox="0 0 26 34" role="img" aria-label="North is up">
      <path d="M13 2l7 20-7-5-7 5z" fill="currentColor" />
      <text x="13" y="33" textAnchor="middle" fontSize="11" fontWeight="700" fill="currentColor">
        N
      </text>
    </svg>
  );
}

/** What the pointer is on. */
function Hover({ hover, plan }: { hover: Picked | undefined; plan: PlanData }) {
  if (!hover) return null;
  return (
    <div className={classes.hover} style={{ left: hover.at.x, top: hover.at.y }} aria-hidden="true">
      {hover.lane ? laneText(hover.lane, plan) : findingText(hover.members)}
    </div>
  );
}

function laneText({ road, width, speed, open }: PlanLane, plan: PlanData): string {
  const found = plan.roads.find(({ id }) => id === road);
  const facts = [`${Math.round(speed * 3.6)} km/h`, `${width.toFixed(2)} m wide`, ...(open ? [] : ["closed to cars"])];
  return `${found?.name || "Road without a name"}: ${facts.join(", ")}`;
}

function findingText(members: readonly Finding[]): string {
  const [only] = members;
  if (members.length === 1 && only) return `${only.kind}: ${only.what}`;
  const kinds = new Map<string, number>();
  for (const { kind } of members) kinds.set(kind, (kinds.get(kind) ?? 0) + 1);
  return [...kinds].map(([kind, count]) => `${count} × ${kind}`).join(", ");
}
