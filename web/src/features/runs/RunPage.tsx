/** Everything about one run, and the way on from it. */

import { Anchor, Badge, Button, Code, Group, Table, Text, Title } from "@mantine/core";
import { useQuery } from "@tanstack/react-query";
import { Link, useNavigate } from "@tanstack/react-router";
import { type ReactNode, useMemo, useState } from "react";
import { useGlossary } from "../../api/glossary";
import { beyond as beyondQuery, explanations, kinds as kindsQuery, run as runQuery, runs as runsQuery, trace, useAggregates } from "../../api/queries";
import { useUnits } from "../../api/units";
import { type Columns, type Line, TimeChart } from "../../charts/TimeChart";
import { useZoom, type Zoom } from "../../charts/zoom";
import { beyondOf } from "../../model/beyond";
import { drawn, leadersOf, parts, type Quantity, quantity, recorded, vehiclesOf } from "../../model/channel";
import { fromSet, unitAt } from "../../model/form";
import { goalsOf, type Wanted } from "../../model/goal";
import { explained, titleOf } from "../../model/measure";
import { carColors, paintsOf } from "../../model/palette";
import { isLive, type RunDetail, untraced } from "../../model/run";
import { formatDuration, formatMoment, formatNumber, formatValue, unitText, words } from "../../model/units";
import { useDark } from "../../ui/dark";
import { EventList } from "../../ui/EventList";
import { ExplanationList } from "../../ui/ExplanationList";
import { Icon } from "../../ui/Icon";
import { MetricList } from "../../ui/MetricList";
import { Path } from "../../ui/Path";
import { QuantitySelect } from "../../ui/QuantitySelect";
import { Empty, Failure, Loading } from "../../ui/State";
import { StatusBadge } from "../../ui/StatusBadge";
import { VerdictBadge } from "../../ui/VerdictBadge";
import classes from "./Runs.module.css";
import { Aggregates } from "../../ui/Aggregates";
import { ExportMenu } from "./ExportMenu";
import { VerdictCard } from "./VerdictCard";

export function RunPage({ run }: { run: number }) {
  const { data, error, refetch } = useQuery(runQuery(run));
  if (error && !data) return <Failure error={error} onRetry={() => void refetch()} />;
  if (!data) return <Loading what={`run #${run}`} />;
  return <Detail run={data} />;
}

function Detail({ run }: { run: RunDetail }) {
  const navigate = useNavigate();
  const seek = (time: number) =>
    navigate({ to: "/studio/$scenario", params: { scenario: run.scenario }, search: { run: run.run, time } });
  return (
    <article className={classes.detail} data-testid="run-detail">
      <header className={classes.detailHead}>
        <Title order={1} fz="lg">
          Run #{run.run}
        </Title>
        <StatusBadge status={run.status} error={run.error} unmet={run.unmet} />
        <VerdictBadge verdict={run.verdict} reason={run.reason} />
        <Text c="dimmed" size="sm">
          {run.name ? `${run.name}, ${run.scenario}` : run.scenario}
        </Text>
        <Ways run={run} />
      </header>
      <div className={classes.column}>
        {run.error ? (
          <Card title="Why it failed">
            <pre className={classes.trace}>{run.error}</pre>
          </Card>
        ) : null}
        <Card title="Verdict">
          <VerdictCard run={run} onSeek={run.channels.length > 0 ? seek : undefined} />
        </Card>
        <Card title="Metrics">
          <Metrics run={run} onSeek={seek} />
        </Card>
        <Goals run={run} />
        <Card title="Parameters that were set">
          <Parameters run={run} />
        </Card>
        <Card title="About this run">
          <Facts run={run} />
        </Card>
      </div>
      <div className={classes.column}>
        <Charts run={run} />
        {isLive(run.status) || run.channels.length === 0 ? null : (
          <Card title="A channel in numbers">
            <Aggregates runs={[run]} useFound={useAggregates} />
          </Card>
        )}
        <Explanations run={run} onSeek={seek} />
        <Card title="Events">
          {run.events.length ? (
            <EventList events={run.events} onSeek={isLive(run.status) ? undefined : seek} />
          ) : (
            <Text size="sm" c="dimmed">
              {isLive(run.status)
                ? "They are listed here when the run is over; the studio shows them as they come."
                : "Nothing noteworthy happened."}
            </Text>
          )}
        </Card>
      </div>
    </article>
  );
}

