/**
 * How the line of a vehicle of a run is drawn.
 *
 * Of two runs the colour tells the vehicle, as everywhere in the page, and the second run is dashed. Of more the colour tells
 * the run, since no one tells eight ways of dashing apart, and the dashes tell the vehicle.
 */

import { lineColor } from "../../model/palette";

const SECOND = [6, 4];
/** [px] Of the first vehicle that is drawn, the next ones, and so on anew. */
const DASHES: readonly (readonly number[] | undefined)[] = [undefined, [7, 4], [2, 3], [11, 4, 2, 4]];

interface Place {
  /** The place of the run, of so many. */
  place: number;
  of: number;
  /** The place of the vehicle among those that are drawn, and its colour. */
  vehicle: number;
  color: string;
  dark: boolean;
}

export function styleOf({ place, of, vehicle, color, dark }: Place): { color: string; dash?: readonly number[] } {
  const dash = of > 2 ? DASHES[vehicle % DASHES.length] : place === 1 ? SECOND : undefined;
  return { color: of > 2 ? lineColor(place, dark) : color, ...(dash ? { dash } : {}) };
}
