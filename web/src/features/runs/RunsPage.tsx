/** All runs in one table: what was set, what came out, and which to compare. */

import { Badge, Button, Group, Modal, Switch, Text, TextInput, Title } from "@mantine/core";
import { useQuery } from "@tanstack/react-query";
import { useNavigate } from "@tanstack/react-router";
import { useMemo, useRef, useState } from "react";
import { runs } from "../../api/queries";
import { MOST } from "../../model/beside";
import { countBy, countByStatus, type ListedRun } from "../../model/run";
import { filtered } from "../../model/table";
import type { Word } from "../../model/verdict";
import { Icon } from "../../ui/Icon";
import { Empty, Failure, Loading } from "../../ui/State";
import { useShortcuts } from "../../ui/shortcut";
import classes from "./Runs.module.css";
import { RunsTable } from "./RunsTable";
import { VerdictForm } from "./VerdictForm";

/** What the address says about the table. */
export interface RunsView {
  scenario?: string | undefined;
  q?: string | undefined;
  sort?: string | undefined;
  varying?: boolean | undefined;
  /** A status or verdict that is shown alone. */
  only?: string | undefined;
}

interface Props {
  view: RunsView;
  onView: (view: RunsView) => void;
}

export function RunsPage({ view, onView }: Props) {
  const { data, error, refetch } = useQuery(runs(view.scenario ? { scenario: view.scenario } : {}));
  if (error && !data) return <Failure error={error} onRetry={() => void refetch()} />;
  if (!data) return <Loading what="runs" />;
  if (data.length === 0) return <NoRuns />;
  return <Listed runs={data} view={view} onView={onView} />;
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

function Listed({ runs: all, view, onView }: Props & { runs: readonly ListedRun[] }) {
  const { q = "", scenario, only } = view;
  const [selected, setSelected] = useState<number[]>([]);
  const search = useRef<HTMLInputElement>(null);
  useShortcuts({ "/": () => search.current?.focus() });
  // A run chosen for comparison stays in the table whatever the filter says.
  const shown = useMemo(() => {
    const hits = new Set(filtered(all, q));
    const is = (run: ListedRun) => hits.has(run) && (!only || run.status === only || run.verdict === only);
    return all.filter((run) => is(run) || selected.includes(run.run));
  }, [all, q, only, selected]);
  const [judged, setJudged] = useState<Judged>();
  const toggle = (run: number) =>
    setSelected(
      selected.includes(run) ? selected.filter((other) => other !== run) : [...selected, run].slice(-MOST),
    );

  return (
    <div className={classes.page}>
      <Group className={classes.top} gap="sm">
        <Title order={1} fz="lg">
          Runs
        </Title>
        <Text size="sm" c="dimmed">
          {shown.length === all.length ? all.length : `${shown.length} of ${all.length}`}
        </Text>
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
        <Group gap="sm" ml="auto">
          <Switch
            size="xs"
            label="Only columns that vary"
            checked={view.varying !== false}
            onChange={(event) =>
              onView({ ...view, varying: event.currentTarget.checked ? undefined : false })
            }
          />
          <TextInput
            ref={search}
            size="xs"
            w={230}
            placeholder="Filter, e.g. failed or headway=0.9 (/)"
            aria-label="Filter the runs"
            leftSection={<Icon name="search" size={14} />}
            value={q}
            onChange={(event) => onView({ ...view, q: event.currentTarget.value || undefined })}
          />
          <CompareButton selected={selected} />
        </Group>
      </Group>
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
          The filter looks at the number, scenario, status, error, verdict, name, tags, seed, parent and what was set.
        </Empty>
      ) : (
        <RunsTable
          runs={shown}
          all={all}
          view={view}
          onView={onView}
          selected={selected}
          onToggle={toggle}
          onJudge={(run, word) => setJudged({ run, word })}
        />
      )}
      <VerdictDialog judged={judged} onChange={setJudged} />
    </div>
  );
}

/** The way to the comparison; the oldest of the selected runs is what the others are compared with. */
function CompareButton({ selected }: { selected: readonly number[] }) {
  const navigate = useNavigate();
  const enough = selected.length > 1;
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
      {enough ? `Compare ${sorted.map((run) => `#${run}`).join(", ")}` : "Select runs to compare"}
    </Button>
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
