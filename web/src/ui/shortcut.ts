/** Keyboard shortcuts: one key, or two in a row such as `g r`. */

import { useEffect, useRef } from "react";

const PAUSE_MS = 900;
const NONE = { key: "", at: Number.NEGATIVE_INFINITY };
let previous = NONE;
let pressed = NONE;

/** Typing into a field is never a shortcut, and space on a button presses that button. */
function isTyping(target: EventTarget | null, key: string): boolean {
  if (!(target instanceof HTMLElement)) return false;
  if (target.isContentEditable || /^(input|textarea|select)$/i.test(target.tagName))
    return !isCheckbox(target) || key === " ";
  return (key === " " || key === "Enter") && target.closest("button, a, [role=button], summary") !== null;
}

const isCheckbox = (target: HTMLElement): boolean =>
  target instanceof HTMLInputElement && (target.type === "checkbox" || target.type === "radio");

/** Call the handler of the key, or of the pair that ends with it. */
export function dispatch(event: KeyboardEvent, handlers: Record<string, () => void>, now: number): void {
  if (
    event.defaultPrevented ||
    event.ctrlKey ||
    event.metaKey ||
    event.altKey ||
    isTyping(event.target, event.key)
  )
    return;
  const pair = now - previous.at < PAUSE_MS ? `${previous.key} ${event.key}` : "";
  const handler = handlers[pair] ?? (pairStarted(now) ? undefined : handlers[event.key]);
  if (!handler) return;
  event.preventDefault();
  handler();
}

/** After `g`, the next key is the second half of a pair and nothing else. */
const pairStarted = (now: number): boolean => previous.key === "g" && now - previous.at < PAUSE_MS;

/** Remember the key for pairs; in the capture phase, so before any `dispatch` of the same event. */
function remember({ key, timeStamp }: KeyboardEvent): void {
  previous = pressed;
  pressed = { key, at: timeStamp };
}

window.addEventListener("keydown", remember, { capture: true });

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
