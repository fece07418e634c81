/** Looking at a plan from above: which part of the ground the screen shows. North is up. */

/** The ground's point in the middle of the screen [m], and how many pixels a metre takes. */
export interface View {
  x: number;
  y: number;
  scale: number;
}

export interface Size {
  width: number;
  height: number;
}

export interface Point {
  x: number;
  y: number;
}

/** x0, y0, x1, y1 [m]. */
export type Bounds = readonly [number, number, number, number];

/** A whole city on the screen, and a few lanes on the screen [px/m]. */
export const SCALES = { least: 0.02, most: 60 };

const limited = (scale: number) => Math.min(SCALES.most, Math.max(SCALES.least, scale));

/** Where a point of the ground is on the screen [px]. */
export const toScreen = ({ x, y, scale }: View, { width, height }: Size, point: Point): Point => ({
  x: width / 2 + (point.x - x) * scale,
  y: height / 2 - (point.y - y) * scale,
});

/** The point of the ground under a point of the screen [m]. */
export const toGround = ({ x, y, scale }: View, { width, height }: Size, point: Point): Point => ({
  x: x + (point.x - width / 2) / scale,
  y: y - (point.y - height / 2) / scale,
});

/** After a drag by so many pixels, the ground goes with the pointer. */
export const dragged = (view: View, dx: number, dy: number): View => ({
  ...view,
  x: view.x - dx / view.scale,
  y: view.y + dy / view.scale,
});

/** Larger or smaller by a factor; what is under the pointer stays there. */
export function zoomed(view: View, size: Size, factor: number, at: Point): View {
  const scale = limited(view.scale * factor);
  const held = toGround(view, size, at);
  return {
    x: held.x - (at.x - size.width / 2) / scale,
    y: held.y + (at.y - size.height / 2) / scale,
    scale,
  };
}

/** Two points that were held on the screen are where they are now, as far as that is possible without turning. */
export function pinched(view: View, size: Size, before: readonly [Point, Point], after: readonly [Point, Point]): View {
  const apart = ([one, other]: readonly [Point, Point]) => Math.max(1, Math.hypot(other.x - one.x, other.y - one.y));
  const middle = ([one, other]: readonly [Point, Point]) => ({ x: (one.x + other.x) / 2, y: (one.y + other.y) / 2 });
  const [from, to] = [middle(before), middle(after)];
  return zoomed(dragged(view, to.x - from.x, to.y - from.y), size, apart(after) / apart(before), to);
}

/** All of these bounds, with a margin around them [px]. */
export function fitted([x0, y0, x1, y1]: Bounds, { width, height }: Size, margin = 24): View {
  const across = Math.max(1, width - 2 * margin) / Math.max(1, x1 - x0);
  const along = Math.max(1, height - 2 * margin) / Math.max(1, y1 - y0);
  return { x: (x0 + x1) / 2, y: (y0 + y1) / 2, scale: limited(Math.min(across, along)) };
}

/** The part of the ground that is seen, and a margin around it [px]. */
export function seen({ x, y, scale }: View, { width, height }: Size, margin = 0): Bounds {
  const [across, along] = [(width / 2 + margin) / scale, (height / 2 + margin) / scale];
  return [x - across, y - along, x + across, y + along];
}

/** Whether two bounds have a point in common. */
export const meet = (one: Bounds, other: Bounds): boolean =>
  one[0] <= other[2] && other[0] <= one[2] && one[1] <= other[3] && other[1] <= one[3];

/** A round length that fits into so many pixels: 1, 2 or 5 times a power of ten [m]. */
export function scaleBar(scale: number, most = 120): { metres: number; pixels: number; label: string } {
  const longest = most / scale;
  const power = 10 ** Math.floor(Math.log10(longest));
  const metres = (([5, 2].find((digit) => digit * power <= longest) ?? 1) * power);
  const label = metres >= 1000 ? `${metres / 1000} km` : metres >= 1 ? `${metres} m` : `${Math.round(metres * 100)} cm`;
  return { metres, pixels: metres * scale, label };
}
