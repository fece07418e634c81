/**
 * Line colours that stay apart for colour-blind readers.
 *
 * Based on the eight colours of Okabe and Ito, "Color Universal Design" (2008); the pale ones are
 * darkened on white and the dark ones lightened on black, so that each has at least 3:1 contrast.
 */

import type { Json } from "./run";
import { isTree } from "./schema";

const LIGHT = ["#1f1f1f", "#0072b2", "#c25100", "#008061", "#b0508a", "#8a6d00", "#2b86c5", "#6b5fb5"];
const DARK = ["#f1f3f5", "#56b4e9", "#f08c3a", "#2fbf93", "#e08fbe", "#e9d94a", "#8fb7ff", "#b3a6f5"];

/** The colour of the vehicle at this place in the platoon. */
export function lineColor(index: number, dark: boolean): string {
  const palette = dark ? DARK : LIGHT;
  return palette[index % palette.length] as string;
}

/** What the lines are drawn on: the page's background. */
const GROUND = { light: [255, 255, 255], dark: [36, 36, 36] };
/** Contrast that graphics need: WCAG 2.2, success criterion 1.4.11. */
const ENOUGH = 3;
/** Colours nearer than this, of 441 between black and white, are taken for one another. */
const APART = 40;

type Rgb = readonly number[];

/**
 * The lines' colours, one per vehicle: as its car is painted, darkened or lightened until it is seen.
 *
 * Where that is no colour, or one that an earlier line has, the palette's next free one is taken.
 */
export function carColors(
  vehicles: readonly string[],
  paints: Readonly<Record<string, string>>,
  dark: boolean,
): string[] {
  const taken: Rgb[] = [];
  return vehicles.map((vehicle, index) => {
    const paint = rgb(paints[vehicle] ?? "");
    const spare = [index, ...LIGHT.keys()].map((place) => rgb(lineColor(place, dark)) as Rgb);
    const choices = [...(paint ? [readable(paint, dark)] : []), ...spare];
    const found = choices.find((choice) => taken.every((other) => distance(choice, other) >= APART));
    const color = found ?? (spare[0] as Rgb);
    taken.push(color);
    return hex(color);
  });
}

/** The colour itself, or as little nearer to black (on white) or to white (on black) as it takes. */
function readable(color: Rgb, dark: boolean): Rgb {
  const ground = dark ? GROUND.dark : GROUND.light;
  const towards = dark ? 255 : 0;
  const mixed = (share: number) => color.map((part) => Math.round(part + (towards - part) * share));
  const shares = Array.from({ length: 21 }, (_, step) => step / 20);
  return mixed(shares.find((share) => contrast(mixed(share), ground) >= ENOUGH) ?? 1);
}

function rgb(text: string): Rgb | undefined {
  if (!/^#[0-9a-f]{6}$/i.test(text)) return undefined;
  return [1, 3, 5].map((at) => Number.parseInt(text.slice(at, at + 2), 16));
}

const hex = (color: Rgb): string => `#${color.map((part) => part.toString(16).padStart(2, "0")).join("")}`;

const distance = (one: Rgb, other: Rgb): number =>
  Math.hypot(...one.map((part, index) => part - (other[index] as number)));

/** Relative luminance and contrast as WCAG 2.2 defines them. */
function luminance(color: Rgb): number {
  const [r = 0, g = 0, b = 0] = color.map((part) =>
    part / 255 <= 0.04045 ? part / 255 / 12.92 : ((part / 255 + 0.055) / 1.055) ** 2.4,
  );
  return 0.2126 * r + 0.7152 * g + 0.0722 * b;
}

export function contrast(one: Rgb, other: Rgb): number {
  const [low = 0, high = 0] = [luminance(one), luminance(other)].sort((a, b) => a - b);
  return (high + 0.05) / (low + 0.05);
}

/** The paint of the vehicles of a document, by name. */
export function paintsOf(document: Json | undefined): Record<string, string> {
  const vehicles = isTree(document) && isTree(document.vehicles) ? document.vehicles : {};
  return Object.fromEntries(
    Object.entries(vehicles).flatMap(([name, vehicle]) =>
      isTree(vehicle) && typeof vehicle.colour === "string" ? [[name, vehicle.colour]] : [],
    ),
  );
}
