/** A small form that corrects an element of the map; what is sent are its tags. */

import { Button, Switch, Text, TextInput, UnstyledButton } from "@mantine/core";
import { type FormEvent, type ReactNode, useId, useState } from "react";
import { type NewCorrection, useCorrect } from "../../api/maps";
import {
  ALL_PARTS,
  ARROW_SIGNS,
  ARROWS,
  type Arrow,
  type Change,
  isChanged,
  LIMITS,
  lanesOf,
  numberOf,
  type Part,
  profileOf,
  type Profile,
  roadOf,
  settled,
  signalTags,
  tagsOf,
  UNCHANGED,
  wayElement,
  wrong,
} from "../../model/correction";
import type { Finding } from "../../model/finding";
import type { Plan, PlanRoad } from "../../model/map";
import type { Problem } from "../../model/run";
import { words } from "../../model/units";
import { NumberEntry } from "../../ui/NumberEntry";
import { ProblemList } from "../../ui/Problems";
import { useJobs } from "./imports";
import classes from "./Maps.module.css";

interface FindingEditorProps {
  map: string;
  plan: Plan;
  finding: Finding;
}

/** The form for the tag that settles a guess. */
export function FindingEditor({ map, plan, finding }: FindingEditorProps) {
  const { element, key, kind, mark, what } = finding;
  const way = numberOf(element, "way");
  const road = way === undefined ? undefined : roadOf(plan, way);
  const part = partOf(key);
  const parts = part ? [part] : mark === "skipped" ? ALL_PARTS : [];
  if (way !== undefined && road && parts.length > 0)
    return <WayEditor map={map} plan={plan} road={road} way={way} parts={parts} guessed={part !== undefined} />;
  if (kind === "signal" && numberOf(element, "node") !== undefined) return <SignalEditor map={map} element={element} />;
  if (key === "height") return <HeightEditor map={map} element={element} taken={Number.parseFloat(what)} />;
  return key ? <TagEditor map={map} element={element} name={key} /> : null;
}

/** The part of a way that a tag tells. */
function partOf(key: string): Part | undefined {
  if (/^lanes(:|$)/.test(key)) return "lanes";
  if (/^maxspeed(:|$)/.test(key)) return "speed";
  if (key === "width") return "width";
  return /^turn:lanes(:|$)/.test(key) ? "turns" : undefined;
}

interface WayEditorProps {
  map: string;
  plan: Plan;
  /** The road from which the way is seen. */
  road: PlanRoad;
  way: number;
  parts: readonly Part[];
  /** Whether it is only guessed, and may be confirmed. */
  guessed?: boolean;
}

export function WayEditor({ map, plan, road, way, parts, guessed = false }: WayEditorProps) {
  const before = profileOf(plan, road, way);
  const [change, setChange] = useState<Change>(UNCHANGED);
  const update = (part: Partial<Change>) => setChange({ ...change, ...part });
  const problem = wrong(change);
  const tags = tagsOf(guessed ? settled(change, before, parts) : change, before);
  return (
    <Form
      map={map}
      correction={{ element: wayElement(way), tags, remove: [] }}
      ready={Object.keys(tags).length > 0 && problem === ""}
      problem={problem}
      confirms={!isChanged(change)}
    >
      {parts.includes("lanes") ? <LaneFields before={before} change={change} update={update} /> : null}
      {parts.includes("speed") ? (
        <NumberField
          label="Speed limit"
          {...LIMITS.speed}
          step={10}
          value={change.speed ?? before.speed}
          onChange={(speed) => update({ speed: differs(speed, before.speed) })}
        />
      ) : null}
      {parts.includes("width") ? (
        <NumberField
          label="Width of a lane"
          {...LIMITS.laneWidth}
          step={0.25}
          value={change.laneWidth ?? before.laneWidth}
          onChange={(laneWidth) => update({ laneWidth: differs(laneWidth, before.laneWidth) })}
        />
      ) : null}
      {parts.includes("turns") ? (
        <TurnField count={laneCount(plan, road, before, change)} turns={change.turns} onChange={(turns) => update({ turns })} />
      ) : null}
    </Form>
  );
}

const differs = (value: number, before: number): number | null => (value === before ? null : value);

/** Lanes of this road, with what has been typed so far. */
const laneCount = (plan: Plan, road: PlanRoad, { along }: Profile, change: Change): number =>
  (along ? change.forward : change.backward) ?? lanesOf(plan, road).length;

interface LaneFieldsProps {
  before: Profile;
  change: Change;
  update: (part: Partial<Change>) => void;
}

/** One number for a one-way way, one for each direction of another. */
function LaneFields({ before, change, update }: LaneFieldsProps) {
  const twoWay = before.forward > 0 && before.backward > 0;
  const [own, other] = before.along ? (["forward", "backward"] as const) : (["backward", "forward"] as const);
  const field = (label: string, side: "forward" | "backward") => (
    <NumberField
      label={label}
      {...LIMITS.lanes}
      step={1}
      value={change[side] ?? before[side]}
      onChange={(lanes) => update({ [side]: differs(lanes, before[side]), turns: null })}
    />
  );
  return (
    <>
      {field(twoWay ? "Lanes this way" : "Lanes", own)}
      {twoWay ? field("Lanes the other way", other) : null}
    </>
  );
}

