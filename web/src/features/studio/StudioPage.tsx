/** The studio: the scene, the parameters, the run and its charts. */

import { Anchor, Button, NativeSelect, Text, Tooltip } from "@mantine/core";
import { useQuery } from "@tanstack/react-query";
import { Link, useNavigate, useRouter } from "@tanstack/react-router";
import { memo, useCallback, useEffect } from "react";
import * as queries from "../../api/queries";
import { useZoom } from "../../charts/zoom";
import { exchanged, fromSet, sameChanges, withChange } from "../../model/form";
import { isLive, type RunDetail } from "../../model/run";
import { Icon } from "../../ui/Icon";
import { notify, PRESSED } from "../../ui/notify";
import { Failure, Loading } from "../../ui/State";
import { useShortcuts } from "../../ui/shortcut";
import { useControl, useTakeOver } from "./control";
import { type Draft, useDraft } from "./draft";
import { useFarewell } from "./farewell";
import { type Form, useForm } from "./form";
import { LiveCharts } from "./LiveCharts";
import { useLayout } from "./arrange";
import { type Playhead, usePlayhead } from "./playhead";
import { ParameterPanel } from "./ParameterPanel";
import { RunBar } from "./RunBar";
import { SaveForm, useSaving } from "./SaveForm";
import { SceneView } from "./SceneView";
import { SidePanel } from "./SidePanel";
import { Splitter, useBottom } from "./Splitter";
import classes from "./Studio.module.css";
import { useShownRun } from "./shown";
import { useSight } from "./sight";
import { useScene } from "./stage";
import { Timeline } from "./Timeline";

interface Props {
  scenario: string;
  /** The run that is shown. */
  run: number | undefined;
  /** A run whose setting is to be taken over, as the parent of the next one. */
  from: number | undefined;
  /** The time [s] to go to as soon as the run is played back. */
  time: number | undefined;
  /** Other runs among the cars of this one, with commas; and what is at the same time in all of them. */
  ghosts: string | undefined;
  align: string | undefined;
  /** How a link wants the scene to be looked at. */
  camera: string | undefined;
  /** False while another page covers this one; the scene and the run go on. */
  active: boolean;
}

export function StudioPage({ scenario: id, run, from, time, ghosts, align, camera, active }: Props) {
  const [draft, update, isFresh] = useDraft(id);
  const form = useForm(id, draft.changes);
  const seed = draft.seed ?? form.seed;
  const [layout, arrange] = useLayout(id);
  const zoom = useZoom(run);
  const shown = useShownRun(run, layout, zoom.span);
  const control = useControl({ id, draft, update, seed, live: shown.live, run, blocked: form.blocked });
  useTakeOver(id, from, isFresh ? run : undefined, update);
  useFarewell(shown.live, run);
  const status = shown.progress?.status;
  const over = run !== undefined && shown.detail?.run === run && !isLive(shown.detail.status) && !isLive(status);
  const playable = over && shown.channels.length > 0;
  // A run that was cancelled while it waited has left nothing to play back: then the scenario stands there, as before it.
  const seen = over ? playable : shown.live !== undefined;
  const scene = useScene(id, draft.changes, seen ? run : undefined, over, form.ok || playable, ghosts, align, form.blocked);
  const sight = useSight(shown.live, scene.vehicles);
  const head = usePlayhead(playable && !scene.settling ? run : undefined, scene, sight);
  useSeekOnce(id, { run, ghosts, align }, head, time);
  const link = useViewLink(id, { run, ghosts, align }, head);
  const bottom = useBottom();
  const title = useQuery(queries.scenarios).data?.find((each) => each.id === id)?.title ?? id;
  const space = { paused: control.onResume, running: control.onPause }[status as string] ?? head?.toggle ?? control.onRun;
  useShortcuts({ " ": space, r: control.onRun, ...(over ? {} : { ".": control.onStep }) }, active);
  const duration = shown.progress?.duration || form.duration;

  return (
    <div className={classes.studio} style={bottom.style} inert={!active} aria-hidden={!active}>
      {active ? <Parameters
          id={id}
          form={form}
          draft={draft}
          update={update}
          other={isOther(shown.detail, draft, seed) ? run : undefined}
        /> : null}
      {active ? (
        <RunBar
          {...control}
          progress={shown.progress}
          duration={form.duration}
          pace={draft.pace}
          seed={seed}
          seeds={draft.seeds}
          blocked={form.blocked}
        />
      ) : null}
      {active && head ? <Timeline head={head} events={shown.events} notes={scene.notes} active={active} span={zoom.span} spanned={shown.spanned} /> : null}
      <SceneView
        vehicles={scene.vehicles}
        attribution={scene.attribution}
        active={active}
        onEmptied={scene.again}
        title={title}
        waits={scene.waits}
        map={scene.map}
        ghosts={scene.ghosts}
        run={head !== undefined || shown.live !== undefined}
        sight={sight}
        missing={scene.missing}
        camera={camera}
        onLink={link}
        running={shown.live !== undefined && isLive(shown.live.status)}
      />
      {active ? <Splitter {...bottom} /> : null}
      {active ? (
        <div className={classes.bottom}>
          <LiveCharts
            coming={shown.coming}
            samples={shown.samples}
            channels={shown.channels}
            layout={layout}
            onLayout={arrange}
            document={shown.detail?.document}
            spanned={shown.spanned}
            version={shown.version}
            duration={duration}
            paints={scene.paints}
            head={head}
            zoom={zoom}
          />
          <SidePanel scenario={id} run={run} detail={shown.detail} status={status} events={shown.events} head={head} />
        </div>
      ) : null}
    </div>
  );
}