/** What can be done with this run. */
function Ways({ run }: { run: RunDetail }) {
  const navigate = useNavigate();
  return (
    <Group gap="xs" ml="auto">
      {run.parent === null ? null : (
        <Button
          size="xs"
          variant="default"
          leftSection={<Icon name="compare" size={14} />}
          onClick={() => navigate({ to: "/compare", search: { runs: `${run.parent},${run.run}` } })}
        >
          Compare with its parent #{run.parent}
        </Button>
      )}
      <ExportMenu label="Report" ways={reportsOf(run.run)} />
      <ExportMenu label="Export" disabled={run.channels.length === 0} ways={exportsOf(run.run)} />
      <Button
        size="xs"
        variant="default"
        leftSection={<Icon name="eye" size={14} />}
        onClick={() =>
          navigate({ to: "/studio/$scenario", params: { scenario: run.scenario }, search: { run: run.run } })
        }
      >
        Open in the studio
      </Button>
      <Button
        size="xs"
        data-testid="tune"
        leftSection={<Icon name="branch" size={14} />}
        onClick={() =>
          navigate({ to: "/studio/$scenario", params: { scenario: run.scenario }, search: { from: run.run } })
        }
      >
        Tune from here
      </Button>
    </Group>
  );
}

/** The run on a page, to be kept, read and printed. */
const reportsOf = (run: number) => [
  { label: "A page, HTML", href: `/api/runs/${run}/report` },
  { label: "On paper, PDF", href: `/api/runs/${run}/report.pdf` },
];

/** What is recorded, in the forms that others read. */
const exportsOf = (run: number) => [
  { label: "All channels, Parquet", href: `/api/runs/${run}/recording?format=parquet` },
  { label: "All channels, CSV", href: `/api/runs/${run}/recording?format=csv` },
  { label: "Everything on one clock, MCAP (Foxglove)", href: `/api/runs/${run}/recording?format=mcap` },
  { label: "A notebook that reads it, Jupyter", href: `/api/runs/${run}/notebook` },
  { label: "Trajectories, CSV", href: `/api/runs/${run}/trajectories?format=csv` },
  { label: "Trajectories, SUMO FCD", href: `/api/runs/${run}/trajectories?format=fcd` },
];

function Card({ title, children }: { title: string; children: ReactNode }) {
  return (
    <section className={classes.card}>
      <h2>{title}</h2>
      {children}
    </section>
  );
}

/** Its times lead into the studio, where the run is played back. */
function Metrics({ run, onSeek }: { run: RunDetail; onSeek: (time: number) => void }) {
  const known = useGlossary().metrics;
  const { data } = useQuery(kindsQuery);
  return <MetricList run={run} known={known} kinds={data?.kinds ?? []} onSeek={onSeek} />;
}

/** Why somebody collided, nearly did, or braked hard: what was known, what was lost, who commanded, which tyre was at its limit. */
function Explanations({ run, onSeek }: { run: RunDetail; onSeek: (time: number) => void }) {
  const { data, error } = useQuery(explanations(run));
  if (error) return <Failure error={error} />;
  if (!data?.length) return null;
  return (
    <Card title="Why it happened">
      <ExplanationList explanations={data} onSeek={onSeek} />
    </Card>
  );
}

/** What the scenario wants of its metrics, and by how much that was met. */
function Goals({ run }: { run: RunDetail }) {
  const goals = goalsOf(run);
  if (goals.length === 0) return null;
  return (
    <Card title="Goals of the scenario">
      <Table verticalSpacing={3} horizontalSpacing={6} fz="sm" data-testid="goals">
        <Table.Thead>
          <Table.Tr>
            <Table.Th>Metric</Table.Th>
            <Table.Th>Wanted</Table.Th>
            <Table.Th ta="right">Value</Table.Th>
            <Table.Th>Met</Table.Th>
          </Table.Tr>
        </Table.Thead>
        <Table.Tbody>
          {goals.map((goal) => (
            <GoalRow key={`${goal.metric} ${goal.bound}`} goal={goal} />
          ))}
        </Table.Tbody>
      </Table>
    </Card>
  );
}

function GoalRow({ goal: { metric, bound, wanted, value, unit, margin } }: { goal: Wanted }) {
  const known = useGlossary().metrics;
  const met = margin === null ? "not measured" : margin >= 0 ? "met" : "not met";
  return (
    <Table.Tr>
      <Table.Td title={explained(metric, known)}>{titleOf(metric, known)}</Table.Td>
      <Table.Td>
        {bound === "least" ? "at least" : "at most"} {formatNumber(wanted)} {unitText(unit)}
      </Table.Td>
      <Table.Td ta="right" style={{ fontVariantNumeric: "tabular-nums", whiteSpace: "nowrap" }}>
        <b>{value === null ? "–" : formatNumber(value)}</b> {unitText(unit)}
      </Table.Td>
      <Table.Td>
        <Badge size="xs" color={met === "met" ? "teal" : "orange"} variant="light" tt="none">
          {met}
        </Badge>
        {margin === null ? null : (
          <Text size="xs" c="dimmed" style={{ whiteSpace: "nowrap" }}>
            {margin >= 0 ? "to spare" : "missed by"} {formatNumber(Math.abs(margin))} {unitText(unit)}
          </Text>
        )}
      </Table.Td>
    </Table.Tr>
  );
}

