/** What is under the pointer, and what is in a rectangle. */

import type { Bounds, Point } from "../view";
import type { Figure, Item } from "./item";
import { corners, foot, inside } from "./line";

/** What lies on top is hit first. */
const ORDER: Record<Figure["shape"], number> = { body: 0, point: 0, line: 1, patch: 2, area: 3 };

/** The item under a point; thin ones are hit within `reach` [m]. Routes are hit only when nothing else is. */
export function hit(items: readonly Item[], point: Point, reach: number): Item | undefined {
  const found = items
    .flatMap((item) => item.figures.filter((figure) => isHit(figure, point, reach)).map((figure) => ({ item, figure })))
    .sort((a, b) => ORDER[a.figure.shape] - ORDER[b.figure.shape]);
  return found[0]?.item;
}

function isHit(figure: Figure, point: Point, reach: number): boolean {
  const { x, y, heading = 0, length = 0, width = 0, line = [] } = figure;
  switch (figure.shape) {
    case "body":
      return inside(corners(x ?? 0, y ?? 0, heading, Math.max(length, 2 * reach), Math.max(width, 2 * reach)), point);
    case "point":
      return Math.hypot((x ?? 0) - point.x, (y ?? 0) - point.y) <= Math.max(1.5, reach);
    case "line":
      return Math.abs(foot(line, point)?.left ?? Number.POSITIVE_INFINITY) <= reach && away(figure, point) <= reach;
    default:
      return inside(line, point);
  }
}

function away({ line = [] }: Figure, point: Point): number {
  const near = foot(line, point);
  return near ? Math.hypot(near.x - point.x, near.y - point.y) : Number.POSITIVE_INFINITY;
}

/** The place of an item on the plan; none of what lies nowhere. */
export function placeOf({ figures }: Item): Point | undefined {
  const [figure] = figures;
  if (!figure) return undefined;
  if (figure.shape === "body" || figure.shape === "point") return { x: figure.x ?? 0, y: figure.y ?? 0 };
  return middle(figure.line ?? []);
}

function middle(line: readonly (readonly [number, number])[]): Point | undefined {
  if (line.length === 0) return undefined;
  const sum = line.reduce(([x, y], [u, v]) => [x + u, y + v] as [number, number], [0, 0] as [number, number]);
  return { x: sum[0] / line.length, y: sum[1] / line.length };
}

/** Everything but routes whose place lies in a rectangle. */
export const within = (items: readonly Item[], [x0, y0, x1, y1]: Bounds): Item[] =>
  items.filter((item) => {
    const at = item.group === "route" ? undefined : placeOf(item);
    return at !== undefined && at.x >= x0 && at.x <= x1 && at.y >= y0 && at.y <= y1;
  });

/** The bounds of what is to be looked at [m]. */
export function boundsOfItems(items: readonly Item[]): Bounds | undefined {
  const points = items.flatMap(({ figures }) =>
    figures.flatMap(({ shape, x = 0, y = 0, line = [] }) => (shape === "body" || shape === "point" ? [[x, y] as [number, number]] : line)),
  );
  if (points.length === 0) return undefined;
  const [xs, ys] = [points.map(([x]) => x), points.map(([, y]) => y)];
  return [Math.min(...xs), Math.min(...ys), Math.max(...xs), Math.max(...ys)];
}
