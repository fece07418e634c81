/** The colour of a run in drawings: by what was decided about it; pale when the filter keeps it out. */

import type { ListedRun } from "../../model/run";

const INKS = {
  light: { candidate: "#087f5b", discarded: "#c25100", open: "#1c6fb5", out: "rgba(0, 0, 0, 0.09)" },
  dark: { candidate: "#38d9a9", discarded: "#f08c3a", open: "#74b8f0", out: "rgba(255, 255, 255, 0.1)" },
};

export function inkOf({ verdict }: Pick<ListedRun, "verdict">, isShown: boolean, dark: boolean): string {
  const inks = dark ? INKS.dark : INKS.light;
  return isShown ? inks[verdict] : inks.out;
}
