/** The marks of findings: their shapes and colours, the same on the plan, in the table and in the legend. */

import { type Finding, type Mark, worst } from "../model/finding";
import type { PlanLane } from "../model/map";
import type { Cluster } from "../model/picking";
import { type Size, toScreen, type View } from "../model/view";
import { toMetres } from "./ground";

/** Shapes on a grid from -8 to 8, so that the colour is not the only difference. */
export const SHAPES: Record<Mark, string> = {
  low: "M0 -7.5L7.5 6H-7.5Z",
  medium: "M0 -7.5L7.5 0L0 7.5L-7.5 0Z",
  high: "M6.5 0A6.5 6.5 0 1 1 -6.5 0A6.5 6.5 0 1 1 6.5 0Z",
  skipped: "M-6 -6H6V6H-6Z",
  corrected: "M7 0A7 7 0 1 1 -7 0A7 7 0 1 1 7 0Z",
};

/** What is drawn on a shape in its second colour. */
export const SIGNS: Record<Mark, string> = {
  low: "",
  medium: "",
  high: "",
  skipped: "M-3 -3L3 3M3 -3L-3 3",
  corrected: "M-3 0L-1 2.5L3.5 -2.5",
};

/** After Okabe and Ito, "Color Universal Design" (2008), which colour-blind readers tell apart. */
export const MARK_COLOURS: Record<Mark, string> = {
  low: "#d55e00",
  medium: "#e69f00",
  high: "#009e73",
  skipped: "#6b5fb5",
  corrected: "#0072b2",
};

const RIM = "#ffffff";
const LIGHT_ON_DARK = new Set<Mark>(["low", "skipped", "corrected", "high"]);

let shapes: Record<Mark, Path2D> | undefined;
let signs: Record<Mark, Path2D> | undefined;

const paths = (texts: Record<Mark, string>) =>
  Object.fromEntries(Object.entries(texts).map(([mark, text]) => [mark, new Path2D(text)])) as Record<Mark, Path2D>;

export interface Shown {
  clusters: readonly Cluster<Finding>[];
  selected: Finding | undefined;
  hovered: Finding | undefined;
  /** The lanes of the road that is selected. */
  lanes: readonly PlanLane[];
}

/** Draw the selected road, and the marks over it. */
export function paintMarks(context: CanvasRenderingContext2D, what: Shown, view: View, size: Size, ratio: number): void {
  toMetres(context, view, size, ratio);
  paintLanes(context, what.lanes, view);
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  for (const cluster of what.clusters) {
    const at = toScreen(view, size, cluster);
    if (at.x < -20 || at.y < -20 || at.x > size.width + 20 || at.y > size.height + 20) continue;
    const [only] = cluster.members;
    if (cluster.members.length > 1 || !only) paintCluster(context, at, worst(cluster.members), cluster.members.length);
    else if (only !== what.selected) paintMark(context, at, only.mark, 1);
  }
  if (what.hovered && what.hovered !== what.selected) paintMark(context, toScreen(view, size, what.hovered), what.hovered.mark, 1.25);
  if (what.selected) paintSelected(context, toScreen(view, size, what.selected), what.selected.mark);
  context.setTransform(1, 0, 0, 1, 0, 0);
}

function paintLanes(context: CanvasRenderingContext2D, lanes: readonly PlanLane[], view: View): void {
  context.strokeStyle = "rgba(28, 126, 214, 0.55)";
  context.lineCap = "butt";
  for (const { centre, width } of lanes) {
    context.lineWidth = Math.max(width, 4 / view.scale);
    context.beginPath();
    centre.forEach(([x, y], at) => (at === 0 ? context.moveTo(x, y) : context.lineTo(x, y)));
    context.stroke();
  }
}

function paintMark(context: CanvasRenderingContext2D, { x, y }: { x: number; y: number }, mark: Mark, scale: number): void {
  shapes ??= paths(SHAPES);
  signs ??= paths(SIGNS);
  context.save();
  context.translate(x, y);
  context.scale(scale, scale);
  context.fillStyle = MARK_COLOURS[mark];
  context.strokeStyle = RIM;
  context.lineWidth = 1.5;
  context.lineJoin = "round";
  context.fill(shapes[mark]);
  context.stroke(shapes[mark]);
  context.stroke(signs[mark]);
  context.restore();
}

function paintCluster(context: CanvasRenderingContext2D, { x, y }: { x: number; y: number }, mark: Mark, count: number): void {
  const radius = count < 10 ? 9 : count < 100 ? 12 : 15;
  context.beginPath();
  context.arc(x, y, radius, 0, 2 * Math.PI);
  context.fillStyle = MARK_COLOURS[mark];
  context.strokeStyle = RIM;
  context.lineWidth = 1.5;
  context.fill();
  context.stroke();
  context.fillStyle = LIGHT_ON_DARK.has(mark) ? "#ffffff" : "#1f1f1f";
  context.font = '600 11px system-ui, -apple-system, "Segoe UI", sans-serif';
  context.textAlign = "center";
  context.textBaseline = "middle";
  context.fillText(String(count), x, y + 0.5);
}

function paintSelected(context: CanvasRenderingContext2D, at: { x: number; y: number }, mark: Mark): void {
  context.beginPath();
  context.arc(at.x, at.y, 15, 0, 2 * Math.PI);
  context.fillStyle = "rgba(28, 126, 214, 0.25)";
  context.strokeStyle = "#1c7ed6";
  context.lineWidth = 2.5;
  context.fill();
  context.stroke();
  paintMark(context, at, mark, 1.25);
}
