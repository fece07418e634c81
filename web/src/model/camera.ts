/** How somebody looks at the scene, as a link says it: free, or after a car, which is named and not numbered. */

export type Seen = "free" | "top" | "chase" | "driver";

export interface Camera {
  view: Seen;
  /** The car that is followed; empty when none is. */
  vehicle: string;
  /** Which way it looks [rad]: of a car that is followed from behind it, else from the north of the picture; and how steeply, from above. */
  azimuth: number;
  polar: number;
  /** [m] */
  distance: number;
  /** What it looks at, in the frame of the picture [m]; nothing where a car is followed. */
  at?: readonly [number, number, number];
}

const SEEN: readonly string[] = ["free", "top", "chase", "driver"] satisfies Seen[];

/** A camera as a part of an address. */
export const cameraText = ({ view, vehicle, azimuth, polar, distance, at = [0, 0, 0] }: Camera): string =>
  [view, encodeURIComponent(vehicle), ...[azimuth, polar, distance, ...(vehicle ? [] : at)].map((each) => Number(each.toFixed(3)))].join(",");

/** The camera that an address says; none where it says none. */
export function cameraOf(text: string | undefined): Camera | undefined {
  const [view = "", vehicle = "", ...rest] = (text ?? "").split(",");
  const numbers = rest.map(Number);
  const [azimuth, polar, distance, x, y, z] = numbers as [number, number, number, number, number, number];
  const whole = SEEN.includes(view) && numbers.length === (vehicle ? 3 : 6) && numbers.every(Number.isFinite) && distance > 0;
  if (!whole) return undefined;
  const how = { view: view as Seen, azimuth, polar, distance };
  return vehicle ? { ...how, vehicle: decoded(vehicle) } : { ...how, vehicle: "", at: [x, y, z] };
}

function decoded(text: string): string {
  try {
    return decodeURIComponent(text);
  } catch {
    return text;
  }
}
