/** A recorded channel in one number as a column of the table of runs: what it is called, and what it says of each run. */

import { NAMES } from "./aggregate";
import { isLive, type ListedRun, type Server } from "./run";
import type { Column } from "./table";
import { formatNumber, words } from "./units";

/** As the server tells it, and how the last attempt to work it out was refused. */
export type Told = Server["ChannelColumn"] & { refused?: Error | undefined };

export type Kind = Told["kind"];

/** What somebody wants to see of every run; without times all of it, without an event none. */
export interface Wanted {
  channel: string;
  kind: Kind;
  begin: number | undefined;
  end: number | undefined;
  event: string;
}

/** What the server calls it: `leader.speed.mean@5..20`. */
export function nameOf({ channel, kind, begin, end, event }: Wanted): string {
  const what = `${channel}.${kind === "at_event" ? `at_${event}` : kind}`;
  return begin === undefined && end === undefined ? what : `${what}@${begin ?? ""}..${end ?? ""}`;
}

const CHANNEL = "channel:";
export const channelId = (name: string): string => `${CHANNEL}${name}`;

/** The name of a column of that sort; none of any other. */
export const channelName = (id: string): string | undefined => (id.startsWith(CHANNEL) ? id.slice(CHANNEL.length) : undefined);

/** The column as far as the server has told it. */
export function channelColumn(name: string, told: Told | undefined): Column {
  const cells = new Map(told?.cells.map((cell) => [cell.run, cell]));
  return {
    id: channelId(name),
    group: "channels",
    title: told ? titleOf(told) : name,
    unit: told?.cells.find(({ unit }) => unit)?.unit ?? "",
    name: told ? `${titleOf(told)}: ${told.meaning}. In a filter: ${name}` : name,
    numeric: true,
    value: ({ run }) => cells.get(run)?.value,
    lack: (run) => lackOf(run, cells.get(run.run), told),
  };
}

function titleOf({ channel, kind, begin, end, event }: Told): string {
  const number = kind === "at_event" ? `at the first ${words(event).toLowerCase()}` : NAMES[kind].toLowerCase();
  return `${channel} ${number}${spanText(begin, end)}`;
}

function spanText(begin: number | null, end: number | null): string {
  if (begin === null) return end === null ? "" : `, until ${formatNumber(end)} s`;
  return end === null ? `, from ${formatNumber(begin)} s` : `, ${formatNumber(begin)} to ${formatNumber(end)} s`;
}

/** Why a run has no number there. */
function lackOf(run: ListedRun, cell: Told["cells"][number] | undefined, told: Told | undefined) {
  if (cell) return { text: "–", why: cell.why };
  if (isLive(run.status)) return { text: "–", why: "The run is not over." };
  if (told?.refused) return { text: "–", why: told.refused.message };
  return told?.lacking === 0 ? { text: "–", why: "What it has recorded has not been taken in yet." } : { text: "…", why: "It is being worked out." };
}

/** What was told before, with what has been worked out since. */
export function joined(before: Told | undefined, more: Told): Told {
  const fresh = new Set(more.cells.map(({ run }) => run));
  return { ...more, cells: [...more.cells, ...(before?.cells ?? []).filter(({ run }) => !fresh.has(run))] };
}

/** From which runs one learns what may be chosen: the newest of each scenario that came to its end. */
export function samplesOf(runs: readonly ListedRun[], most: number): number[] {
  const newest = new Map<string, number>();
  for (const { run, scenario, status } of runs) if (!isLive(status) && run > (newest.get(scenario) ?? 0)) newest.set(scenario, run);
  return [...newest.values()].sort((one, other) => other - one).slice(0, most);
}
