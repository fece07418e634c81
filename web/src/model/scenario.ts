/** Scenario files as the page shows them: names that may be given, search, order, and problems at their lines. */

import type { Server } from "./run";

export type ScenarioRow = Server["ScenarioRow"];
export type Deleted = Server["DeletedScenario"];
export type TextProblem = Server["TextProblem"];

const LONGEST = 80;
const FOREIGN = /[^\p{L}\p{M}\p{N} \-_.]/u;
const DEVICE = /^(con|prn|aux|nul|com[0-9]|lpt[0-9])(\..*)?$/i;

/** The name of a file as it is sent: without its ending and without space around it. */
export const plainName = (name: string): string => name.normalize("NFC").trim().replace(/\.ya?ml$/i, "").trim();

/** What is wrong with a name before the server is asked; empty when nothing is. */
export function nameProblem(given: string, taken: readonly string[]): string {
  const name = plainName(given);
  if (name === "") return "Give it a name.";
  if (/[/\\]/.test(name) || /^\.+$/.test(name)) return "A name leads to no other folder: write it without / and \\.";
  const foreign = FOREIGN.exec(name)?.[0];
  if (foreign) return `No file name may hold “${foreign}”. Letters, digits, spaces and - _ . may stand in it.`;
  if (name.startsWith(".") || name.endsWith(".")) return "A name neither begins nor ends with a dot.";
  if (DEVICE.test(name)) return "Windows keeps this name for a device.";
  if (name.length > LONGEST) return `At most ${LONGEST} characters.`;
  return isTaken(name, taken) ? `There is a scenario ${name} already.` : "";
}

/** On many systems capitals make no difference. */
const isTaken = (name: string, taken: readonly string[]): boolean =>
  taken.some((other) => other.toLowerCase() === name.toLowerCase());

/** The name, or with a number behind it when it is taken. */
export function freeName(name: string, taken: readonly string[]): string {
  const base = name.replace(/_\d+$/, "");
  let [free, number] = [name, 1];
  while (isTaken(free, taken)) free = `${base}_${++number}`;
  return free;
}

/** A name for the file of a scenario with this title. */
export const nameFor = (title: string): string =>
  title
    .normalize("NFC")
    .toLowerCase()
    .replace(/[^\p{L}\p{M}\p{N}]+/gu, "_")
    .replace(/^_+|_+$/g, "")
    .slice(0, 60)
    .replace(/_+$/, "");

/** The scenarios in which all words of the query occur. */
export function matchingScenarios(rows: readonly ScenarioRow[], query: string): ScenarioRow[] {
  const needles = query.toLowerCase().split(/\s+/).filter(Boolean);
  const text = ({ title, file, map, description, problem }: ScenarioRow) =>
    `${title} ${file} ${map} ${description} ${problem === null ? "" : `problem ${problem}`}`.toLowerCase();
  return rows.filter((row) => needles.every((needle) => text(row).includes(needle)));
}

export const ORDERS = ["title", "map", "changed", "runs"] as const;
export type Order = (typeof ORDERS)[number];

/** Names from A to Z; of times and numbers the largest first. */
export function ordered(rows: readonly ScenarioRow[], by: Order): ScenarioRow[] {
  const compare: Record<Order, (a: ScenarioRow, b: ScenarioRow) => number> = {
    title: (a, b) => a.title.localeCompare(b.title),
    map: (a, b) => a.map.localeCompare(b.map),
    changed: (a, b) => b.changed.localeCompare(a.changed),
    runs: (a, b) => (b.runs ?? 0) - (a.runs ?? 0),
  };
  return [...rows].sort((a, b) => compare[by](a, b) || a.title.localeCompare(b.title));
}

/** The id of a map in the folder of maps, when a scenario names one there. */
export const mapId = (file: string): string | undefined => /^maps\/([^/]+)\/?$/.exec(file)?.[1];

/** What is wrong with a scenario: the first problem, and the others, without the sentence that only says that there are some. */
export function problemLines(problem: string): [string, string[]] {
  const [sentence = "", ...lines] = problem.split("\n").map((line) => line.trim());
  return [lines[0] ?? sentence, lines.slice(1)];
}

/** Problems in the order of their lines; those without a place first. */
export const byLine = (problems: readonly TextProblem[]): TextProblem[] =>
  [...problems].sort((a, b) => (a.line ?? 0) - (b.line ?? 0) || (a.column ?? 0) - (b.column ?? 0));

/** The place of a problem without the file and the numbers, which stand beside it: the path of the field. */
export function pathOf({ where }: Pick<TextProblem, "where">): string {
  const placed = /, line \d+, column \d+(?:: (.*))?$/s.exec(where);
  if (placed) return placed[1] ?? "";
  return where.replace(/^[^:]*\.ya?ml(: |$)/i, "");
}

/** Whether every line of a text ends as on Windows; such a file stays so. */
export const hasWindowsLines = (text: string): boolean => text.includes("\r\n") && !/(^|[^\r])\n/.test(text);
