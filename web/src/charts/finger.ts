/**
 * Fingers on a place: two of them move it, spread it and draw it together, and one that rests is the button at the right.
 *
 * Where they are is told in pixels of the place.
 */

import type { Point } from "../model/view";

export type Pair = readonly [Point, Point];

/** How long a finger rests until it is the button at the right [ms], and by how much it may tremble meanwhile [px]. */
const RESTS = 550;
export const TREMBLE = 10;
/** A page that is later than this is busy [ms]. */
const LATE = 100;

export class Fingers {
  private readonly down = new Map<number, Point>();
  private timer: ReturnType<typeof setTimeout> | undefined;
  private start: Point = { x: 0, y: 0 };

  constructor(private readonly onRest: (at: Point) => void) {}

  get count(): number {
    return this.down.size;
  }

  /** One comes down. */
  press(id: number, at: Point): void {
    this.down.set(id, at);
    this.start = at;
    clearTimeout(this.timer);
    if (this.count === 1) this.wait(RESTS, () => this.onRest(at));
  }

  /** Then does it, unless the finger moves meanwhile; of a busy page it is not known whether it has, so that is given time to hear of it. */
  private wait(time: number, act: () => void): void {
    const due = performance.now() + time;
    this.timer = setTimeout(() => (performance.now() > due + LATE ? this.wait(RESTS, act) : act()), time);
  }

  /** One moves: where the two were and are, if there are two. */
  move(id: number, at: Point): { before: Pair; after: Pair } | undefined {
    if (!this.down.has(id)) return undefined;
    if (Math.hypot(at.x - this.start.x, at.y - this.start.y) > TREMBLE) clearTimeout(this.timer);
    const before = [...this.down.values()];
    this.down.set(id, at);
    const after = [...this.down.values()];
    return after.length === 2 ? { before: before as unknown as Pair, after: after as unknown as Pair } : undefined;
  }

  /** One goes, or is taken away. */
  lift(id: number): void {
    this.down.delete(id);
    clearTimeout(this.timer);
  }
}
