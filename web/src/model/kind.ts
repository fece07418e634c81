/** Kinds as the page lists them: by sort, and those that somebody looks for. */

import type { KnownKind } from "./form";
import type { Server } from "./run";

export type BrokenKind = Server["BrokenKind"];

/** The kinds sort by sort, in the server's order. */
export function bySort(kinds: readonly KnownKind[]): [string, KnownKind[]][] {
  const sorts = [...new Set(kinds.map(({ sort }) => sort))];
  return sorts.map((sort) => [sort, kinds.filter((kind) => kind.sort === sort)]);
}

/** Those with all words of the query in name, title, sort, source or description. */
export function matchingKinds(kinds: readonly KnownKind[], query: string): KnownKind[] {
  const needles = query.toLowerCase().split(/\s+/).filter(Boolean);
  return kinds.filter(({ sort, name, title, source, description }) => {
    const text = [sort, name, title, source, description].join(" ").toLowerCase();
    return needles.every((needle) => text.includes(needle));
  });
}
