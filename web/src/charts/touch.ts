/** A chart under fingers: one moves what is zoomed, two draw the time axis apart and together; each keeps the time that it was put on. */

import type uPlot from "uplot";
import type { Span } from "./zoom";

/** A finger, from the left edge of the plot [px], and the time that it holds [s]. */
export interface Held {
  x: number;
  time: number;
}

/** Fingers nearer to each other than this hold no stretch [px]. */
const APART = 10;

/** The span in which the fingers are on their times; as it was where that cannot be, none where it would be all of it. */
export function spanUnder(fingers: readonly Held[], width: number, whole: number, now: Span): Span | undefined {
  const [one, other] = fingers;
  if (!one) return now;
  if (other && Math.abs(other.x - one.x) < APART) return now;
  const scale = other ? (other.time - one.time) / (other.x - one.x) : (now[1] - now[0]) / width;
  if (!(scale > 0)) return now;
  const length = Math.min(scale * width, whole);
  if (length >= whole) return undefined;
  const begin = Math.min(Math.max(one.time - one.x * scale, 0), whole - length);
  return [begin, begin + length];
}

/** Listens to fingers on a chart; what it shows now, and how long all of it is [s], is asked for. */
export function touched(chart: uPlot, zoomed: () => Span | undefined, whole: () => number, onSpan: (span: Span | undefined) => void): () => void {
  const fingers = new Map<number, Held>();
  const { over } = chart;
  const place = (event: PointerEvent) => event.clientX - over.getBoundingClientRect().left;
  const hold = () => {
    for (const [id, { x }] of fingers) fingers.set(id, { x, time: chart.posToVal(x, "x") });
  };
  const down = (event: PointerEvent) => {
    if (event.pointerType !== "touch") return;
    fingers.set(event.pointerId, { x: place(event), time: 0 });
    hold();
  };
  const move = (event: PointerEvent) => {
    const finger = fingers.get(event.pointerId);
    if (!finger) return;
    fingers.set(event.pointerId, { ...finger, x: place(event) });
    const now = zoomed();
    if (fingers.size === 1 && !now) {
      chart.setCursor({ left: place(event), top: event.clientY - over.getBoundingClientRect().top });
      return;
    }
    onSpan(spanUnder([...fingers.values()], over.clientWidth, whole(), now ?? [0, whole()]));
  };
  const up = (event: PointerEvent) => {
    if (fingers.delete(event.pointerId)) hold();
  };
  over.addEventListener("pointerdown", down);
  for (const kind of ["pointermove", "pointerup", "pointercancel"] as const) addEventListener(kind, kind === "pointermove" ? move : up);
  return () => {
    over.removeEventListener("pointerdown", down);
    for (const kind of ["pointermove", "pointerup", "pointercancel"] as const) removeEventListener(kind, kind === "pointermove" ? move : up);
  };
}
