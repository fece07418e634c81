/** Validation projects as the page shows them: what stands in them, the patches that change them, and courses as columns. */

import type { Server } from "./run";
import { formatNumber } from "./units";

export type ProjectRow = Server["ProjectRow"];
export type Project = Server["ProjectDetail"];
export type Parameter = Server["ProjectParameter"];
export type ProjectJob = Server["ProjectJob"];
export type Looked = Server["Looked"];
export type Cut = Server["Cut"];
export type Course = Server["Course"];
export type Kinds = Server["ValidationKinds"];
export type Operation = Pick<Server["Operation"], "op" | "path"> & { value?: unknown };

/** A run of a project: its log, and from when to when in it [s]. */
export interface Run {
  log: string;
  begin: number;
  end: number | null;
  mapping: string | null;
}

export interface Trial {
  kind: string;
  calibration: Run[];
  validation: Run[];
}

export interface Wanted {
  low: number;
  high: number;
  prior: number | null;
  spread: number | null;
}

/** What a project says, as far as the page shows it in forms. */
export interface Said {
  title: string;
  vehicle: string;
  mapping: string | null;
  confidence: string;
  maneuvers: Record<string, Trial>;
  calibration: Record<string, { parameters: Record<string, Wanted>; maneuvers: string[] }>;
  overrides: { maneuver: string; criterion: string; reason: string }[];
}

export const SETS = ["calibration", "validation"] as const;
export type RunSet = (typeof SETS)[number];

/** Part of a JSON pointer. */
const part = (text: string): string => text.replaceAll("~", "~0").replaceAll("/", "~1");

/** A run as it is written: without what goes without saying. */
const written = ({ log, begin, end }: Pick<Run, "log" | "begin" | "end">) => ({
  log,
  ...(begin > 0 ? { begin: round(begin) } : {}),
  ...(end === null ? {} : { end: round(end) }),
});

const round = (seconds: number): number => Math.round(seconds * 100) / 100;

/** The patch that puts a run into a maneuver of its kind, which is made when there is none. */
export function addRun(said: Said, kind: string, set: RunSet, run: Pick<Run, "log" | "begin" | "end">): Operation[] {
  const [name, trial] = Object.entries(said.maneuvers).find(([, each]) => each.kind === kind) ?? [];
  if (name === undefined || trial === undefined) return [{ op: "add", path: `/maneuvers/${part(kind)}`, value: { kind, [set]: [written(run)] } }];
  const place = `/maneuvers/${part(name)}/${set}`;
  return [trial[set].length > 0 ? { op: "add", path: `${place}/-`, value: written(run) } : { op: "add", path: place, value: [written(run)] }];
}

/** The patch that takes a run out; of a maneuver without another run, the maneuver. */
export function removeRun(said: Said, maneuver: string, set: RunSet, place: number): Operation[] {
  const trial = said.maneuvers[maneuver];
  if (!trial) return [];
  if (trial.calibration.length + trial.validation.length === 1) return [{ op: "remove", path: `/maneuvers/${part(maneuver)}` }];
  const list = `/maneuvers/${part(maneuver)}/${set}`;
  return [{ op: "remove", path: trial[set].length === 1 ? list : `${list}/${place}` }];
}

/** The patch that gives a run other times. */
export const cutRun = (maneuver: string, set: RunSet, place: number, run: Run): Operation[] => [
  {
    op: "replace",
    path: `/maneuvers/${part(maneuver)}/${set}/${place}`,
    value: { ...written(run), ...(run.mapping ? { mapping: run.mapping } : {}) },
  },
];

/** The patch by which a person judges a criterion otherwise. */
export const override = (said: Said, maneuver: string, criterion: string, reason: string): Operation[] => [
  said.overrides.length > 0
    ? { op: "add", path: "/overrides/-", value: { maneuver, criterion, reason } }
    : { op: "add", path: "/overrides", value: [{ maneuver, criterion, reason }] },
];

/** Which of the judgements of persons is about a criterion; -1 where nobody has judged it. */
export const overrideOf = (said: Said, maneuver: string, criterion: string): number =>
  said.overrides.findIndex((each) => each.maneuver === maneuver && each.criterion === criterion);

