/** All runs in one table: what was set, what came out, and which to compare. */

import { Badge, Button, Group, Modal, SegmentedControl, Select, Switch, Text, Title } from "@mantine/core";
import { useQuery } from "@tanstack/react-query";
import { useNavigate } from "@tanstack/react-router";
import { useMemo, useState } from "react";
import { useChannelColumns } from "../../api/columns";
import { olderRuns, PAGE, runs } from "../../api/queries";
import { arranged, pinned as withPin, pinnedOf, withChannel } from "../../model/arrangement";
import { MOST } from "../../model/beside";
import { pinsOf } from "../../model/pin";
import { countBy, countByStatus, type ListedRun } from "../../model/run";
import { filterOf } from "../../model/filter";
import { groupable } from "../../model/grouping";
import { type Column, textOf } from "../../model/table";
import { withUnit } from "../../model/units";
import type { Word } from "../../model/verdict";
import { Icon } from "../../ui/Icon";
import { Empty, Failure, Loading } from "../../ui/State";
import { useShortcuts } from "../../ui/shortcut";
import { Board } from "./Board";
import { ChannelDialog } from "./ChannelForm";
import { ColumnMenu, useArrangement } from "./ColumnMenu";
import { useColumns } from "./columns";
import { ExportMenu } from "./ExportMenu";
import { FilterField } from "./FilterField";
import { Lineage } from "./Lineage";
import { Many } from "./Many";
import classes from "./Runs.module.css";
import { RunsTable } from "./RunsTable";
import { Space, type SpaceView } from "./Space";
import { VerdictForm } from "./VerdictForm";

/** What the address says about the table. */
export interface RunsView extends SpaceView {
  scenario?: string | undefined;
  q?: string | undefined;
  sort?: string | undefined;
  /** The column by which they are grouped. */
  by?: string | undefined;
  varying?: boolean | undefined;
  /** A status or verdict that is shown alone. */
  only?: string | undefined;
  /** How they are shown; as a table without it. */
  as?: "space" | "lineage" | "board" | undefined;
  /** The run that the others are tinted against. */
  base?: number | undefined;
  /** Runs that stay on top, beside the baseline, with commas. */
  pins?: string | undefined;
}

interface Props {
  view: RunsView;
  onView: (view: RunsView) => void;
}

export function RunsPage({ view, onView }: Props) {
  const filter = view.scenario ? { scenario: view.scenario } : {};
  const { data, error, refetch } = useQuery(runs(filter));
  const older = useQuery(olderRuns(filter, data));
  const all = useMemo(() => joined(data ?? [], (data?.length ?? 0) >= PAGE ? (older.data ?? []) : []), [data, older.data]);
  if (error && !data) return <Failure error={error} onRetry={() => void refetch()} />;
  if (!data) return <Loading what="runs" />;
  if (data.length === 0) return <NoRuns />;
  return (
    <>
      {older.error ? <Failure error={older.error} onRetry={() => void older.refetch()} /> : null}
      <Listed runs={all} isPart={older.isLoading} view={view} onView={onView} />
    </>
  );
}

/** The newest runs, and those before them. */
function joined(newest: readonly ListedRun[], older: readonly ListedRun[]): ListedRun[] {
  const oldest = newest.at(-1)?.run ?? 0;
  return [...newest, ...older.filter(({ run }) => run < oldest)];
}

function NoRuns() {
  const navigate = useNavigate();
  return (
    <Empty
      icon="table"
      title="No runs yet"
      action={<Button onClick={() => navigate({ to: "/" })}>Open the studio</Button>}
    >
      Every run of a scenario is kept here with its parameters, metrics and traces. Start the first one in the
      studio.
    </Empty>
  );
}

const WAYS = [
  { value: "table", label: "Table" },
  { value: "space", label: "Plot" },
  { value: "lineage", label: "Lineage" },
  { value: "board", label: "Board" },
];