interface NumberFieldProps {
  label: string;
  unit: string;
  least: number;
  most: number;
  step: number;
  value: number;
  onChange: (value: number) => void;
}

/** Out of range is told and not sent, never clamped. */
function NumberField({ label, unit, least, most, step, value, onChange }: NumberFieldProps) {
  const id = useId();
  return (
    <div className={classes.field}>
      <label htmlFor={id}>{label}</label>
      <NumberEntry
        id={id}
        size="xs"
        w={92}
        min={least}
        max={most}
        step={step}
        decimals={2}
        whole={Number.isInteger(step)}
        data-testid={`edit-${label.toLowerCase().replaceAll(" ", "-")}`}
        error={!(value >= least && value <= most)}
        value={Number.isNaN(value) ? "" : value}
        onNumber={onChange}
        onEmpty={() => onChange(Number.NaN)}
        onNothing={() => onChange(Number.NaN)}
      />
      <span className={classes.unit}>{unit}</span>
    </div>
  );
}

interface TurnFieldProps {
  count: number;
  turns: Arrow[][] | null;
  onChange: (turns: Arrow[][] | null) => void;
}

/** Arrows on the ground of each lane, from left to right as one drives. */
function TurnField({ count, turns, onChange }: TurnFieldProps) {
  const lanes = Array.from({ length: count }, (_, lane) => turns?.[lane] ?? []);
  const toggle = (lane: number, arrow: Arrow) =>
    onChange(
      lanes.map((arrows, at) =>
        at !== lane ? arrows : arrows.includes(arrow) ? arrows.filter((each) => each !== arrow) : [...arrows, arrow],
      ),
    );
  return (
    <div className={classes.turns} role="group" aria-label="Turn arrows, from the left lane to the right one">
      <Text size="xs" c="dimmed">
        Turn arrows{turns === null ? " (unchanged)" : ""}, left lane first
      </Text>
      {lanes.map((arrows, lane) => (
        <div key={lane} className={classes.lane}>
          <span>Lane {lane + 1}</span>
          {ARROWS.map((arrow) => (
            <UnstyledButton
              key={arrow}
              className={classes.arrow}
              aria-pressed={arrows.includes(arrow)}
              aria-label={`Lane ${lane + 1}: ${words(arrow).toLowerCase()}`}
              onClick={() => toggle(lane, arrow)}
            >
              {ARROW_SIGNS[arrow]}
            </UnstyledButton>
          ))}
        </div>
      ))}
    </div>
  );
}

interface ElementEditorProps {
  map: string;
  element: string;
}

function SignalEditor({ map, element }: ElementEditorProps) {
  const [there, setThere] = useState(true);
  return (
    <Form map={map} correction={{ element, ...signalTags(there) }} ready={!there} problem="">
      <Switch
        size="xs"
        label="There is a traffic signal"
        checked={there}
        onChange={(event) => setThere(event.currentTarget.checked)}
      />
    </Form>
  );
}

function HeightEditor({ map, element, taken }: ElementEditorProps & { taken: number }) {
  const [height, setHeight] = useState(taken);
  const { least, most } = LIMITS.height;
  const ready = height >= least && height <= most;
  return (
    <Form
      map={map}
      correction={{ element, tags: { height: String(height) }, remove: [] }}
      ready={ready}
      problem={ready ? "" : `Height: ${least} to ${most} m`}
      confirms={height === taken}
    >
      <NumberField label="Height" {...LIMITS.height} step={0.5} value={height} onChange={setHeight} />
    </Form>
  );
}

/** For tags that have no form of their own. */
function TagEditor({ map, element, name }: ElementEditorProps & { name: string }) {
  const [value, setValue] = useState("");
  const text = value.trim();
  return (
    <Form
      map={map}
      correction={{ element, tags: { [name]: text }, remove: [] }}
      ready={text !== ""}
      problem=""
    >
      <TextInput
        size="xs"
        label={name}
        description="as OpenStreetMap writes it"
        value={value}
        onChange={(event) => setValue(event.currentTarget.value)}
      />
    </Form>
  );
}

interface FormProps {
  map: string;
  correction: NewCorrection;
  ready: boolean;
  problem: string;
  /** Whether what is sent is what was taken. */
  confirms?: boolean;
  children: ReactNode;
}

/** What was typed stays while the map is imported again, and when that is refused. */
function Form({ map, correction, ready, problem, confirms = false, children }: FormProps) {
  const correct = useCorrect(map);
  const going = useJobs().some((job) => job.map === map && job.status === "running");
  const sent = going && JSON.stringify(correct.variables) === JSON.stringify(correction);
  const error = correct.error as (Error & { problems?: Problem[] }) | null;
  const submit = (event: FormEvent) => {
    event.preventDefault();
    if (ready && !sent) correct.mutate(correction);
  };
  return (
    <form className={classes.editor} onSubmit={submit} data-testid="correction">
      {children}
      {problem || error ? (
        <div role="alert" className={classes.problem}>
          {problem || error?.message}
          <ProblemList problems={error?.problems ?? []} />
        </div>
      ) : null}
      <Button type="submit" size="xs" disabled={!ready || sent} loading={correct.isPending} data-testid="correct">
        {sent ? "Being imported again …" : confirms && ready ? "It is right so" : "Correct it"}
      </Button>
    </form>
  );
}
