/** Rows of a table that the keys move through, although only those near what is seen are drawn. */

import { type KeyboardEvent, type RefObject, useLayoutEffect, useRef } from "react";

/** Where a key leads, from one row of so many. */
const STEPS: Record<string, (at: number, count: number) => number> = {
  ArrowDown: (at) => at + 1,
  j: (at) => at + 1,
  ArrowUp: (at) => at - 1,
  k: (at) => at - 1,
  PageDown: (at) => at + 10,
  PageUp: (at) => at - 10,
  Home: () => 0,
  End: (_at, count) => count - 1,
};

/** Where the focus shall go, and where it was when that was wished. */
interface Wish {
  row: string;
  left: Element | null;
}

/**
 * The focus on rows that carry `data-index`; `rows` are their keys in the order of the table.
 *
 * It does not wait for what a key changes elsewhere, such as the selection, which comes back through the address: on a
 * slow machine several keys come before that, and each counts from the row of the last one. A row that is not drawn is
 * scrolled to and gets the focus when it is there, unless somebody has gone elsewhere meanwhile.
 */
export function useRowFocus(
  scroller: RefObject<HTMLElement | null>,
  rows: readonly string[],
  scrollTo: (index: number) => void,
) {
  const wish = useRef<Wish>(undefined);
  const pending = () => (wish.current && isOpen(wish.current) ? rows.indexOf(wish.current.row) : -1);
  const arrive = () => {
    if (!wish.current) return;
    const index = pending();
    const row = scroller.current?.querySelector<HTMLElement>(`tr[data-index="${index}"]`);
    if (index < 0 || row) wish.current = undefined;
    row?.focus({ preventScroll: true });
    row?.scrollIntoView({ block: "nearest", inline: "nearest" });
  };
  // Without dependencies: a row far away is drawn some time after the table was scrolled to it.
  useLayoutEffect(arrive);

  const go = (index: number) => {
    const row = rows[index];
    if (row === undefined) return;
    wish.current = { row, left: document.activeElement };
    arrive();
    if (wish.current) scrollTo(index);
  };
  /** The row that a key leads to, which gets the focus; undefined when it is not a key for that. */
  const step = (event: KeyboardEvent): number | undefined => {
    const lead = STEPS[event.key.length === 1 ? event.key.toLowerCase() : event.key];
    const here = (event.target as HTMLElement).closest<HTMLElement>("tr[data-index]")?.dataset.index;
    if (!lead || here === undefined || event.ctrlKey || event.metaKey || event.altKey) return undefined;
    event.preventDefault();
    const from = pending() < 0 ? Number(here) : pending();
    const to = Math.min(rows.length - 1, Math.max(0, lead(from, rows.length)));
    go(to);
    return to;
  };
  /** From elsewhere into the table; a way that has begun is not left for it. */
  const enter = (index: number) => {
    if (pending() < 0) go(index);
  };
  return { enter, step };
}

/** Whether the focus is where it was, or was lost with a row that is not drawn any more. */
const isOpen = ({ left }: Wish): boolean =>
  document.activeElement === left || document.activeElement === document.body;
