/** What a ray of sight meets: in the 3D scene a thing is pointed at above the ground that lies behind it. */

import type { Point } from "../view";
import { hit } from "./hit";
import type { Figure, Item } from "./item";

export type Place = readonly [number, number, number];

/** From the eye [m] along a direction, in the frame of the map with z up. */
export interface Ray {
  from: Place;
  along: Place;
}

/** Farther away nothing is put down: a look to the horizon is none at a place [m]. */
const FARTHEST = 3000;
/** What is thin is met within so much of its distance: about seven pixels. */
const REACH = 0.006;
/** So high at least is what one may point at [m]. */
const LEAST = 0.6;

/** The place at a height that a ray comes to from above [m]. */
export function onLevel({ from, along }: Ray, height: number): Point | undefined {
  const far = (height - from[2]) / along[2];
  if (!(far > 0) || far * Math.hypot(...along) > FARTHEST) return undefined;
  return { x: from[0] + far * along[0], y: from[1] + far * along[1] };
}

/**
 * How far along a ray, in lengths of its direction, it comes into a body; nothing where it passes it: between the entries into its three
 * pairs of faces and the exits (T. L. Kay, J. T. Kajiya, Ray Tracing Complex Scenes, 1986).
 */
export function intoBody({ from, along }: Ray, figure: Figure): number | undefined {
  const { x, y, heading, length, width, height, lift } = figure;
  const [c, s] = [Math.cos(heading), Math.sin(heading)];
  const [dx, dy, dz] = [from[0] - x, from[1] - y, from[2] - lift];
  const reach = REACH * Math.hypot(dx, dy, dz);
  const spans = [
    slab(c * dx + s * dy, c * along[0] + s * along[1], -Math.max(length / 2, reach), Math.max(length / 2, reach)),
    slab(c * dy - s * dx, c * along[1] - s * along[0], -Math.max(width / 2, reach), Math.max(width / 2, reach)),
    slab(dz, along[2], 0, Math.max(height, LEAST, reach)),
  ];
  const enter = Math.max(0, ...spans.map(([start]) => start));
  return enter <= Math.min(...spans.map(([, end]) => end)) ? enter : undefined;
}

/** From where to where something that starts at `at` and goes `by` is between two bounds. */
function slab(at: number, by: number, low: number, high: number): [number, number] {
  if (by === 0) return at >= low && at <= high ? [Number.NEGATIVE_INFINITY, Number.POSITIVE_INFINITY] : [1, 0];
  const [one, other] = [(low - at) / by, (high - at) / by];
  return [Math.min(one, other), Math.max(one, other)];
}

/** The height of the road that an item lies on, above the land [m]. */
export const liftOf = ({ figures }: Item): number => figures[0]?.lift ?? 0;

/** What a ray meets, and at what height it is taken hold of [m]. */
export interface Seen {
  item: Item;
  height: number;
}

/** What a ray meets first: of the bodies the nearest, else what lies on the ground. */
export function seen(items: readonly Item[], ray: Ray): Seen | undefined {
  const met = items.flatMap((item) =>
    item.figures.flatMap((figure) => {
      const far = figure.shape === "body" ? intoBody(ray, figure) : undefined;
      return far === undefined ? [] : [{ item, far, height: ray.from[2] + far * ray.along[2] }];
    }),
  );
  met.sort((one, other) => one.far - other.far);
  return met[0] ?? lying(items, ray);
}

/** What lies where a ray comes to the ground, on whatever height its road is; routes last. */
function lying(items: readonly Item[], ray: Ray): Seen | undefined {
  const flat = items.filter(({ figures }) => figures.some(({ shape }) => shape !== "body"));
  const levels = [...new Set(flat.map(liftOf))].sort((one, other) => other - one);
  const under = (some: readonly Item[], height: number): Seen | undefined => {
    const point = onLevel(ray, height);
    const reach = point ? REACH * Math.hypot(point.x - ray.from[0], point.y - ray.from[1], height - ray.from[2]) : 0;
    const item = point && hit(some.filter((each) => liftOf(each) === height), point, reach);
    return item && { item, height };
  };
  const first = (some: readonly Item[]) => levels.map((level) => under(some, level)).find((found) => found !== undefined);
  return first(flat.filter(({ group }) => group !== "route")) ?? first(flat.filter(({ group }) => group === "route"));
}
