/** The keys of the editor; what is typed into a field, or belongs to a dialog, is none of them. */

import { useEffect, useRef } from "react";

export interface Keys {
  undo: () => void;
  redo: () => void;
  copy: () => void;
  paste: () => void;
  duplicate: () => void;
  delete: () => void;
  all: () => void;
  focus: () => void;
  measure: () => void;
  names: () => void;
  route: () => void;
  scene: () => void;
  escape: () => void;
  enough: () => void;
  /** To the east and to the north [m]. */
  nudge: (dx: number, dy: number) => void;
}

const WITH_CTRL: Record<string, keyof Keys> = { z: "undo", y: "redo", c: "copy", v: "paste", d: "duplicate", a: "all" };
const PLAIN: Record<string, keyof Keys> = {
  Delete: "delete", Backspace: "delete", f: "focus", m: "measure", n: "names", r: "route", "3": "scene", Escape: "escape",
};
export const ARROWS: Record<string, [number, number]> = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
/** How far a stroke of an arrow key moves what is chosen, and with Shift [m]. */
export const STEP = { fine: 0.5, coarse: 5 };

/** A field takes its own keys, and a list or a menu its arrows. */
function isTyped({ target, key }: KeyboardEvent): boolean {
  if (!(target instanceof HTMLElement)) return false;
  if (target.closest("input, textarea, select, [contenteditable=true], [role=dialog], [role=menu]")) return true;
  return (key === "Enter" || key === " ") && target.closest("button, a") !== null;
}

export function useKeys(keys: Keys): void {
  const latest = useRef(keys);
  latest.current = keys;
  useEffect(() => {
    const listen = (event: KeyboardEvent) => {
      if (event.defaultPrevented || event.altKey || isTyped(event)) return;
      if (act(event, latest.current)) event.preventDefault();
    };
    window.addEventListener("keydown", listen);
    return () => window.removeEventListener("keydown", listen);
  }, []);
}

/** Whether the key was one of ours. */
function act(event: KeyboardEvent, keys: Keys): boolean {
  const call = (name: keyof Keys | undefined) => {
    if (name === undefined || name === "nudge") return false;
    keys[name]();
    return true;
  };
  if (event.ctrlKey || event.metaKey) {
    const key = event.key.toLowerCase();
    return call(key === "z" && event.shiftKey ? "redo" : WITH_CTRL[key]);
  }
  const arrow = ARROWS[event.key];
  if (arrow) {
    const step = event.shiftKey ? STEP.coarse : STEP.fine;
    keys.nudge(arrow[0] * step, arrow[1] * step);
    return true;
  }
  if (event.key === "Enter") return call("enough");
  return call(PLAIN[event.key.length === 1 ? event.key.toLowerCase() : event.key]);
}
