/** The charts of a scenario: what each draws, kept in the browser from visit to visit. */

import type { Json } from "./run";
import { isTree } from "./schema";

/** One quantity of every car of the platoon over time, and any other channels with it. */
export interface TimeSetup {
  form: "time";
  quantity: string;
  /** Names of channels: of this unit, or of one other. */
  more: readonly string[];
}

/** One quantity over another, a curve for every car of the platoon. */
export interface XYSetup {
  form: "xy";
  x: string;
  y: string;
}

export type Setup = TimeSetup | XYSetup;
export type Layout = readonly Setup[];

export const timeSetup = (quantity: string, more: readonly string[] = []): TimeSetup => ({ form: "time", quantity, more });

export const USUAL: Layout = [timeSetup("speed"), timeSetup("gap")];

/** A layout that was kept; what cannot be read of it is left out, and of nothing the usual one is made. */
export function layoutOf(kept: Json | undefined): Layout {
  const found = Array.isArray(kept) ? kept.flatMap((each) => setupOf(each)) : [];
  return found.length ? found : USUAL;
}

function setupOf(kept: Json): Setup[] {
  if (!isTree(kept)) return [];
  const { form, quantity, more, x, y } = kept;
  if (form === "time" && typeof quantity === "string") {
    const names = Array.isArray(more) ? more.filter((name) => typeof name === "string") : [];
    return [timeSetup(quantity, names)];
  }
  return form === "xy" && typeof x === "string" && typeof y === "string" ? [{ form, x, y }] : [];
}

export const replaced = (layout: Layout, place: number, setup: Setup): Layout =>
  layout.map((old, index) => (index === place ? setup : old));

/** Without a chart; the last one stays. */
export const without = (layout: Layout, place: number): Layout =>
  layout.length > 1 ? layout.filter((_, index) => index !== place) : layout;

/**
 * With a channel in a chart over time. A chart has two axes, so a channel of a third unit gets a chart of its own behind it.
 */
export function withChannel(layout: Layout, place: number, channel: string, unitOf: (name: string) => string): Layout {
  const setup = layout[place];
  if (setup?.form !== "time" || setup.more.includes(channel)) return layout;
  const other = otherUnit(setup, unitOf);
  const unit = unitOf(channel);
  if (unit === unitOf(setup.quantity) || other === undefined || unit === other)
    return replaced(layout, place, { ...setup, more: [...setup.more, channel] });
  const quantity = channel.slice(channel.indexOf(".") + 1);
  return layout.toSpliced(place + 1, 0, timeSetup(quantity, [channel]));
}

export const withoutChannel = (setup: TimeSetup, channel: string): TimeSetup => ({
  ...setup,
  more: setup.more.filter((name) => name !== channel),
});

/** The unit of the second axis; none when there is only one. */
export function otherUnit(setup: TimeSetup, unitOf: (name: string) => string): string | undefined {
  return setup.more.map(unitOf).find((unit) => unit !== unitOf(setup.quantity));
}

/** The channels that all charts together need; `drawn` tells those of a quantity. */
export function needed(layout: Layout, drawn: (quantity: string) => readonly string[], known: ReadonlySet<string>): string[] {
  const all = layout.flatMap((setup) =>
    setup.form === "time" ? [...drawn(setup.quantity), ...setup.more] : [...drawn(setup.x), ...drawn(setup.y)],
  );
  return [...new Set(all)].filter((name) => known.has(name));
}