/** The patch that takes a judgement back; the list goes with the last of them. */
export const takeBackOverride = (said: Said, place: number): Operation[] => [
  { op: "remove", path: said.overrides.length > 1 ? `/overrides/${place}` : "/overrides" },
];

/** The patch that adds a parameter to a step of calibration, which is made when there is none. */
export function addParameter(said: Said, step: string, path: string, low: number, high: number): Operation[] {
  const value = { low, high };
  if (!said.calibration[step]) {
    const made = { [step]: { parameters: { [path]: value } } };
    return Object.keys(said.calibration).length === 0
      ? [{ op: "add", path: "/calibration", value: made }]
      : [{ op: "add", path: `/calibration/${part(step)}`, value: made[step] }];
  }
  return [{ op: "add", path: `/calibration/${part(step)}/parameters/${part(path)}`, value }];
}

/** Parameters as they are chosen from, under the parts of the vehicle: named by title, found by path too. */
export function choices(parameters: readonly Parameter[]) {
  const groups = new Map<string, { value: string; label: string }[]>();
  for (const { path, title } of parameters) {
    const group = path.split(".")[0] ?? "";
    groups.set(group, [...(groups.get(group) ?? []), { value: path, label: `${title} (${path})` }]);
  }
  return [...groups].map(([group, items]) => ({ group, items }));
}

/** The patch that looks for a parameter no longer; a step without parameters goes with the last of them. */
export function removeParameter(said: Said, step: string, path: string): Operation[] {
  const others = Object.keys(said.calibration[step]?.parameters ?? {}).length - 1;
  if (others > 0) return [{ op: "remove", path: `/calibration/${part(step)}/parameters/${part(path)}` }];
  return [{ op: "remove", path: Object.keys(said.calibration).length > 1 ? `/calibration/${part(step)}` : "/calibration" }];
}

// -- verdicts -----------------------------------------------------------------------------------------

/** A number with its unit as a verdict has it; a pure number is a share, in per cent. What was judged by an older studio has no unit. */
export const measured = (value: number | null, unit: string | undefined): string => (value === null ? "–" : `${figure(value, unit)}${behind(unit)}`);

/** From where to where, with one unit. */
export const interval = (low: number | null, high: number | null, unit: string | undefined): string =>
  low === null || high === null ? "–" : `${figure(low, unit)} to ${figure(high, unit)}${behind(unit)}`;

const figure = (value: number, unit: string | undefined): string => formatNumber(unit === "1" ? Number((100 * value).toPrecision(12)) : value);
const behind = (unit: string | undefined): string => (unit === undefined ? "" : unit === "1" ? " %" : ` ${unit}`);

// -- mapping ------------------------------------------------------------------------------------------

/** Where one of our signals comes from, of several what `combine` makes of them; not taken when it comes from none. */
export interface SourceEntry {
  from: readonly string[];
  unit: string;
  combine: "mean" | "norm";
  sign: 1 | -1;
  offset: number;
  delay: number;
  /** x, y, z of the sensor from the centre of gravity [m]; null when it is there. */
  at?: Place | null;
}

export type Place = readonly [x: number, y: number, z: number];

/** Our signals that are another at another place of the body. */
export const PLACED: ReadonlySet<string> = new Set(["speed", "lateral_speed", "acceleration", "lateral_acceleration"]);

/** A place with another coordinate; none where all of them are zero. */
export function placedAt(at: Place | null | undefined, axis: number, value: number): Place | null {
  const made = [0, 1, 2].map((each) => (each === axis ? value : (at?.[each] ?? 0))) as unknown as Place;
  return made.some((each) => each !== 0) ? made : null;
}

/** A mapping as its file says it. */
export interface Mapping {
  dbc: string | null;
  signals: Record<string, Omit<SourceEntry, "from"> & { from: string | string[] }>;
}

