/** What the goals of a scenario say about a quantity: the part of its chart where they are missed. */

import type { Json } from "./run";
import { isTree } from "./schema";

/** Values below `least`, or above `most`, miss a goal. */
export interface Band {
  metric: string;
  least?: number;
  most?: number;
}

/** Metrics that are the least or the greatest value of a quantity, so that a goal of theirs is a line in its chart. */
const OF_QUANTITY: Readonly<Record<string, { quantity: string; sign?: -1; bothSides?: true }>> = {
  min_gap: { quantity: "gap" },
  min_time_gap: { quantity: "time_gap" },
  max_deceleration: { quantity: "acceleration", sign: -1 },
  max_lateral_acceleration: { quantity: "lateral_acceleration", bothSides: true },
  max_lateral_offset: { quantity: "lateral_offset", bothSides: true },
};

/** The bands of a quantity by the goals of a scenario; a measure of its own name counts as the metric that it is. */
export function bandsOf(document: Json | undefined, quantity: string): Band[] {
  if (!isTree(document) || !isTree(document.goals)) return [];
  return Object.entries(document.goals).flatMap(([name, goal]) => {
    const about = OF_QUANTITY[kindOf(document.measures, name)];
    if (about?.quantity !== quantity || !isTree(goal) || isOfAPart(document.measures, name)) return [];
    return bands(name, goal.least, goal.most, about);
  });
}

/** Whether a measure looks at a part of the run, or at some vehicles: then its limit is none of the whole chart. */
function isOfAPart(measures: Json | undefined, name: string): boolean {
  const own = isTree(measures) ? measures[name] : undefined;
  if (!isTree(own)) return false;
  return isTree(own.begin) || isTree(own.end) || (Array.isArray(own.vehicles) && own.vehicles.length > 0);
}

const kindOf = (measures: Json | undefined, name: string): string => {
  const own = isTree(measures) ? measures[name] : undefined;
  return isTree(own) && typeof own.kind === "string" ? own.kind : name;
};

function bands(metric: string, least: Json | undefined, most: Json | undefined, { sign, bothSides }: { sign?: -1; bothSides?: true }): Band[] {
  const low = typeof least === "number" ? least : undefined;
  const high = typeof most === "number" ? most : undefined;
  if (bothSides) return high === undefined ? [] : [{ metric, least: -high, most: high }];
  const [from, to] = sign ? [negative(high), negative(low)] : [low, high];
  return from === undefined && to === undefined
    ? []
    : [{ metric, ...(from === undefined ? {} : { least: from }), ...(to === undefined ? {} : { most: to }) }];
}

const negative = (value: number | undefined) => (value === undefined ? undefined : -value);