/** So many runs are named in an address at most. */
const MOST_NAMED = 5000;

/** The runs that are shown, as a file; all of them need not be named. */
function Exports({ shown, isAll, scenario, channels }: { shown: readonly ListedRun[]; isAll: boolean; scenario: string | undefined; channels: readonly string[] }) {
  const query = new URLSearchParams(scenario ? { scenario } : {});
  if (!isAll) query.set("runs", shown.map(({ run }) => run).join(","));
  for (const name of channels) query.append("columns", name);
  const ways = ["csv", "parquet", "json"].map((form) => ({ label: form.toUpperCase(), href: `/api/table?format=${form}&${query}` }));
  return (
    <ExportMenu
      label={isAll ? "Export" : `Export ${shown.length}`}
      ways={ways}
      disabled={shown.length === 0 || (!isAll && shown.length > MOST_NAMED)}
    />
  );
}

/** Without columns of channels. */
const NONE: readonly string[] = [];

interface ListedProps extends Props {
  runs: readonly ListedRun[];
  /** Older ones are on their way. */
  isPart: boolean;
}

function Listed({ runs: all, isPart, view, onView }: ListedProps) {
  const { q = "", scenario, only, as = "table" } = view;
  const [selected, setSelected] = useState<ReadonlySet<number>>(new Set());
  const { arrangement, arrange } = useArrangement();
  const channels = useChannelColumns(arrangement.channels ?? NONE, all);
  const every = useColumns(all, channels.columns);
  const [isAdding, setAdding] = useState(false);
  const columns = useMemo(() => arranged(every, arrangement), [every, arrangement]);
  const fixed = useMemo(() => pinnedOf(columns, arrangement), [columns, arrangement]);
  const filter = useMemo(() => filterOf(q, columns, textOf), [q, columns]);
  const hits = useMemo(() => {
    const passes = filter.test ?? (() => true); // what cannot be read hides nothing
    return new Set(all.filter((run) => passes(run) && (!only || run.status === only || run.verdict === only)).map(({ run }) => run));
  }, [all, filter, only]);
  // A run chosen for comparison, or pinned, stays in the table whatever the filter says.
  const pinned = useMemo(() => new Set(pinsOf(view.pins)), [view.pins]);
  const shown = useMemo(() => all.filter(({ run }) => hits.has(run) || selected.has(run) || pinned.has(run)), [all, hits, selected, pinned]);
  const onPins = (next: readonly number[]) => onView({ ...view, pins: next.length ? next.join(",") : undefined });
  const pin = (run: number) => onPins(pinned.has(run) ? [...pinned].filter((each) => each !== run) : [...pinned, run]);
  const [judged, setJudged] = useState<Judged>();
  const [hovered, setHovered] = useState<number>();
  const onJudge = (run: ListedRun, word: Word) => setJudged({ run, word });
  const pick = (runs: readonly { run: number }[], isPicked: boolean) =>
    setSelected((before) => {
      const after = new Set(before);
      for (const { run } of runs) isPicked ? after.add(run) : after.delete(run);
      return after;
    });
  const toggle = (run: number) => pick([{ run }], !selected.has(run));

  return (
    <div className={classes.page}>
      <Group className={classes.top} gap="sm">
        <Title order={1} fz="lg">
          Runs
        </Title>
        <Text size="sm" c="dimmed">
          {shown.length === all.length ? all.length : `${shown.length} of ${all.length}`}
          {isPart ? ", older ones are being loaded …" : ""}
        </Text>
        <SegmentedControl
          size="xs"
          transitionDuration={0}
          aria-label="Shown as"
          value={as}
          onChange={(next) => onView({ ...view, as: next === "table" ? undefined : (next as RunsView["as"]) })}
          data={WAYS}
        />
        <Counts runs={all} only={only} onOnly={(next) => onView({ ...view, only: next })} />
        {scenario ? (
          <Button
            size="compact-xs"
            variant="light"
            rightSection={<Icon name="close" size={12} />}
            aria-label={`Show the runs of all scenarios, not only ${scenario}`}
            onClick={() => onView({ ...view, scenario: undefined })}
          >
            {scenario}
          </Button>
        ) : null}
        <Group gap="sm" ml="auto" align="flex-start">
          {as === "table" || as === "space" ? (
            <Switch
              size="xs"
              mt={6}
              label="Only columns that vary"
              checked={view.varying !== false}
              onChange={(event) =>
                onView({ ...view, varying: event.currentTarget.checked ? undefined : false })
              }
            />
          ) : null}
          {as === "table" || as === "space" ? <GroupSelect columns={every} by={view.by} onBy={(by) => onView({ ...view, by })} /> : null}
          {as === "table" || as === "space" ? <ColumnMenu columns={every} arrangement={arrangement} onArrange={arrange} onAdd={() => setAdding(true)} /> : null}
          <FilterField text={q} wrong={filter.wrong} columns={columns} onText={(next) => onView({ ...view, q: next || undefined })} />
          <Exports shown={shown} isAll={shown.length === all.length} scenario={scenario} channels={arrangement.channels ?? NONE} />
          {as === "table" ? <PinButton selected={selected} pinned={pinned} onPins={onPins} /> : null}
          <CompareButton selected={selected} />
        </Group>
      </Group>
      {channels.refused ? <Failure error={channels.refused} onRetry={channels.retry} /> : null}
      <ChannelDialog isOpen={isAdding} onClose={() => setAdding(false)} runs={all} onAdd={(name) => arrange(withChannel(arrangement, name))} />
      <Many runs={all} selected={selected} onClear={() => setSelected(new Set())} />
      {as === "space" ? (
        <Space
          runs={all}
          shown={hits}
          columns={columns}
          text={q}
          bounds={filter.bounds ?? []}
          draw={view.draw}
          axes={view.axes}
          onView={(next) => onView({ ...view, ...next })}
          onFilter={(next) => onView({ ...view, q: next || undefined })}
          onHover={setHovered}
        />
      ) : null}
      {shown.length === 0 ? (
        <Empty
          icon="search"
          title={`No run matches “${[q, only].filter(Boolean).join(", ")}”`}
          action={
            <Button size="xs" variant="default" onClick={() => onView({ ...view, q: undefined, only: undefined })}>
              Clear the filter
            </Button>
          }
        >
          A word is looked for in the number, scenario, status, error, verdict, name, tags and what was set; a comparison such as
          headway &lt; 0.8 in a column.
        </Empty>
      ) : as === "lineage" ? (
        <Lineage runs={shown} selected={selected} onToggle={toggle} />
      ) : as === "board" ? (
        <Board runs={shown} onJudge={onJudge} />
      ) : (
        <RunsTable
          runs={shown}
          all={all}
          columns={columns}
          hidden={arrangement.hidden}
          fixed={fixed}
          onFix={(column) => arrange(withPin(arrangement, column))}
          base={all.find(({ run }) => run === view.base)}
          pinned={pinned}
          hovered={hovered}
          view={view}
          selected={selected}
          onView={onView}
          onToggle={toggle}
          onPick={pick}
          onJudge={onJudge}
          onPin={pin}
          onBase={(run) => onView({ ...view, base: run === view.base ? undefined : run })}
        />
      )}
      <VerdictDialog judged={judged} onChange={setJudged} />
    </div>
  );
}

