/** The studio: the scene, the parameters, the run and its charts. */

import { NativeSelect, Text } from "@mantine/core";
import { useDebouncedValue } from "@mantine/hooks";
import { useQuery, useQueryClient } from "@tanstack/react-query";
import { Link, useNavigate } from "@tanstack/react-router";
import { memo, useCallback, useEffect, useMemo, useRef, useState } from "react";
import { type LiveState, useLive } from "../../api/live";
import * as queries from "../../api/queries";
import { exchanged, fromSet, sections, withChange } from "../../model/form";
import { type Changes, isLive, type RunDetail } from "../../model/run";
import type { Samples } from "../../model/samples";
import { notify, notifyError } from "../../ui/notify";
import { useShortcuts } from "../../ui/shortcut";
import { Failure, Loading } from "../../ui/State";
import { type Draft, useDraft } from "./draft";
import { LiveCharts } from "./LiveCharts";
import { ParameterPanel } from "./ParameterPanel";
import { type Controls, type Progressing, RunBar } from "./RunBar";
import { SceneView } from "./SceneView";
import { SidePanel } from "./SidePanel";
import classes from "./Studio.module.css";

interface Props {
  scenario: string;
  /** The run that is shown. */
  run: number | undefined;
  /** A run whose setting is to be taken over, as the parent of the next one. */
  from: number | undefined;
  /** False while another page covers this one; the scene and the run go on. */
  active: boolean;
}

export function StudioPage({ scenario: id, run, from, active }: Props) {
  const [draft, update] = useDraft(id);
  const form = useForm(id, draft.changes);
  const seed = draft.seed ?? form.seed;
  const shown = useShownRun(run);
  const control = useControl({ id, draft, update, seed, live: shown.live, run });
  useTakeOver(id, from, update);
  useFarewell(shown.live, run);
  const scene = useScene(id, draft.changes, shown.live ? run : undefined, form.ok);
  const space = { paused: control.onResume, running: control.onPause }[shown.progress?.status as string] ?? control.onRun;
  useShortcuts({ " ": space, ".": control.onStep }, active);
  const duration = shown.progress?.duration || form.duration;

  return (
    <div className={classes.studio} inert={!active} aria-hidden={!active}>
      {active ? <Parameters id={id} form={form} draft={draft} update={update} /> : null}
      {active ? <RunBar {...control} progress={shown.progress} duration={form.duration} pace={draft.pace} seed={seed} /> : null}
      <SceneView vehicles={scene.vehicles} attribution={scene.attribution} active={active} />
      {active ? (
        <div className={classes.bottom}>
          <LiveCharts samples={shown.samples} version={shown.version} duration={duration} />
          <SidePanel scenario={id} run={run} events={shown.events} />
        </div>
      ) : null}
    </div>
  );
}

interface ParametersProps {
  id: string;
  form: Form;
  draft: Draft;
  update: (part: Partial<Draft>) => void;
}

/** The left side. Its parts change only with the form, not ten times a second with the run. */
const Parameters = memo(function Parameters({ id, form, draft, update }: ParametersProps) {
  const { applications } = form;
  const { changes } = draft;
  return (
    <aside className={classes.panel} aria-label="Parameters">
      <ScenarioHead id={id} />
      {form.error ? <Failure error={form.error} onRetry={form.retry} /> : null}
      {form.sections ? (
        <ParameterPanel
          sections={form.sections}
          applications={applications}
          problems={form.problems}
          parent={draft.parent}
          onChange={(field, value) => update({ changes: withChange(changes, field, value) })}
          onExchange={(exchange, name) => {
            const next = applications.find((known) => known.name === name);
            if (next) update({ changes: exchanged(changes, exchange, next) });
          }}
          onResetAll={() => update({ changes: {} })}
          onForgetParent={() => update({ parent: null })}
        />
      ) : form.error ? null : (
        <Loading what="the scenario" />
      )}
    </aside>
  );
});

