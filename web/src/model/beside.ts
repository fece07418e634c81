/** Several runs beside each other: what each is called, how each stands, and their traces on one time axis. */

import { type Filled, type Json, type Run, type RunEvent, type Server, shortNames, type Trace } from "./run";
import { FINEST } from "./standing";
import { formatValue, words } from "./units";

export type Beside = Filled<Server["Beside"], { values: Json[] }>;
export type SideBySide = Filled<Server["SideBySide"], { runs: Run[]; parameters: Beside[] }>;
export type MetricBeside = Server["MetricBeside"];
export type SourceBeside = Server["SourceBeside"];

/** So many runs are told apart, and no more. */
export const MOST = 8;
/** So many values stand in a run's name at most. */
const TELLING = 2;
/** A value that is longer than this is no name. */
const LONG = 16;

/** `1,3,5` in an address: numbers of runs, each once. */
export function numbersOf(text: string | undefined): number[] {
  const found = (text ?? "").split(",").map(Number);
  return [...new Set(found.filter((each) => Number.isInteger(each) && each > 0))].slice(0, MOST);
}

/** What each run is called: by its number, and by what differs, when that is little. */
export function namesOf(runs: readonly { run: number; name: string }[], parameters: readonly Beside[]): string[] {
  const telling = parameters.filter(({ values }) => differ(values) && values.every((value) => value !== null && isShort(value)));
  const few = telling.length <= TELLING ? telling : [];
  const short = shortNames(few.map(({ path }) => path));
  return runs.map(({ run, name }, place) => {
    const set = few.map(({ path, values }) => `${words(short[path] ?? path).toLowerCase()} ${formatValue(values[place])}`);
    return [`#${run}`, name, ...set].filter(Boolean).join(" ");
  });
}

const differ = (values: readonly Json[]) => values.some((value) => formatValue(value) !== formatValue(values[0]));
const isShort = (value: Json) => formatValue(value).length <= LONG;

/** How a run stands in a metric against the first one. */
export type Stand = "better" | "worse" | "same" | "no goal" | "not ranked" | "missing";

export function standOf({ values, stands, goal }: MetricBeside, place: number, unranked: string): Stand {
  if ((values[0] ?? null) === null || (values[place] ?? null) === null) return "missing";
  if (unranked) return "not ranked";
  return stands[place] ?? (goal === null ? "no goal" : "not ranked");
}

/** How many goals a run met, in words, with a sign that is no matter of colour. */
export function goalsTold(goals: SideBySide["goals"][number]): { text: string; why: string } {
  if (goals === null) return { text: "not measured", why: "The run did not come to its end" };
  if (goals.of === 0) return { text: "none set", why: "Its scenario sets no goals" };
  return { text: `${goals.met === goals.of ? "✓ " : ""}${goals.met} of ${goals.of}`, why: goals.missed.join("\n") };
}

/** How often a run stands better, worse and the same. */
export function tally(metrics: readonly MetricBeside[], place: number, unranked: string): Record<Stand, number> {
  const counts: Record<Stand, number> = { better: 0, worse: 0, same: 0, "no goal": 0, "not ranked": 0, missing: 0 };
  for (const metric of metrics) counts[standOf(metric, place, unranked)] += 1;
  return counts;
}

// -- one time axis -----------------------------------------------------------------------------------

/** Kinds of events that have happened in every run: by their first, runs can be aligned. */
export function commonKinds(events: readonly (readonly RunEvent[])[]): string[] {
  const [first = [], ...others] = events;
  const kinds = [...new Set(first.map(({ kind }) => kind))];
  return kinds.filter((kind) => others.every((some) => some.some((event) => event.kind === kind)));
}

/** How much later than in the first run the first event of a kind was in each [s]; 0 without a kind. */
export function offsetsOf(events: readonly (readonly RunEvent[])[], kind: string | undefined): number[] {
  const times = events.map((some) => some.find((event) => event.kind === kind)?.time);
  return times.map((time) => (time === undefined || times[0] === undefined ? 0 : time - times[0]));
}

/** Values on a merged time axis: `undefined` where the run has no sample there, `null` where it has a gap. */
export type Merged = [number[], ...(number | null | undefined)[][]];

/** [s] Times that differ by less are one. */
const GRAIN = 1e-6;

/** The channels of all traces over the union of their times, each run moved by its offset [s]; run after run. */
export function merged(traces: readonly Trace[], offsets: readonly number[], channels: readonly (readonly string[])[]): Merged {
  const moved = traces.map(({ time }, place) => time.map((each) => Math.round((each - (offsets[place] ?? 0)) / GRAIN) * GRAIN));
  const time = [...new Set(moved.flat())].sort((one, other) => one - other);
  const columns = traces.flatMap((trace, place) => {
    const at = new Map(moved[place]?.map((each, index) => [each, index]));
    return (channels[place] ?? []).map((name) => {
      const values = trace.channels[name]?.values;
      return time.map((each) => (at.has(each) && values ? values[at.get(each) as number] : undefined));
    });
  });
  return [time, ...columns];
}

/** [1] A difference of more than so many times the baseline is told in its unit: nobody sees anything in 24 900 %. */
const MANY = 10;

/** The difference to the first run, and that over its value where that tells something; none where nobody could measure it. */
export function changeOf({ values, relative }: MetricBeside, place: number): { difference: number | null; relative: number | null } {
  const [first, own] = [values[0] ?? null, values[place] ?? null];
  if (first === null || own === null) return { difference: null, relative: null };
  if (Math.abs(own - first) <= FINEST) return { difference: 0, relative: 0 };
  const share = relative[place] ?? null;
  return { difference: own - first, relative: share !== null && Math.abs(share) > MANY ? null : share };
}

/** Whether a metric says something of these runs: one has it and another not, or some differ by more than chance. */
export const differs = (metric: MetricBeside): boolean =>
  metric.values.some((value) => value === null) !== metric.values.every((value) => value === null) ||
  metric.values.some((_, place) => metric.stands[place] !== "same" && Boolean(changeOf(metric, place).difference));
