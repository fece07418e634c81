/** Keyboard shortcuts: one key, or two in a row such as `g r`. */

import { useEffect, useRef } from "react";

const PAUSE_MS = 900;
const NONE = { key: "", at: Number.NEGATIVE_INFINITY };
let previous = NONE;
let pressed = NONE;

/** Whether the focus came where it is by the tab key, not by the pointer. */
let tabbed = false;

/** A key that belongs to what has the focus, such as text to a field, is no shortcut. */
function isTaken(target: EventTarget | null, key: string): boolean {
  if (!(target instanceof HTMLElement)) return false;
  if (target.isContentEditable || target.closest("textarea, [role=dialog]")) return true;
  // A letter chooses in a select; space must not, because it means run and pause.
  if (target instanceof HTMLSelectElement) return /^[\p{L}\p{N}]$/u.test(key);
  if (!(target instanceof HTMLInputElement)) return false;
  if (!WITHOUT_TEXT.has(target.type)) return true;
  // Somebody without a mouse has only the space bar to tick a box.
  return key === " " && target.type === "checkbox" && tabbed;
}

const WITHOUT_TEXT = new Set(["checkbox", "radio", "button", "submit", "reset", "range", "color"]);

/** Some browsers press the focused control when the key goes up again, whatever became of its way down. */
function letGo({ target, key }: KeyboardEvent): void {
  if (key === " " && target instanceof HTMLElement && target !== document.body) target.blur();
}

/** Call the handler of the key, or of the pair that ends with it. */
export function dispatch(event: KeyboardEvent, handlers: Record<string, () => void>, now: number): void {
  if (
    event.defaultPrevented ||
    event.ctrlKey ||
    event.metaKey ||
    event.altKey ||
    isTaken(event.target, event.key)
  )
    return;
  const pair = now - previous.at < PAUSE_MS ? `${previous.key} ${event.key}` : "";
  const handler = handlers[pair] ?? (pairStarted(now) ? undefined : handlers[event.key]);
  if (!handler) return;
  event.preventDefault();
  letGo(event);
  handler();
}

/** After `g`, the next key is the second half of a pair and nothing else. */
const pairStarted = (now: number): boolean => previous.key === "g" && now - previous.at < PAUSE_MS;

/** Remember the key for pairs; in the capture phase, so before any `dispatch` of the same event. */
function remember({ key, timeStamp }: KeyboardEvent): void {
  previous = pressed;
  pressed = { key, at: timeStamp };
  if (key === "Tab") tabbed = true;
}

window.addEventListener("keydown", remember, { capture: true });
window.addEventListener(
  "pointerdown",
  () => {
    tabbed = false;
  },
  { capture: true },
);

/** Listen to these keys while the component is mounted and `enabled`. */
export function useShortcuts(handlers: Record<string, () => void>, enabled = true): void {
  const latest = useRef(handlers);
  latest.current = handlers;
  useEffect(() => {
    if (!enabled) return;
    const listen = (event: KeyboardEvent) => dispatch(event, latest.current, event.timeStamp);
    window.addEventListener("keydown", listen);
    return () => window.removeEventListener("keydown", listen);
  }, [enabled]);
}

/** Ctrl+Z takes the last change back, Ctrl+Y or Ctrl+Shift+Z makes it again, but not while one types: a field has its own. */
export function useUndoKeys(undo: () => void, redo: () => void): void {
  const latest = useRef({ z: undo, y: redo, Z: redo });
  latest.current = { z: undo, y: redo, Z: redo };
  useEffect(() => {
    const listen = (event: KeyboardEvent) => {
      const key = event.key.toLowerCase() === "z" && event.shiftKey ? "Z" : event.key.toLowerCase();
      const act = latest.current[key as keyof typeof latest.current];
      if (!act || !(event.ctrlKey || event.metaKey) || event.altKey || (event.shiftKey && key !== "Z")) return;
      if (event.defaultPrevented || isTaken(event.target, "z")) return;
      event.preventDefault();
      act();
    };
    window.addEventListener("keydown", listen);
    return () => window.removeEventListener("keydown", listen);
  }, []);
}

/** Ctrl+S saves what is edited and not the page, wherever the focus is; while a dialog is open it belongs to that. */
export function useSaveKey(save: () => void): void {
  const latest = useRef(save);
  latest.current = save;
  useEffect(() => {
    const listen = (event: KeyboardEvent) => {
      if (!(event.ctrlKey || event.metaKey) || event.altKey || event.shiftKey || event.key.toLowerCase() !== "s") return;
      event.preventDefault();
      const asks = event.target instanceof HTMLElement && event.target.closest("[role=dialog]");
      if (!event.repeat && !asks) latest.current();
    };
    window.addEventListener("keydown", listen);
    return () => window.removeEventListener("keydown", listen);
  }, []);
}
