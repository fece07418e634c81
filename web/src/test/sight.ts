/** What is seen of a long table, which happy-dom, without a layout, cannot know; scrolling is late, as in a busy browser. */

import { act } from "react";
import { type MockInstance, vi } from "vitest";

const HEIGHT = 300;

export class Sight {
  private readonly asked: MockInstance;

  /** `height` is that of all rows together [px]. */
  constructor(height: number) {
    vi.spyOn(HTMLElement.prototype, "clientHeight", "get").mockReturnValue(HEIGHT);
    vi.spyOn(HTMLElement.prototype, "scrollHeight", "get").mockReturnValue(height);
    this.asked = vi.spyOn(Element.prototype, "scrollTo").mockImplementation(() => {});
  }

  /** The table is where it wanted to be scrolled to, which the browser tells only now. */
  arrive(table: HTMLElement | null): void {
    this.move(table, Number(this.asked.mock.lastCall?.[0].top));
  }

  /** Somebody has scrolled. */
  move(table: HTMLElement | null, top: number): void {
    const scroller = table?.parentElement as HTMLElement;
    act(() => {
      scroller.scrollTop = top;
      scroller.dispatchEvent(new Event("scroll"));
    });
  }
}

/** Presses keys one after the other on what has the focus. */
export function press(...keys: string[]): void {
  for (const key of keys) {
    const event = new KeyboardEvent("keydown", { key, bubbles: true, cancelable: true });
    act(() => void document.activeElement?.dispatchEvent(event));
  }
}