function Parameters({ run }: { run: RunDetail }) {
  const { parameters } = run;
  const units = useUnits([run]);
  const rows = Object.entries(fromSet(parameters));
  if (rows.length === 0)
    return (
      <Text size="sm" c="dimmed">
        None: the scenario ran as it stands in its file.
      </Text>
    );
  return (
    <dl className={classes.facts}>
      {rows.map(([path, value]) => (
        <Fact key={path} name={path}>
          <b>{formatValue(value)}</b> {unitAt(units, path)}
        </Fact>
      ))}
    </dl>
  );
}

function Fact({ name, children }: { name: string; children: ReactNode }) {
  return (
    <>
      <dt>
        <Path path={name} />
      </dt>
      <dd>{children}</dd>
    </>
  );
}

function Facts({ run }: { run: RunDetail }) {
  const { data: all = [] } = useQuery(runsQuery({ scenario: run.scenario }));
  const children = all.filter(({ parent }) => parent === run.run).map((child) => child.run);
  return (
    <dl className={classes.facts}>
      <Fact name="Scenario">{run.scenario}</Fact>
      <Fact name="Parent">{run.parent === null ? "none" : <RunLink run={run.parent} />}</Fact>
      <Fact name="Children">
        {children.length === 0 ? "none" : children.map((child) => <RunLink key={child} run={child} />)}
      </Fact>
      <Fact name="Seed">{run.seed}</Fact>
      <Fact name="Created">{formatMoment(run.created)}</Fact>
      <Fact name="Simulated">{run.sim_time_s === null ? "–" : formatDuration(run.sim_time_s)}</Fact>
      <Fact name="Took">{run.wall_time_s === null ? "–" : formatDuration(run.wall_time_s)}</Fact>
      <Fact name="Final state">
        <Hash text={run.state_hash} />
      </Fact>
      <Fact name="Scenario hash">
        <Hash text={run.scenario_hash} />
      </Fact>
      <Fact name="Code version">
        <Hash text={run.code_version} />
      </Fact>
    </dl>
  );
}

function RunLink({ run }: { run: number }) {
  return (
    <Anchor component={Link} to="/runs/$run" params={{ run: String(run) } as never} size="sm" mr={8}>
      #{run}
    </Anchor>
  );
}

const Hash = ({ text }: { text: string | null }) =>
  text ? <Code style={{ overflowWrap: "anywhere" }}>{text}</Code> : "–";

function Charts({ run }: { run: RunDetail }) {
  const names = useMemo(() => run.channels.map(({ name }) => name), [run.channels]);
  const quantities = recorded(run.channels, useGlossary().channels);
  const [chosen, setChosen] = useState(["speed", "gap"]);
  const zoom = useZoom(run.run);
  if (names.length === 0)
    return (
      <Empty icon="chart" title="No traces">
        {untraced(run.status)}
      </Empty>
    );
  return chosen.map((name, place) => (
    <section key={place} className={classes.card}>
      <QuantityChart
        run={run}
        shown={quantity(name, quantities)}
        all={names}
        zoom={zoom}
        lead={
          <QuantitySelect
            value={name}
            quantities={quantities}
            onChange={(next) => setChosen(chosen.map((old, index) => (index === place ? next : old)))}
          />
        }
      />
    </section>
  ));
}

interface ChartProps {
  run: RunDetail;
  shown: Quantity;
  all: readonly string[];
  zoom: Zoom;
  lead: ReactNode;
}

function QuantityChart({ run, shown: { name, label, unit }, all, zoom, lead }: ChartProps) {
  const dark = useDark();
  const channels = useMemo(() => drawn(name, all, leadersOf(run.document)), [name, all, run.document]);
  const { data: spanned } = useQuery(beyondQuery(run));
  const beyond = useMemo(() => beyondOf(spanned, channels.map((channel) => parts(channel).vehicle)), [spanned, channels]);
  const { data, error } = useQuery(trace(run.run, channels, { span: zoom.span, grows: isLive(run.status) }));
  const lines = useMemo<Line[]>(() => {
    const vehicles = vehiclesOf(all);
    const colors = carColors(vehicles, paintsOf(run.document), dark);
    return channels.map((channel) => {
      const { vehicle } = parts(channel);
      return { key: channel, label: words(vehicle), color: colors[vehicles.indexOf(vehicle)] as string };
    });
  }, [channels, all, run.document, dark]);
  const columns = useMemo<Columns>(
    () => (data ? [data.time, ...channels.map((channel) => data.channels[channel]?.values ?? [])] : [[]]),
    [data, channels],
  );
  if (error) return <Failure error={error} />;
  if (!data) return <Loading what="the trace" />;
  return (
    <div className={classes.chart}>
      <TimeChart title={label} unit={unit} lines={lines} data={columns} sync="run" zoom={zoom} lead={lead} beyond={beyond} />
    </div>
  );
}
