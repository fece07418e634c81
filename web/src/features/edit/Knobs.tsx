/** The points of a shape for the keyboard: arrows move one, Delete takes it out, Enter makes a corner of the middle of an edge. */

import type { KeyboardEvent } from "react";
import type { Item } from "../../model/editing/item";
import { type Knob, nameOf } from "../../model/editing/shape";
import type { Point } from "../../model/view";
import classes from "./Edit.module.css";
import { ARROWS, STEP } from "./keys";

interface Props {
  held: readonly { item: Item; knob: Knob }[];
  /** Where a place on the ground is on the screen. */
  place: (point: Point) => Point;
  onPull: (item: Item, knob: Knob, to: Point) => void;
  onTakeOut: (item: Item, knob: Knob) => void;
}

export function Knobs({ held, place, onPull, onTakeOut }: Props) {
  const onKey = (item: Item, knob: Knob) => (event: KeyboardEvent) => {
    if (!act(event, knob, (to) => onPull(item, knob, to), () => onTakeOut(item, knob))) return;
    // The whole thing is neither moved nor deleted by it.
    event.preventDefault();
    event.stopPropagation();
  };
  return held.map(({ item, knob }) => {
    const { x, y } = place(knob);
    return (
      <button
        key={`${item.path} ${knob.is} ${knob.number}`}
        type="button"
        className={classes.knob}
        data-knob={`${knob.is} ${knob.number}`}
        aria-label={nameOf(knob, item)}
        title="Arrow keys move it"
        style={{ left: x, top: y }}
        onKeyDown={onKey(item, knob)}
      />
    );
  });
}

/** Whether the key was one for the point. */
function act({ key, shiftKey, ctrlKey, metaKey }: KeyboardEvent, knob: Knob, pull: (to: Point) => void, takeOut: () => void): boolean {
  if (ctrlKey || metaKey) return false;
  const [east, north] = ARROWS[key] ?? [];
  const step = shiftKey ? STEP.coarse : STEP.fine;
  if (east !== undefined && north !== undefined) pull({ x: knob.x + east * step, y: knob.y + north * step });
  else if (knob.is === "corner" && (key === "Delete" || key === "Backspace")) takeOut();
  else if (knob.is === "edge" && (key === "Enter" || key === " ")) pull(knob);
  else return false;
  return true;
}
