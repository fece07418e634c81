/** Channel names: `<vehicle>.<quantity>`; unit, label and meaning of a quantity are the server's. */

import type { Channel, Json, Server } from "./run";
import { isTree } from "./schema";
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

const RELATIVE = ["gap", "time_gap"];

/**
 * What a chart of this quantity draws: one line per car that has a name.
 *
 * Whoever drives ahead of a platoon's leader is no part of it, and that gap would squeeze all others: it is left out, wherever the
 * file names the leader.
 */
export function drawn(quantityName: string, all: readonly string[], leaders: readonly string[]): string[] {
  const found = channelsOf(quantityName, all);
  const following = found.filter((name) => !leaders.includes(parts(name).vehicle));
  return RELATIVE.includes(quantityName) && following.length > 0 ? following : found;
}

/**
 * Who leads a platoon of a scenario, and follows in none.
 *
 * A platoon is a group of an application in which everybody listens to the unit before it in the list, as the studio's metrics of
 * followers have it; its leader is the first whom they listen to.
 */
export function leadersOf(document: Json | undefined): string[] {
  const groups = isTree(document) && isTree(document.applications) ? Object.values(document.applications) : [];
  const chains = groups.map(chainOf).filter((chain) => chain.length > 1);
  const following = chains.flatMap((chain) => chain.slice(1));
  return chains.flatMap(([first]) => (first === undefined || following.includes(first) ? [] : [first]));
}

/** The vehicles of a group from its leader on; none where they do not listen one to the other. */
function chainOf(group: Json | undefined): string[] {
  if (!isTree(group) || !Array.isArray(group.units) || !Array.isArray(group.listens_to)) return [];
  const units = group.units.map(String);
  const ahead = group.listens_to.map((each) => (Array.isArray(each) ? each[0] : each)).flatMap((each) => (typeof each === "string" ? [each] : []));
  const order = [...ahead.slice(0, 1), ...units];
  return ahead.length === order.length - 1 && ahead.every((each, place) => each === order[place]) ? order : [];
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
