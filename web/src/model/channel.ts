/** Channel names: `<vehicle>.<quantity>`; unit, label and meaning of a quantity are the server's. */

import type { Channel, Server } from "./run";
import { words } from "./units";

export type Quantity = Server["Quantity"];

/** A quantity by its name; one that nobody has described is called by it. */
export const quantity = (name: string, known: readonly Quantity[]): Quantity =>
  known.find((each) => each.name === name) ?? { name, label: words(name), unit: "", meaning: "" };

/** Split `follower_1.gap` into vehicle and quantity. */
export function parts(channel: string): { vehicle: string; quantity: string } {
  const dot = channel.indexOf(".");
  return { vehicle: channel.slice(0, dot), quantity: channel.slice(dot + 1) };
}

/** Surrounding traffic is in the scene, not in the charts. */
export const isTraffic = (vehicle: string): boolean => vehicle.startsWith("traffic");

/** The platoon's channels of one quantity, in the order given. */
export function channelsOf(quantityName: string, channels: readonly string[]): string[] {
  return channels.filter((name) => {
    const { vehicle, quantity: found } = parts(name);
    return found === quantityName && !isTraffic(vehicle);
  });
}

/**
 * What a chart of this quantity draws: one line per car of the platoon.
 *
 * Whoever drives ahead of the first car is no part of the platoon, and its gap would squeeze all others.
 */
export function drawn(quantityName: string, all: readonly string[]): string[] {
  const found = channelsOf(quantityName, all);
  const first = vehiclesOf(all)[0];
  const relative = quantityName === "gap" || quantityName === "time_gap";
  return relative && found.length > 1 ? found.filter((name) => parts(name).vehicle !== first) : found;
}

/** The vehicles that the channels speak of, each once, in their order. */
export function vehiclesOf(channels: readonly string[]): string[] {
  return [...new Set(channels.map((name) => parts(name).vehicle))].filter((name) => !isTraffic(name));
}

/** The quantities that the channels of the platoon hold, in the glossary's order; what that does not know comes last. */
export function quantitiesOf(channels: readonly string[], glossary: readonly Quantity[]): Quantity[] {
  const present = new Set(channels.map(parts).flatMap(({ vehicle, quantity: own }) => (isTraffic(vehicle) ? [] : [own])));
  const known = glossary.filter(({ name }) => present.delete(name));
  return [...known, ...[...present].map((name) => quantity(name, []))];
}

/** The same for what a run has recorded, with the units and labels that were recorded with it. */
export function recorded(channels: readonly Channel[], glossary: readonly Quantity[]): Quantity[] {
  const own = new Map(channels.map(({ name, unit, label }) => [parts(name).quantity, { unit, label }]));
  const names = channels.map(({ name }) => name);
  return quantitiesOf(names, glossary).map((each) => ({ ...each, ...own.get(each.name) }));
}
