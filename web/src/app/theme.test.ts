import { expect, it } from "vitest";
import { legible, theme } from "./theme";

const linear = (v: number) => (v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4);
const luminance = (hex: string) => {
  const [r, g, b] = [1, 3, 5].map((at) => linear(Number.parseInt(hex.slice(at, at + 2), 16) / 255)) as [number, number, number];
  return 0.2126 * r + 0.7152 * g + 0.0722 * b;
};
const contrast = (one: string, other: string) => {
  const [darker, lighter] = [luminance(one), luminance(other)].sort((a, b) => a - b) as [number, number];
  return (lighter + 0.05) / (darker + 0.05);
};

/** The palest and the darkest that text stands on: a row of a table that was chosen, a field in the dark. */
const GROUND = { light: "#e0eaf5", dark: "#2e2e2e" };

it.each(["light", "dark"] as const)("text can be read on the grounds of the %s theme", (scheme) => {
  const colours = legible(theme as never)[scheme] as Record<string, string>;
  const plain = Object.entries(colours).filter(([name]) => !name.endsWith("-light-color"));
  expect(plain.filter(([, colour]) => contrast(colour, GROUND[scheme]) < 4.5)).toEqual([]);
});