/** Pins the chosen runs on top; when all of them are, or none is chosen, lets go. */
function PinButton({ selected, pinned, onPins }: { selected: ReadonlySet<number>; pinned: ReadonlySet<number>; onPins: (runs: readonly number[]) => void }) {
  const chosen = [...selected];
  const isBack = chosen.every((run) => pinned.has(run));
  if (chosen.length === 0 && pinned.size === 0) return null;
  const rest = chosen.length === 0 ? [] : [...pinned].filter((run) => !selected.has(run));
  return (
    <Button
      size="xs"
      variant="default"
      title="Pinned runs stay on top, whatever is sorted or filtered (p on a row)"
      onClick={() => onPins(isBack ? rest : [...new Set([...pinned, ...chosen])])}
    >
      {isBack ? `Unpin ${chosen.length || pinned.size}` : `Pin ${chosen.length} on top`}
    </Button>
  );
}

/** The way to the comparison; the oldest of the selected runs is what the others are compared with. */
function CompareButton({ selected }: { selected: ReadonlySet<number> }) {
  const navigate = useNavigate();
  const enough = selected.size > 1 && selected.size <= MOST;
  const sorted = [...selected].sort((one, other) => one - other);
  const open = () => navigate({ to: "/compare", search: { runs: sorted.join(",") } });
  useShortcuts(enough ? { X: open } : {});
  return (
    <Button
      size="xs"
      data-testid="compare-button"
      leftSection={<Icon name="compare" size={14} />}
      disabled={!enough}
      title={`Select two to ${MOST} rows (x), then compare them (Shift+X)`}
      onClick={open}
    >
      {enough ? `Compare ${sorted.map((run) => `#${run}`).join(", ")}` : selected.size > MOST ? `Compare at most ${MOST}` : "Select runs to compare"}
    </Button>
  );
}

/** By what the runs are grouped. */
function GroupSelect({ columns, by, onBy }: { columns: readonly Column[]; by: string | undefined; onBy: (by: string | undefined) => void }) {
  const data = useMemo(() => groupable(columns).map(({ id, title, unit }) => ({ value: id, label: withUnit(title, unit) })), [columns]);
  return (
    <Select
      size="xs"
      w={150}
      aria-label="Group by"
      placeholder="Group by"
      clearable
      searchable
      clearButtonProps={{ "aria-label": "Not grouped" }}
      data={data}
      value={data.some(({ value }) => value === by) ? (by ?? null) : null}
      onChange={(next) => onBy(next ?? undefined)}
      comboboxProps={{ width: 240, position: "bottom-start" }}
    />
  );
}

interface Judged {
  run: ListedRun;
  word: Word;
}

/** Decide about a run without leaving the table. */
function VerdictDialog({ judged, onChange }: { judged: Judged | undefined; onChange: (next: Judged | undefined) => void }) {
  const close = () => onChange(undefined);
  return (
    <Modal opened={judged !== undefined} onClose={close} title={`Verdict on run #${judged?.run.run ?? ""}`} size="md">
      {judged ? (
        <VerdictForm
          run={judged.run}
          word={judged.word}
          onWord={(word) => onChange({ ...judged, word })}
          onDone={close}
          autoFocus
        />
      ) : null}
    </Modal>
  );
}

interface CountsProps {
  runs: readonly ListedRun[];
  only: string | undefined;
  onOnly: (next: string | undefined) => void;
}

/** How many there are of each status and verdict; pressed, only those are shown. */
function Counts({ runs: all, only, onOnly }: CountsProps) {
  const verdicts = countBy(all, ({ verdict }) => verdict).filter(([word]) => word !== "open");
  const counts: [string, number][] = [...countByStatus(all), ...verdicts];
  return (
    <Group gap={6} data-testid="status-counts">
      {counts.map(([word, count]) => (
        <Badge
          key={word}
          component="button"
          type="button"
          className={classes.chip}
          variant={word === only ? "light" : "default"}
          size="sm"
          tt="none"
          style={{ cursor: "pointer" }}
          aria-pressed={word === only}
          title={word === only ? "Show all runs again" : `Show only what is ${word}`}
          onClick={() => onOnly(word === only ? undefined : word)}
        >
          {count} {word}
        </Badge>
      ))}
    </Group>
  );
}
