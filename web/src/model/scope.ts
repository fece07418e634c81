/** What of a run a metric looks at, and what is set of it, in words: so that nobody takes a red light for the maneuver. */

import type { KnownKind } from "./form";
import { isTree, type Schema } from "./schema";
import type { Json, Tree } from "./run";
import { formatNumber, formatValue, unitText, words } from "./units";

/** The document of a scenario names measures with settings of their own under `measures`; all others look at everything. */
function listed(document: Tree, name: string): Tree {
  const entry = isTree(document.measures) ? document.measures[name] : undefined;
  return isTree(entry) ? entry : {};
}

/** From when to when, and of whom. */
export function windowOf(document: Tree, name: string): string {
  const { begin, end, vehicles } = listed(document, name);
  const time = isTree(begin) || isTree(end) ? `from ${moment(begin, "the start")} to ${moment(end, "the end")}` : "the whole run";
  const whom = Array.isArray(vehicles) && vehicles.length ? vehicles.map(String).join(", ") : "all recorded vehicles";
  return `${time}; ${whom}`;
}

/** A moment: so long after the start, or after the first event that fits. */
function moment(when: Json | undefined, otherwise: string): string {
  if (!isTree(when)) return otherwise;
  const { at, event, unit, entry } = when;
  const seconds = typeof at === "number" ? at : 0;
  if (typeof event !== "string" && typeof entry !== "string") return `${formatNumber(seconds)} s`;
  const what = typeof event === "string" ? `the first ${words(event).toLowerCase()}` : "the beginning";
  const of = [entry, unit].filter((each) => typeof each === "string").join(" and ");
  const named = of ? `${what} of ${of}` : what;
  return seconds ? `${formatNumber(Math.abs(seconds))} s ${seconds > 0 ? "after" : "before"} ${named}` : named;
}

const SCOPE = new Set(["kind", "preset", "begin", "end", "vehicles"]);

/** What is set of a metric, each with its unit, as the scenario has it or by default. */
export function settingsOf(document: Tree, name: string, kinds: readonly KnownKind[]): string[] {
  const given = listed(document, name);
  const kind = typeof given.kind === "string" ? given.kind : name;
  const schema = kinds.find((each) => each.sort === "metric" && each.name === kind)?.settings;
  return Object.entries(schema?.properties ?? {})
    .filter(([key]) => !SCOPE.has(key))
    .map(([key, property]: [string, Schema]) => {
      const value = formatValue(given[key] ?? property.default);
      return `${property.title ?? words(key)} ${value} ${unitText(property.unit)}`.trim();
    });
}

/** Whom a metric is about, without the time at the end, which is a number beside it. */
export const whom = (about: string, time: number | null): string =>
  time === null ? about : about.replace(/ ?\bat -?[\d.]+ s$/, "");
