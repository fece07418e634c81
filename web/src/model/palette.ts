/**
 * Line colours that stay apart for colour-blind readers.
 *
 * Based on the eight colours of Okabe and Ito, "Color Universal Design" (2008); the pale ones are
 * darkened on white and the dark ones lightened on black, so that each has at least 3:1 contrast.
 */

const LIGHT = ["#1f1f1f", "#0072b2", "#c25100", "#008061", "#b0508a", "#8a6d00", "#2b86c5", "#6b5fb5"];
const DARK = ["#f1f3f5", "#56b4e9", "#f08c3a", "#2fbf93", "#e08fbe", "#e9d94a", "#8fb7ff", "#b3a6f5"];

/** The colour of the vehicle at this place in the platoon. */
export function lineColor(index: number, dark: boolean): string {
  const palette = dark ? DARK : LIGHT;
  return palette[index % palette.length] as string;
}
