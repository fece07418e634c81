/** A run and what hangs on it, as the API tells them. */

/** How a run stands in the database. */
export type RunStatus = "running" | "done" | "failed" | "stopped" | "killed";
/** How a live run stands now. */
export type LiveStatus = "starting" | "running" | "paused" | "done" | "stopped" | "failed";
export type Status = RunStatus | LiveStatus;
export type Goal = "higher" | "lower" | null;
export type Value = number | string | boolean | null;
export type Json = Value | Json[] | { [key: string]: Json };
export type Tree = { [key: string]: Json };

/** What was set, by path: `{"radio.latency": 0.1}`. */
export type Changes = Record<string, Json>;

export interface Problem {
  where: string;
  what: string;
  value: string;
  allowed: string;
  remedy: string;
}

export interface Metric {
  value: number | null;
  unit: string;
  goal: Goal;
}

export interface Run {
  run: number;
  scenario: string;
  scenario_hash: string;
  parent: number | null;
  seed: number;
  status: RunStatus;
  error: string | null;
  state_hash: string | null;
  code_version: string;
  created: string;
  sim_time_s: number | null;
  wall_time_s: number | null;
  parameters: Changes;
  /** One sentence per goal that was not met; it begins with the metric's name. */
  unmet: string[];
  metrics: Record<string, Metric>;
}

export interface Channel {
  name: string;
  unit: string;
  label: string;
}

/** Something that happened in a run. */
export interface RunEvent {
  time: number;
  text: string;
  vehicle: string;
}

export interface RunDetail extends Run {
  document: Tree;
  channels: Channel[];
  events: RunEvent[];
}

export interface Trace {
  time: number[];
  channels: Record<string, { unit: string; values: (number | null)[] }>;
}

const LIVE: ReadonlySet<Status> = new Set<Status>(["starting", "running", "paused"]);

/** Whether a run of this status can still change. */
export const isLive = (status: Status | undefined): boolean => status !== undefined && LIVE.has(status);

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
export function countByStatus(runs: readonly Run[]): [Status, number][] {
  const counts = new Map<Status, number>();
  for (const { status } of runs) counts.set(status, (counts.get(status) ?? 0) + 1);
  return [...counts].sort((a, b) => b[1] - a[1]);
}