/** Which scenario, and what it is about. */
function ScenarioHead({ id }: { id: string }) {
  const { data = [] } = useQuery(queries.scenarios);
  const navigate = useNavigate();
  const current = data.find((row) => row.id === id);
  const choices = data.map(({ id: value, title, problem }) => ({ value, label: problem ? `${title} (has a problem)` : title }));
  return (
    <header className={classes.head}>
      <NativeSelect
        size="sm"
        aria-label="Scenario"
        data-testid="scenario"
        value={id}
        data={choices.length ? choices : [{ value: id, label: id }]}
        onChange={(event) => navigate({ to: "/studio/$scenario", params: { scenario: event.currentTarget.value }, search: {} })}
      />
      {current?.description ? (
        <Text size="xs" c="dimmed" lineClamp={2} title={current.description}>
          {current.description}
        </Text>
      ) : null}
    </header>
  );
}

const NO_SCENE = { vehicles: [], attribution: "" };
const NONE: never[] = [];

/** Show the scenario in the 3D scene, or the run that is going; when it ends, its last moment stays. */
function useScene(id: string, set: Changes, live: number | undefined, ok: boolean) {
  // Only what changes the picture is worth building the scene again.
  const visible = useMemo(() => Object.fromEntries(Object.entries(set).filter(([path]) => SEEN.test(path))), [set]);
  const what = live === undefined ? { scenario: id, set: visible } : { run: live };
  const [settled] = useDebouncedValue(what, live === undefined ? 400 : 0);
  const { data = NO_SCENE, error } = useQuery({ ...queries.scene(settled), enabled: ok });
  useEffect(() => {
    if (error) notifyError(error);
  }, [error]);
  return data;
}

const SEEN = /^(map|vehicles|traffic|platoon|route|routes)\b/;

/** The form of a scenario with the user's changes, and what the server says about them. */
function useForm(id: string, changes: Changes) {
  const scenario = useQuery(queries.scenario(id));
  const applications = useQuery(queries.applications);
  const { document, schema } = scenario.data ?? {};
  const known = applications.data ?? NONE;
  const form = useMemo(
    () => (document && schema ? sections({ document, schema, applications: known, changes }) : undefined),
    [document, schema, known, changes],
  );
  const [settled] = useDebouncedValue(changes, 300);
  const { data: checked } = useQuery({ ...queries.check(id, settled), enabled: form !== undefined });
  const { refetch: again } = scenario;
  const { refetch: andApplications } = applications;
  const retry = useCallback(() => void Promise.all([again(), andApplications()]), [again, andApplications]);
  const error = scenario.error ?? applications.error;
  return useMemo(
    () => ({
      sections: form,
      applications: known,
      ok: checked?.ok ?? false,
      problems: checked?.problems ?? NONE,
      duration: durationOf(checked?.document ?? document),
      seed: typeof document?.seed === "number" ? document.seed : 1,
      error,
      retry,
    }),
    [form, known, checked, document, error, retry],
  );
}

type Form = ReturnType<typeof useForm>;

/** How long the scenario runs [s], wherever the document says it. */
function durationOf(document: unknown): number {
  const { clock, duration } = (document ?? {}) as { clock?: { duration?: unknown }; duration?: unknown };
  const found = clock?.duration ?? duration;
  return typeof found === "number" ? found : 0;
}

/** The run in the address: its live state while it goes, its stored trace otherwise. */
function useShownRun(run: number | undefined) {
  const stored = useQuery({ ...queries.run(run ?? 0), enabled: run !== undefined });
  const detail = run === undefined ? undefined : stored.data;
  const [followed, follow] = useState<number>();
  const going = isLive(detail?.status);
  useEffect(() => {
    if (going) follow(run);
  }, [going, run]);
  const live = useLive(followed === run ? run : undefined);
  // The process of a run may die without a last word; what is stored then counts.
  const lost = live !== undefined && !live.connected && detail !== undefined && !going;
  useEffect(() => {
    if (lost) follow(undefined);
  }, [lost]);
  const samples = useStoredSamples(live ? undefined : detail);
  return {
    live,
    samples: live?.samples ?? samples,
    version: live?.version ?? 0,
    events: live?.events ?? detail?.events ?? NONE,
    progress: live ? fromLive(live) : detail ? fromStored(detail) : undefined,
  };
}

const fromLive = ({ run, status, time, duration_s, real_time_factor, error }: LiveState): Progressing => ({
  run,
  status,
  time,
  duration: duration_s,
  factor: real_time_factor,
  error,
});

const fromStored = ({ run, status, sim_time_s, error, document }: RunDetail): Progressing => ({
  run,
  status,
  time: sim_time_s ?? 0,
  duration: durationOf(document) || (sim_time_s ?? 0),
  factor: 0,
  error,
});