/** A link may name a time: the playback goes there, once, and then to wherever one likes. */
function useSeekOnce(id: string, { run, ghosts, align }: Pick<Props, "run" | "ghosts" | "align">, head: Playhead | undefined, time: number | undefined) {
  const navigate = useNavigate();
  useEffect(() => {
    if (!head || time === undefined) return;
    head.seek(time);
    navigate({ to: "/studio/$scenario", params: { scenario: id }, search: { run, ghosts, align }, replace: true });
  }, [id, run, ghosts, align, head, time, navigate]);
}

/** Copies the address of what is seen now: the run, its time, and how one looks at it. */
function useViewLink(id: string, { run, ghosts, align }: Pick<Props, "run" | "ghosts" | "align">, head: Playhead | undefined) {
  const router = useRouter();
  return useCallback(
    (camera: string) => {
      const time = head && Number(head.time.toFixed(3));
      const { href } = router.buildLocation({ to: "/studio/$scenario", params: { scenario: id }, search: { run, ghosts, align, time, camera } });
      const address = `${location.origin}${href}`;
      // Without a secure connection browsers have no clipboard.
      const copied = navigator.clipboard?.writeText(address) ?? Promise.reject(new Error("no clipboard"));
      copied.then(
        () => notify("The link is copied", "Who opens it sees this run at this time, from where you look at it."),
        () => notify("This is the link", <Anchor href={address}>{address}</Anchor>, "teal", { autoClose: PRESSED }),
      );
    },
    [router, id, run, ghosts, align, head],
  );
}

interface ParametersProps {
  id: string;
  form: Form;
  draft: Draft;
  update: (part: Partial<Draft>) => void;
  /** The run that is shown, when the form does not stem from it. */
  other: number | undefined;
}

/** The left side. Its parts change only with the form, not ten times a second with the run. */
const Parameters = memo(function Parameters({ id, form, draft, update, other }: ParametersProps) {
  const { changes } = draft;
  const saving = useSaving({ id, form, draft, update });
  return (
    <aside className={classes.panel} aria-label="Parameters">
      <ScenarioHead id={id} />
      {other === undefined ? null : <OtherRun id={id} run={other} />}
      {form.error ? <Failure error={form.error} onRetry={form.retry} /> : null}
      {form.sections ? (
        <ParameterPanel
          sections={form.sections}
          problems={form.problems}
          parent={draft.parent}
          onChange={(field, value) => update({ changes: withChange(changes, field, value) })}
          onExchange={(exchange, name) => update({ changes: exchanged(changes, exchange, name) })}
          onResetAll={() => update({ changes: {} })}
          onForgetParent={() => update({ parent: null })}
          save={<SaveForm id={id} form={form} draft={draft} update={update} saving={saving} />}
        />
      ) : form.error ? null : (
        <Loading what="the scenario" />
      )}
    </aside>
  );
});

/** Whether the form neither descends from this run nor says the same. */
function isOther(run: RunDetail | undefined, { changes, parent }: Draft, seed: number): boolean {
  if (!run || parent === run.run) return false;
  return seed !== run.seed || !sameChanges(changes, fromSet(run.parameters));
}

/** A link may show a run beside a form that was made for another one. */
function OtherRun({ id, run }: { id: string; run: number }) {
  const navigate = useNavigate();
  return (
    <div className={classes.other} role="note" data-testid="other-run">
      <span>
        This is run <b>#{run}</b>; the form is the next run's.
      </span>
      <Button
        size="compact-xs"
        variant="light"
        data-testid="take-over"
        onClick={() =>
          navigate({ to: "/studio/$scenario", params: { scenario: id }, search: { run, from: run } })
        }
      >
        Take over its setting
      </Button>
    </div>
  );
}

/** Which scenario, and what it is about. */
function ScenarioHead({ id }: { id: string }) {
  const { data = [] } = useQuery(queries.scenarios);
  const navigate = useNavigate();
  const current = data.find((row) => row.id === id);
  const choices = data.map(({ id: value, title, problem }) => ({
    value,
    label: problem ? `${title} (has a problem)` : title,
  }));
  return (
    <header className={classes.head}>
      <div className={classes.choice}>
        <NativeSelect
          size="sm"
          flex={1}
          aria-label="Scenario"
          data-testid="scenario"
          value={id}
          data={choices.length ? choices : [{ value: id, label: id }]}
          onChange={(event) =>
            navigate({ to: "/studio/$scenario", params: { scenario: event.currentTarget.value }, search: {} })
          }
        />
        <Tooltip label="Edit it on the plan">
          <Link to="/edit/$scenario" params={{ scenario: id }} className={classes.asText} aria-label="Edit this scenario on the plan">
            <Icon name="pen" />
          </Link>
        </Tooltip>
        <Tooltip label="Edit its file as text">
          <Link
            to="/scenarios/$scenario/text"
            params={{ scenario: id }}
            className={classes.asText}
            aria-label="Edit this scenario as text"
          >
            <Icon name="text" />
          </Link>
        </Tooltip>
      </div>
      {current?.description ? (
        <Text size="xs" c="dimmed" lineClamp={2} title={current.description}>
          {current.description}
        </Text>
      ) : null}
    </header>
  );
}