/** The text of a mapping file. */
export function mappingText(sources: Readonly<Record<string, SourceEntry>>, dbc: string | null = null): string {
  const lines = Object.entries(sources)
    .filter(([, { from }]) => from.length > 0)
    .map(([name, { from, unit, combine, sign, offset, delay, at }]) => {
      const more = [
        `from: ${JSON.stringify(from.length === 1 ? from[0] : from)}`,
        unit ? `unit: ${JSON.stringify(unit)}` : "",
        combine === "norm" ? "combine: norm" : "",
        sign === -1 ? "sign: -1" : "",
        offset ? `offset: ${offset}` : "",
        delay ? `delay: ${delay}` : "",
        at ? `at: [${at.join(", ")}]` : "",
      ];
      return `  ${name}: {${more.filter(Boolean).join(", ")}}`;
    });
  return `${dbc === null ? "" : `dbc: ${JSON.stringify(dbc)}\n`}signals:\n${lines.join("\n")}\n`;
}

/** What a mapping says of each of our signals; those that it does not take come from none. */
export function sourcesOf({ signals }: Mapping, kinds: Kinds): Record<string, SourceEntry> {
  const none = { from: [], combine: "mean", sign: 1, offset: 0, delay: 0 } as const;
  return Object.fromEntries(
    kinds.signals.map(({ name, units }) => {
      const found = signals[name];
      return [name, found ? { ...found, from: [found.from].flat() } : { ...none, unit: units[0] ?? "" }];
    }),
  );
}

/** A first guess: the recorded signal whose name says most of ours. */
export function guesses(recorded: readonly { name: string; unit: string }[], kinds: Kinds): Record<string, SourceEntry> {
  return Object.fromEntries(kinds.signals.map(({ name, units }) => [name, guess(name, units, recorded)]));
}

const ALIKE: Readonly<Record<string, RegExp>> = {
  speed: /^(v|vx|vx_mps|speed|velocity|vehicle_?speed|geschwindigkeit|tempo)$/i,
  yaw_rate: /yaw_?(rate|velocity|vel)|gierrate|psi_?dot/i,
  lateral_acceleration: /^(ay|acc_?y|a_y)(_|$)|lat(eral)?_?acc|querbeschl/i,
  acceleration: /^(ax|acc_?x|a_x)(_|$)|long(itudinal)?_?acc|l(ä|ae)ngsbeschl/i,
  steering_wheel_angle: /steer(ing)?_?wheel|^lenkrad|swa/i,
  road_wheel_angle: /road_?wheel|^delta|radlenk|radeinschlag|(?<!steering_?)wheel_?angle/i,
  throttle: /throttle|accelerator|pedal/i,
  brake: /^brake(_pedal)?$/i,
  gear: /gear|gang/i,
  engine_speed: /engine_?speed|rpm|motordrehzahl/i,
};

function guess(ours: string, units: readonly string[], recorded: readonly { name: string; unit: string }[]): SourceEntry {
  const found = recorded.find(({ name }) => name === ours) ?? recorded.find(({ name }) => ALIKE[ours]?.test(name));
  const unit = found && units.includes(found.unit) ? found.unit : (units[0] ?? "");
  return { from: found ? [found.name] : [], unit, combine: "mean", sign: 1, offset: 0, delay: 0 };
}

/** A recorded signal that a person chooses, in the unit that the log gives it; where that is none, in the one that the form has. */
export function chosen(name: string, recorded: readonly { name: string; unit: string }[], units: readonly string[]): Partial<SourceEntry> {
  const { unit } = recorded.find((each) => each.name === name) ?? { unit: "" };
  return { from: name === "" ? [] : [name], combine: "mean", ...(units.includes(unit) ? { unit } : {}) };
}

// -- courses ------------------------------------------------------------------------------------------

/** The columns of a course in the order in which they are drawn: abscissa, bounds, and lines. */
export const columnsOf = ({ at, low, high, theirs, ours, averaged }: Course): (number | null)[][] => [
  at,
  high,
  low,
  theirs,
  ours,
  ...(averaged ? [averaged] : []),
];

/** What the band is, in short: the words of the interval end with its two-sided share where that is not their first. */
export const shareOf = (interval: string): string => `${interval.match(/\d+ %/g)?.at(-1) ?? ""} confidence interval`.trim();

/** Whether a job goes on. */
export const goesOn = (job: Pick<ProjectJob, "status"> | undefined): boolean => job?.status === "running";