/** The trace of a finished run in the same shape as live samples. */
function useStoredSamples(run: RunDetail | undefined): Samples | undefined {
  const finished = run !== undefined && !isLive(run.status);
  const channels = finished ? run.channels.map(({ name }) => name).filter((name) => /\.(speed|gap|acceleration|time_gap)$/.test(name) && !name.startsWith("traffic")) : NONE;
  const { data } = useQuery(queries.trace(run?.run ?? 0, channels));
  return useMemo(() => {
    if (!finished || !data) return undefined;
    const columns = Object.entries(data.channels).map(([name, { values }]) => [name, values] as const);
    return { time: data.time, channels: Object.fromEntries(columns) };
  }, [data, finished]);
}

interface ControlProps {
  id: string;
  draft: Draft;
  update: (part: Partial<Draft>) => void;
  seed: number;
  live: LiveState | undefined;
  run: number | undefined;
}

/** What the buttons of the run bar do. */
function useControl({ id, draft, update, seed, live, run }: ControlProps): Controls & { starting: boolean } {
  const start = useStarter({ id, draft, update, seed });
  const order = queries.useOrder();
  const pace = queries.usePace();
  const tell = (what: queries.Order) => {
    if (run !== undefined) order.mutate({ run, order: what }, { onError: notifyError });
  };
  return {
    starting: start.isPending,
    onRun: () => start.begin(false),
    onPause: () => tell("pause"),
    onResume: () => tell("resume"),
    onStop: () => tell("stop"),
    onStep: () => (live && isLive(live.status) ? tell("step") : start.begin(true)),
    onSeed: (seed) => update({ seed }),
    onPace: (next) => {
      update({ pace: next });
      if (run !== undefined && live && isLive(live.status)) pace.mutate({ run, pace: next }, { onError: notifyError });
    },
  };
}

/** Start a run of the draft and show it; the one after it will be its child. */
function useStarter({ id, draft, update, seed }: Pick<ControlProps, "id" | "draft" | "update" | "seed">) {
  const start = queries.useStart();
  const order = queries.useOrder();
  const navigate = useNavigate();
  const begin = (paused: boolean) => {
    if (start.isPending) return;
    const { changes, pace, parent } = draft;
    const body = { scenario: id, set: changes, seed, pace, paused, ...(parent === null ? {} : { parent }) };
    start.mutate(body, {
      onError: notifyError,
      onSuccess: ({ run }) => {
        update({ parent: run });
        // A first step out of rest is one step, too; a run that is not up yet just stays at its start.
        if (paused) order.mutate({ run, order: "step" });
        navigate({ to: "/studio/$scenario", params: { scenario: id }, search: { run } });
      },
    });
  };
  return { begin, isPending: start.isPending };
}

/** "Tune from here": take over the setting of a run, once. */
function useTakeOver(id: string, from: number | undefined, update: (part: Partial<Draft>) => void) {
  const navigate = useNavigate();
  const { data } = useQuery({ ...queries.run(from ?? 0), enabled: from !== undefined });
  useEffect(() => {
    if (from === undefined || data?.run !== from) return;
    update({ changes: fromSet(data.parameters), seed: data.seed, parent: from });
    navigate({ to: "/studio/$scenario", params: { scenario: id }, search: { run: from }, replace: true });
    // biome-ignore lint/correctness/useExhaustiveDependencies: once per run that is taken over
  }, [from, data]);
}

/** When the run ends: say so, with the way to its page. */
function useFarewell(live: LiveState | undefined, run: number | undefined) {
  const client = useQueryClient();
  const before = useRef<{ run: number; going: boolean }>(undefined);
  const status = live?.status;
  useEffect(() => {
    if (!status || run === undefined) return;
    const ended = before.current?.run === run && before.current.going && !isLive(status);
    before.current = { run, going: isLive(status) };
    if (!ended) return;
    void client.invalidateQueries({ queryKey: ["runs"] });
    void client.invalidateQueries({ queryKey: ["run", run] });
    notify(
      `Run #${run} ${status === "done" ? "is done" : status}`,
      <Link to="/runs/$run" params={{ run: String(run) }}>
        Show its metrics and charts
      </Link>,
      status === "done" ? "teal" : status === "stopped" ? "gray" : "red",
    );
  }, [status, run, client]);
}
