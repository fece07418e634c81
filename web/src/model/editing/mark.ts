/** What the 3D scene and the editor tell each other: what the pointer has done, and what is marked over the scene. */

import type { Point } from "../view";
import type { Place, Ray } from "./sight";

/** What the pointer has done; the frame does nothing with it where the answer is yes. */
export interface Question {
  phase: "down" | "move" | "up" | "click" | "menu" | "leave" | "cancel";
  ray: Ray;
  /** On the frame [px]. */
  at: Point;
  add: boolean;
  /** Where a place is on the frame [px], and how far before the eye. */
  spot: (place: Place) => readonly [number, number, number] | null;
}

/** Lines, points to take hold of and words over the scene, and in words what they are. */
export interface Marks {
  lines: { points: Place[]; closed: boolean; strong: boolean; filled: boolean }[];
  knobs: Place[];
  words: { at: Place; text: string; strong: boolean }[];
  told: string;
  /** Two corners of a rectangle that is being drawn on the frame [px]. */
  rectangle?: readonly [Point, Point] | undefined;
}
