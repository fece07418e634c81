/** What a run is measured by, in the server's words. */

import type { Server } from "./run";
import { words } from "./units";

export type Measure = Server["Measure"];

/** What a metric is called; one that the server does not know any more is called by its name. */
export const titleOf = (name: string, known: readonly Measure[]): string =>
  known.find((each) => each.name === name)?.title ?? words(name);

/** What exactly is measured, and the name by which goals and sweeps call it. */
export function explained(name: string, known: readonly Measure[]): string {
  const explanation = known.find((each) => each.name === name)?.explanation;
  return explanation ? `${explanation} (${name})` : name;
}
