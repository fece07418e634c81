/** A run and what hangs on it, as the API tells them. */

import type { components } from "./server";

/** What goes over the wire, by its name in the server's own description. */
export type Server = components["schemas"];

export type Value = number | string | boolean | null;
export type Json = Value | Json[] | { [key: string]: Json };
export type Tree = { [key: string]: Json };

/** What was set, by path: `{"radio.latency": 0.1}`. */
export type Changes = Record<string, Json>;

/** An answer whose free parts, which the description leaves open, are known to be documents. */
export type Filled<Answer, Parts extends Partial<Record<keyof Answer, unknown>>> = Omit<Answer, keyof Parts> & Parts;

/** How a run stands in the database. */
export type RunStatus = Server["Run"]["status"];
/** How a live run stands now. */
export type LiveStatus = Server["Live"]["status"];
export type Status = RunStatus | LiveStatus;

export type Problem = Server["Problem"];
export type Metric = Server["Metric"];
export type Goal = Metric["goal"];
export type Run = Filled<Server["Run"], { parameters: Changes }>;
/** A run among others; `settings` are the values of everything that one of them has set, as this one had them. */
export type ListedRun = Filled<Server["ListedRun"], { parameters: Changes; settings: Changes }>;
/** A run that goes on or waits for its turn. */
export type Queued = Filled<Server["Queued"], { parameters: Changes }>;
export type Channel = Server["Channel"];
/** Why something happened. */
export type Explanation = Server["Explanation"];
/** Kinds of events that the server explains. */
export const EXPLAINED: ReadonlySet<string> = new Set(["collision", "near_miss", "hard_brake"]);
/** Something that happened in a run. */
export type RunEvent = Server["Event"];
export type RunDetail = Filled<Server["RunDetail"], { parameters: Changes; document: Tree }>;
export type Trace = Server["Trace"];

const LIVE: ReadonlySet<Status> = new Set<Status>(["waiting", "starting", "running", "paused"]);

/** Whether a run of this status can still change. */
export const isLive = (status: Status | undefined): boolean => status !== undefined && LIVE.has(status);

/** Why a run has no traces, in words. */
export function untraced(status: Status): string {
  if (status === "waiting") return "The run waits for its turn: its traces are drawn here as soon as it goes on.";
  return isLive(status) ? "The run has just begun: its traces are drawn here as it goes on." : "This run recorded nothing.";
}

/** Whether a run came to its end: whatever else was measured of less, and is not ranked with those that did. */
export const isWhole = ({ status }: Pick<Run, "status">): boolean => status === "done";

/** The last part of a dotted path: `radio.latency` → `latency`. */
export const leaf = (path: string): string => path.slice(path.lastIndexOf(".") + 1);

/** The shortest tails of the paths that still tell them apart. */
export function shortNames(paths: readonly string[]): Record<string, string> {
  const tail = (path: string, parts: number) => path.split(".").slice(-parts).join(".");
  const unique = (path: string, parts: number) =>
    paths.every((other) => other === path || tail(other, parts) !== tail(path, parts));
  const shortest = (path: string) => {
    let parts = 1;
    while (!unique(path, parts) && parts < path.split(".").length) parts += 1;
    return tail(path, parts);
  };
  return Object.fromEntries(paths.map((path) => [path, shortest(path)]));
}

/** How many runs there are of each status, most frequent first. */
export const countByStatus = (runs: readonly Run[]): [Status, number][] => countBy(runs, ({ status }) => status);

/** How many there are of each word, most frequent first. */
export function countBy<Item, Word>(items: readonly Item[], wordOf: (item: Item) => Word): [Word, number][] {
  const counts = new Map<Word, number>();
  for (const word of items.map(wordOf)) counts.set(word, (counts.get(word) ?? 0) + 1);
  return [...counts].sort((a, b) => b[1] - a[1]);
}
