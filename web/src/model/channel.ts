/** Channel names: `<vehicle>.<quantity>`. */

export interface Quantity {
  name: string;
  label: string;
  unit: string;
}

/** What the page may draw; the unit also stands in the run's own channel list. */
export const QUANTITIES: readonly Quantity[] = [
  { name: "speed", label: "Speed", unit: "m/s" },
  { name: "gap", label: "Gap", unit: "m" },
  { name: "acceleration", label: "Acceleration", unit: "m/s²" },
  { name: "time_gap", label: "Time gap", unit: "s" },
  { name: "yaw_rate", label: "Yaw rate", unit: "rad/s" },
  { name: "steering", label: "Steering", unit: "rad" },
  { name: "lateral_offset", label: "Lateral offset", unit: "m" },
  { name: "station", label: "Station", unit: "m" },
];

export const quantity = (name: string): Quantity =>
  QUANTITIES.find((known) => known.name === name) ?? { name, label: name, unit: "" };

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

/** The quantities that the channels hold, known ones first. */
export function quantitiesOf(channels: readonly string[]): Quantity[] {
  const present = new Set(channels.map((name) => parts(name).quantity));
  return QUANTITIES.filter(({ name }) => present.has(name));
}
