/** Which run descends from which, and what was changed on the way. */

import type { Json, ListedRun } from "./run";
import { formatValue } from "./units";

export interface Branch {
  run: ListedRun;
  /** For every fork above it whether there are later siblings: where a line goes on downwards. */
  open: readonly boolean[];
  /** Whether it is its parent's only child: it stands straight below, so that a long chain does not run out of the page. */
  straight: boolean;
  /** Whether its parent is not among the runs that are shown. */
  lost: boolean;
  /** What differs from its parent; nothing of a run without one. */
  changes: readonly Change[];
  /** How many descend from it. */
  heirs: number;
}

export interface Change {
  path: string;
  from: Json | undefined;
  to: Json | undefined;
}

/** All runs as trees, one behind the other, the newest tree first; below every run its children, the oldest first. */
export function forest(runs: readonly ListedRun[]): Branch[] {
  const known = new Map(runs.map((run) => [run.run, run]));
  const children = new Map<number | null, ListedRun[]>();
  for (const run of [...runs].sort((one, other) => one.run - other.run)) {
    const parent = run.parent !== null && known.has(run.parent) && run.parent !== run.run ? run.parent : null;
    children.set(parent, [...(children.get(parent) ?? []), run]);
  }
  const found: Branch[] = [];
  // Deep lineages are long chains: no recursion, which would end at some thousand generations.
  const waiting = (children.get(null) ?? []).map((run) => ({ run, open: [] as readonly boolean[], straight: false }));
  while (waiting.length > 0) {
    const { run, open, straight } = waiting.pop() as (typeof waiting)[number];
    const parent = run.parent === null ? undefined : known.get(run.parent);
    found.push({ run, open, straight, lost: run.parent !== null && !parent, changes: parent ? changesOf(run, parent) : [], heirs: 0 });
    const own = children.get(run.run) ?? [];
    const only = own.length === 1;
    for (const [place, child] of [...own.entries()].reverse())
      waiting.push({ run: child, open: only ? open : [...open, place < own.length - 1], straight: only });
  }
  return counted(found);
}

/** With how many descend from each, from the leaves up. */
function counted(branches: Branch[]): Branch[] {
  const heirs = new Map<number, number>();
  for (const { run } of [...branches].reverse())
    if (run.parent !== null) heirs.set(run.parent, (heirs.get(run.parent) ?? 0) + 1 + (heirs.get(run.run) ?? 0));
  return branches.map((branch) => ({ ...branch, heirs: heirs.get(branch.run.run) ?? 0 }));
}

/** What was set otherwise than in the parent. */
export function changesOf(run: ListedRun, parent: ListedRun): Change[] {
  const paths = [...new Set([...Object.keys(parent.settings), ...Object.keys(run.settings)])].sort();
  const found = paths.map((path) => ({ path, from: parent.settings[path], to: run.settings[path] }));
  const seed = { path: "seed", from: parent.seed, to: run.seed };
  const scenario = { path: "scenario", from: parent.scenario, to: run.scenario };
  return [scenario, ...found, seed].filter(({ from, to }) => formatValue(from) !== formatValue(to));
}
