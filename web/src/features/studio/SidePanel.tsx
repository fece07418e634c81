/** The latest runs of this scenario, and what happened in the one that is shown. */

import { Badge, Button, Checkbox, ScrollArea, Tabs, Text, Tooltip } from "@mantine/core";
import { useQuery } from "@tanstack/react-query";
import { Link, useNavigate } from "@tanstack/react-router";
import { memo, useState } from "react";
import { useGlossary } from "../../api/glossary";
import { kinds as kindsQuery, runs } from "../../api/queries";
import { MOST } from "../../model/beside";
import { fromSet } from "../../model/form";
import { isLive, leaf, type Run, type RunDetail, type RunEvent, type Status } from "../../model/run";
import { formatMoment, formatValue, words } from "../../model/units";
import { EventList } from "../../ui/EventList";
import { Icon } from "../../ui/Icon";
import { MetricList } from "../../ui/MetricList";
import { Empty, Loading } from "../../ui/State";
import { StatusBadge } from "../../ui/StatusBadge";
import { type Playhead, useMoment } from "./playhead";
import { Seeds } from "./Seeds";
import classes from "./Studio.module.css";

interface Props {
  scenario: string;
  run: number | undefined;
  /** That run, as soon as it is known. */
  detail: RunDetail | undefined;
  /** How that run stands now, which the list of runs learns only later. */
  status: Status | undefined;
  events: readonly RunEvent[];
  /** Of a run that is played back. */
  head: Playhead | undefined;
}

export const SidePanel = memo(function SidePanel({ scenario, run, detail, status, events, head }: Props) {
  return (
    <Tabs defaultValue="runs" className={classes.side} keepMounted={false}>
      <Tabs.List>
        <Tabs.Tab value="runs">Runs</Tabs.Tab>
        <Tabs.Tab
          value="events"
          rightSection={
            events.length ? (
              <Badge size="xs" variant="light">
                {events.length}
              </Badge>
            ) : null
          }
        >
          Events
        </Tabs.Tab>
        <Tabs.Tab value="metrics">Metrics</Tabs.Tab>
        <Tabs.Tab value="seeds">Seeds</Tabs.Tab>
      </Tabs.List>
      <Tabs.Panel value="runs" className={classes.sideBody}>
        <History scenario={scenario} shown={run} status={status} />
      </Tabs.Panel>
      <Tabs.Panel value="events" className={classes.sideBody}>
        <Events events={events} head={head} />
      </Tabs.Panel>
      <Tabs.Panel value="metrics" className={classes.sideBody}>
        <Metrics run={detail} head={head} />
      </Tabs.Panel>
      <Tabs.Panel value="seeds" className={classes.sideBody}>
        <Seeds scenario={scenario} run={detail} />
      </Tabs.Panel>
    </Tabs>
  );
});

interface HistoryProps {
  scenario: string;
  shown: number | undefined;
  status: Status | undefined;
}

function History({ scenario, shown, status }: HistoryProps) {
  const { data } = useQuery(runs({ scenario, limit: 30 }));
  const [selected, setSelected] = useState<number[]>([]);
  const navigate = useNavigate();
  if (!data) return <Loading what="runs" />;
  if (data.length === 0) {
    return (
      <Empty icon="table" title="No runs of this scenario">
        Each run is kept here with what was changed for it.
      </Empty>
    );
  }
  const toggle = (number: number) =>
    setSelected((before) =>
      before.includes(number) ? before.filter((other) => other !== number) : [...before, number].slice(-MOST),
    );
  const sorted = [...selected].sort((one, other) => one - other);
  return (
    <>
      <ScrollArea className={classes.history} classNames={{ content: classes.historyContent ?? "" }} type="auto">
        {data.map((run) => (
          <HistoryRow
            key={run.run}
            run={run}
            status={run.run === shown ? current(run, status) : run.status}
            shown={run.run === shown}
            selected={selected.includes(run.run)}
            onToggle={() => toggle(run.run)}
          />
        ))}
      </ScrollArea>
      <div className={classes.sideFoot}>
        <Button
          size="compact-xs"
          variant="light"
          data-testid="compare-button"
          leftSection={<Icon name="compare" size={13} />}
          disabled={sorted.length < 2}
          onClick={() => navigate({ to: "/compare", search: { runs: sorted.join(",") } })}
        >
          {sorted.length > 1 ? `Compare ${sorted.map((each) => `#${each}`).join(", ")}` : "Select to compare"}
        </Button>
        <Link to="/runs" search={{ scenario }} className={classes.all}>
          All runs
        </Link>
      </div>
    </>
  );
}

/** A run that has ended in the list stays so, whatever was heard of it last. */
const current = (run: Run, status: Status | undefined): Status =>
  isLive(run.status) && status !== undefined ? status : run.status;

interface RowProps {
  run: Run;
  status: Status;
  shown: boolean;
  selected: boolean;
  onToggle: () => void;
}

function HistoryRow({ run, status, shown, selected, onToggle }: RowProps) {
  return (
    <div
      className={classes.historyRow}
      data-testid="history-row"
      data-run={run.run}
      data-shown={shown || undefined}
    >
      <Checkbox
        size="xs"
        checked={selected}
        onChange={onToggle}
        aria-label={`Select run ${run.run} to compare`}
      />
      <Link to="/runs/$run" params={{ run: String(run.run) }} className={classes.historyRun}>
        #{run.run}
      </Link>
      <Tooltip label={<Setting run={run} />} multiline maw={360} openDelay={300}>
        <Text size="xs" truncate span tabIndex={0} title={settingText(run)}>
          {settingText(run)}
        </Text>
      </Tooltip>
      <StatusBadge status={status} error={run.error} unmet={run.unmet} />
    </div>
  );
}

/** What was set for the run, in one line. */
function settingText({ parameters }: Run): string {
  const set = Object.entries(fromSet(parameters)).map(
    ([path, value]) => `${words(leaf(path))} ${formatValue(value)}`,
  );
  return set.length ? set.join(", ") : "As in the file";
}

function Setting({ run }: { run: Run }) {
  return (
    <>
      <Text size="xs">
        {formatMoment(run.created)}, seed {run.seed}
        {run.parent === null ? "" : `, child of #${run.parent}`}
      </Text>
      {Object.entries(fromSet(run.parameters)).map(([path, value]) => (
        <Text size="xs" key={path}>
          {path} = {formatValue(value)}
        </Text>
      ))}
    </>
  );
}

function Metrics({ run, head }: { run: RunDetail | undefined; head: Playhead | undefined }) {
  const known = useGlossary().metrics;
  const { data } = useQuery(kindsQuery);
  if (!run || Object.keys(run.metrics).length === 0) {
    return (
      <Empty icon="table" title="No metrics yet">
        They are computed when the run that is shown ends.
      </Empty>
    );
  }
  return (
    <ScrollArea className={classes.history} classNames={{ content: classes.historyContent ?? "" }} type="auto">
      <MetricList run={run} known={known} kinds={data?.kinds ?? []} onSeek={head?.seek} />
    </ScrollArea>
  );
}

function Events({ events, head }: { events: readonly RunEvent[]; head: Playhead | undefined }) {
  const time = useMoment(head, 0.1);
  if (events.length === 0) {
    return (
      <Empty icon="warning" title="No events yet">
        Warnings, lost messages and collisions of the run that is shown.
      </Empty>
    );
  }
  return (
    <ScrollArea className={classes.history} classNames={{ content: classes.historyContent ?? "" }} type="auto">
      <EventList events={events} now={time} onSeek={head?.seek} />
    </ScrollArea>
  );
}
