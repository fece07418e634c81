/** What the report of an import points at: guesses, things skipped, and what was corrected since. */

import type { Report, Sure, Tags } from "./map";
import type { Point } from "./view";

/** How a finding is drawn: a guess by how sure it is. */
export type Mark = Sure | "skipped" | "corrected";

export interface Finding extends Point {
  id: string;
  mark: Mark;
  kind: string;
  what: string;
  where: string;
  /** What a guess was made from, or why something was skipped. */
  why: string;
  /** The element of the map, e.g. `way 4711`; empty when there is none to correct. */
  element: string;
  /** The tag that corrects it; empty when none does. */
  key: string;
  latitude: number;
  longitude: number;
}

/** Worst first: what is least sure needs most attention. */
export const MARKS: readonly Mark[] = ["low", "medium", "skipped", "high", "corrected"];

export const MARK_NAMES: Record<Mark, string> = {
  low: "Guess, unsure",
  medium: "Guess, fairly sure",
  high: "Guess, sure",
  skipped: "Skipped",
  corrected: "Corrected",
};

/** Everything that the report points at. */
export function findings({ guesses, skipped, corrected }: Report): Finding[] {
  return [
    ...guesses.map(({ number, sure, source, ...guess }) => ({
      ...guess,
      id: idOf(number),
      mark: sure,
      where: named(guess.where),
      why: source,
    })),
    ...skipped.map(({ number, reason, ...thing }) => ({
      ...thing,
      id: idOf(number),
      mark: "skipped" as const,
      where: named(thing.where),
      why: reason,
      key: "",
    })),
    ...corrected.map(({ number, tags, removed, before, ...thing }) => ({
      ...thing,
      id: idOf(number),
      mark: "corrected" as const,
      where: named(thing.where),
      kind: "corrected",
      what: changeText(tags, removed),
      why: `the map says ${tagText(before)}`,
      key: Object.keys(tags)[0] ?? removed[0] ?? "",
    })),
  ];
}

/** `way 4711 (High Street)` by its name; the element stands elsewhere. */
const named = (where: string): string => /^(?:way|node|relation) \d+ \((.+)\)$/.exec(where)?.[1] ?? where;

/** With a letter, because an address would put a mere number in quotes. */
const idOf = (number: number): string => `f${number}`;

/** What a correction says, in one line: `lanes = 3, no maxspeed`. */
export const changeText = (tags: Tags, removed: readonly string[]): string =>
  [...(Object.keys(tags).length ? [tagText(tags)] : []), ...removed.map((key) => `no ${key}`)].join(", ");

/** Tags in one line; one that is not there has an empty value. */
export const tagText = (tags: Tags): string =>
  Object.entries(tags)
    .map(([key, value]) => (value === "" ? `no ${key}` : `${key} = ${value}`))
    .join(", ");

/** What is hidden: names of kinds and of marks. */
export interface Filter {
  kinds: ReadonlySet<string>;
  marks: ReadonlySet<Mark>;
}

/** The findings that are not hidden and hold every word of the query. */
export function shown(all: readonly Finding[], { kinds, marks }: Filter, query = ""): Finding[] {
  const words = query.toLowerCase().split(/\s+/).filter(Boolean);
  return all.filter((finding) => {
    if (kinds.has(finding.kind) || marks.has(finding.mark)) return false;
    const text = `${finding.kind} ${finding.what} ${finding.where} ${finding.why} ${finding.element}`.toLowerCase();
    return words.every((word) => text.includes(word));
  });
}

/** How many there are of each, most frequent first. */
export function counted<Key extends string>(all: readonly Finding[], key: (finding: Finding) => Key): [Key, number][] {
  const counts = new Map<Key, number>();
  for (const finding of all) counts.set(key(finding), (counts.get(key(finding)) ?? 0) + 1);
  return [...counts].sort(([one, many], [other, few]) => few - many || one.localeCompare(other));
}

export type SortKey = "mark" | "kind" | "what" | "where";

/** In the order of a column; equals keep their order, and nothing comes last. */
export function ordered(all: readonly Finding[], key: SortKey, descending: boolean): Finding[] {
  const sign = descending ? -1 : 1;
  return [...all].sort((one, other) => {
    if (key === "mark") return sign * (MARKS.indexOf(one.mark) - MARKS.indexOf(other.mark));
    const [a, b] = [one[key], other[key]];
    if (a === "" || b === "") return Number(a === "") - Number(b === "");
    return sign * a.localeCompare(b, "en", { numeric: true });
  });
}

/** The mark of several findings at one place: the worst. */
export const worst = (members: readonly Finding[]): Mark =>
  MARKS.find((mark) => members.some((member) => member.mark === mark)) ?? "high";

/** The finding that this one has become after another import, in which numbers may have changed. */
export function again(before: Finding, all: readonly Finding[]): Finding | undefined {
  const same = (other: Finding) => other.kind === before.kind && Math.hypot(other.x - before.x, other.y - before.y) < 1;
  const ofElement = all.filter(({ element }) => element !== "" && element === before.element);
  return (
    ofElement.find(({ mark }) => mark === "corrected") ??
    ofElement.find(({ kind }) => kind === before.kind) ??
    all.find(same) ??
    ofElement[0]
  );
}
