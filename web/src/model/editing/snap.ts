/** Where something may be put on the lanes of a map. */

import type { PlanLane } from "../map";
import { pickStrip, type Strip } from "../picking";
import type { Point } from "../view";
import { type Foot, foot } from "./line";

export type Lane = PlanLane & Strip;

/** A place on a lane. */
export interface OnLane {
  road: string;
  lane: number;
  foot: Foot;
}

/** The nearest place on a lane, at most `reach` beside its edge [m]. */
export function onLane(lanes: readonly Lane[], point: Point, reach = 3): OnLane | undefined {
  const found = pickStrip(lanes, point, reach);
  const at = found && foot(found.centre, point);
  return found && at ? { road: found.road, lane: found.index, foot: at } : undefined;
}
