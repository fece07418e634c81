/** Layers: what can be drawn over the scene, and how each is called. */

import type { Server } from "./run";

export type Layers = Server["Layers"];

interface Layer {
  name: string;
  label: string;
  /** What the menu says of it. */
  about: string;
  /** Whether there is nothing of it before something has been run. */
  needsRun: boolean;
}

export const LAYERS: readonly Layer[] = [
  { name: "names", label: "Names", about: "of traffic only when it is near", needsRun: false },
  { name: "gaps", label: "Gaps to the car ahead", about: "bumper to bumper", needsRun: true },
  { name: "ghosts", label: "Lines to ghosts", about: "from each car to the same one of the other runs, with the distance", needsRun: true },
  { name: "sensors", label: "Sensors and what they see", about: "their fields, and a diamond for each target", needsRun: true },
  { name: "messages", label: "Messages", about: "an arc from sender to receiver; lost ones are dashed and crossed out", needsRun: true },
  { name: "paths", label: "Planned ways", about: "where everybody will be within 4 s", needsRun: true },
  { name: "trails", label: "Trails", about: "of the last 5 s", needsRun: true },
  { name: "speed", label: "Speed as colour", about: "0 to 40 m/s", needsRun: true },
  { name: "lamps", label: "Brake lights and indicators", about: "cars have no indicators: they are shown where a way bends", needsRun: true },
  { name: "notices", label: "Notices to the driver", about: "what applications show", needsRun: true },
];

/** What is drawn until somebody has chosen. */
export const USUAL: readonly string[] = ["names", "lamps", "notices"];

/** With a layer more, or less; in the order of the menu. */
export const toggled = (on: readonly string[], name: string): string[] =>
  LAYERS.map((each) => each.name).filter((each) => (each === name ? !on.includes(name) : on.includes(each)));

/** Why nothing of a layer is drawn; empty when it is. */
export function whyNot(name: string, running: boolean, missing: Readonly<Record<string, string>>): string {
  const { needsRun } = LAYERS.find((each) => each.name === name) ?? { needsRun: true };
  if (needsRun && !running) return "nothing of it before a run";
  return missing[name] ?? "";
}
