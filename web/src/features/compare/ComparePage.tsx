/** Two runs side by side: what was different in, what came out, and how it went. */

import { ActionIcon, Badge, Button, Group, NativeSelect, Table, Text, Title, Tooltip } from "@mantine/core";
import { useQuery } from "@tanstack/react-query";
import { Link, useNavigate } from "@tanstack/react-router";
import { useGlossary } from "../../api/glossary";
import { comparison, runs } from "../../api/queries";
import type { Comparison } from "../../api/types";
import { useUnits } from "../../api/units";
import {
  differing,
  type MetricDifference,
  type ParameterDifference,
  tally,
  type Verdict,
  verdict,
} from "../../model/compare";
import { unitAt } from "../../model/form";
import { explained, titleOf } from "../../model/measure";
import type { Run } from "../../model/run";
import { whom } from "../../model/scope";
import {
  formatDifference,
  formatNumber,
  formatRelative,
  formatTime,
  formatValue,
  withUnit,
  words,
} from "../../model/units";
import { Icon } from "../../ui/Icon";
import { Path } from "../../ui/Path";
import { Empty, Failure, Loading } from "../../ui/State";
import { StatusBadge } from "../../ui/StatusBadge";
import classes from "./Compare.module.css";
import { Overlay } from "./Overlay";

interface Props {
  a: number | undefined;
  b: number | undefined;
  onChoose: (a: number | undefined, b: number | undefined) => void;
}

export function ComparePage({ a, b, onChoose }: Props) {
  const { data: all, error } = useQuery(runs());
  if (error && !all) return <Failure error={error} />;
  if (!all) return <Loading what="runs" />;
  return (
    <div className={classes.page}>
      <Group gap="sm" wrap="nowrap">
        <Title order={1} fz="lg">
          Compare
        </Title>
        <Side name="A" run={a} all={all} onChange={(next) => onChoose(next, b)} />
        <Tooltip label="Swap A and B">
          <ActionIcon
            variant="default"
            size={30}
            aria-label="Swap A and B"
            data-testid="swap"
            onClick={() => onChoose(b, a)}
          >
            <Icon name="swap" />
          </ActionIcon>
        </Tooltip>
        <Side name="B" run={b} all={all} onChange={(next) => onChoose(a, next)} />
      </Group>
      {a === undefined || b === undefined ? <Choose few={all.length < 2} /> : <Compared a={a} b={b} />}
    </div>
  );
}

function Choose({ few }: { few: boolean }) {
  const navigate = useNavigate();
  if (!few)
    return (
      <Empty icon="compare" title="Choose two runs">
        Pick A and B above, or select two rows in the table of runs.
      </Empty>
    );
  return (
    <Empty
      icon="compare"
      title="There are not two runs yet"
      action={<Button onClick={() => navigate({ to: "/" })}>Open the studio</Button>}
    >
      Run a scenario, change a parameter and run it again: the two are compared here.
    </Empty>
  );
}

interface SideProps {
  name: "A" | "B";
  run: number | undefined;
  all: readonly Run[];
  onChange: (run: number | undefined) => void;
}

/** Choose a side in place; the line that stands for it in the charts is shown beside. */
function Side({ name, run, all, onChange }: SideProps) {
  const known = all.some((other) => other.run === run);
  const choices = all.map((other) => ({
    value: String(other.run),
    label: `#${other.run} ${other.scenario}, ${other.status}`,
  }));
  return (
    <Group gap={6} wrap="nowrap">
      <svg width="26" height="10" aria-hidden="true">
        <line
          x1="0"
          y1="5"
          x2="26"
          y2="5"
          stroke="currentColor"
          strokeWidth="2.5"
          strokeDasharray={name === "B" ? "6 4" : undefined}
        />
      </svg>
      <b>{name}</b>
      <NativeSelect
        size="xs"
        aria-label={`Run ${name}`}
        data-testid={`compare-${name.toLowerCase()}`}
        value={run === undefined ? "" : String(run)}
        onChange={({ currentTarget: { value } }) => onChange(value === "" ? undefined : Number(value))}
        data={[
          { value: "", label: "Choose a run" },
          ...(run !== undefined && !known ? [{ value: String(run), label: `#${run}` }] : []),
          ...choices,
        ]}
      />
    </Group>
  );
}

function Compared({ a, b }: { a: number; b: number }) {
  const { data, error, refetch } = useQuery(comparison(a, b));
  if (error) return <Failure error={error} onRetry={() => void refetch()} />;
  if (!data) return <Loading what="the comparison" />;
  return (
    <>
      <div className={classes.tables}>
        <Parameters comparison={data} />
        <Metrics comparison={data} />
      </div>
      <Overlay a={data.a} b={data.b} />
    </>
  );
}

function Heads({ comparison: { a, b } }: { comparison: Comparison }) {
  return [
    { side: "A", run: a },
    { side: "B", run: b },
  ].map(({ side, run }) => (
    <Table.Th key={side} ta="right">
      {side}:{" "}
      <Link to="/runs/$run" params={{ run: String(run.run) }} className={classes.link}>
        #{run.run}
      </Link>
    </Table.Th>
  ));
}

function Parameters({ comparison: found }: { comparison: Comparison }) {
  const { a, b, parameters } = found;
  const units = useUnits([a, b]);
  const rows = parameters.some(({ path }) => path === "seed")
    ? parameters
    : [...parameters, ...seedDifference(a, b)];
  return (
    <section className={classes.card} data-testid="compare-parameters">
      <h2>What differs</h2>
      {a.scenario === b.scenario ? null : (
        <Text size="xs" c="dimmed" mb={6}>
          The runs are of two scenarios: {a.scenario} and {b.scenario}.
        </Text>
      )}
      {rows.length === 0 ? (
        <Text size="sm" c="dimmed">
          No parameter differs.
        </Text>
      ) : (
        <Table verticalSpacing={4} horizontalSpacing={8} fz="sm" className={classes.figures}>
          <Table.Thead>
            <Table.Tr>
              <Table.Th>Parameter</Table.Th>
              <Heads comparison={found} />
            </Table.Tr>
          </Table.Thead>
          <Table.Tbody>
            {rows.map(({ path, a: one, b: other, unit }) => (
              <Table.Tr key={path}>
                <Table.Td className={classes.path}>
                  <Path path={withUnit(path, unit || unitAt(units, path))} />
                </Table.Td>
                <Table.Td ta="right">{formatValue(one)}</Table.Td>
                <Table.Td ta="right">
                  <b>{formatValue(other)}</b>
                </Table.Td>
              </Table.Tr>
            ))}
          </Table.Tbody>
        </Table>
      )}
      <Group gap="md" mt="sm">
        {[a, b].map((run, index) => (
          <Group key={index === 0 ? "A" : "B"} gap={6}>
            <Text size="xs" c="dimmed">
              {index === 0 ? "A" : "B"} #{run.run}
              {run.parent === null ? "" : `, child of #${run.parent}`}
            </Text>
            <StatusBadge status={run.status} error={run.error} unmet={run.unmet} />
          </Group>
        ))}
      </Group>
    </section>
  );
}

const seedDifference = (a: Run, b: Run): ParameterDifference[] =>
  a.seed === b.seed ? [] : [{ path: "seed", a: a.seed, b: b.seed, unit: "" }];

const VERDICTS: Record<Verdict, { color: string; text: string }> = {
  better: { color: "teal", text: "▲ better" },
  worse: { color: "orange", text: "▼ worse" },
  same: { color: "gray", text: "= same" },
  "no goal": { color: "gray", text: "no goal" },
  "not ranked": { color: "gray", text: "not ranked" },
  missing: { color: "gray", text: "only one side" },
};

function Metrics({ comparison: found }: { comparison: Comparison }) {
  const { metrics, unranked, alike } = found;
  const counts = tally(metrics, unranked);
  return (
    <section className={classes.card} data-testid="compare-metrics">
      <h2>
        Metrics{" "}
        {unranked ? null : (
          <Text span size="xs" c="dimmed">
            B is better in {counts.better}, worse in {counts.worse}, the same in {counts.same}: {formatNumber(100 * alike)} % and less
            may be chance
          </Text>
        )}
      </h2>
      {unranked ? (
        <Text size="sm" role="note" mb={6}>
          {unranked}
        </Text>
      ) : null}
      {metrics.length === 0 ? (
        <Text size="sm" c="dimmed">
          Neither run has metrics.
        </Text>
      ) : (
        <Table verticalSpacing={4} horizontalSpacing={8} fz="sm" className={classes.figures}>
          <Table.Thead>
            <Table.Tr>
              <Table.Th>Metric</Table.Th>
              <Heads comparison={found} />
              <Table.Th ta="right">B − A</Table.Th>
              <Table.Th ta="right">Relative</Table.Th>
              <Table.Th>B is</Table.Th>
            </Table.Tr>
          </Table.Thead>
          <Table.Tbody>
            {metrics.map((metric) => (
              <MetricRow key={metric.name} metric={metric} comparison={found} />
            ))}
          </Table.Tbody>
        </Table>
      )}
    </section>
  );
}

function MetricRow({ metric, comparison: { unranked, ...runs } }: { metric: MetricDifference; comparison: Comparison }) {
  const { name, unit, goal } = metric;
  const { difference, relative } = differing(metric);
  const known = useGlossary().metrics;
  const found = verdict(metric, unranked);
  const { color, text } = VERDICTS[found];
  return (
    <Table.Tr data-metric={name} data-verdict={found}>
      <Table.Td title={`${explained(name, known)}\n${goal ? `${words(goal)} is better` : "No goal is set"}`}>
        {withUnit(titleOf(name, known), unit)}
      </Table.Td>
      <MetricCell value={metric.a} run={runs.a} name={name} />
      <MetricCell value={metric.b} run={runs.b} name={name} />
      <Table.Td ta="right">
        {difference === null ? "–" : formatDifference(Number(difference.toPrecision(4)))}
      </Table.Td>
      <Table.Td ta="right">{relative === null ? "–" : formatRelative(relative)}</Table.Td>
      <Table.Td>
        <Badge
          size="sm"
          variant={found === "better" || found === "worse" ? "light" : "transparent"}
          color={color}
          tt="none"
          miw={76}
        >
          {text}
        </Badge>
      </Table.Td>
    </Table.Tr>
  );
}

/** A value, whom it is about, and when that was; a click goes there. */
function MetricCell({ value, run, name }: { value: number | null; run: Run; name: string }) {
  const { about = "", time = null } = run.metrics[name] ?? {};
  return (
    <Table.Td ta="right">
      {value === null ? "–" : formatNumber(value)}
      {about ? (
        <Text size="xs" c="dimmed" className={classes.about}>
          {whom(about, time)}{" "}
          {time === null ? null : (
            <Link
              to="/studio/$scenario"
              params={{ scenario: run.scenario }}
              search={{ run: run.run, time }}
              className={classes.link}
              title="Go there"
            >
              at {formatTime(time)} s
            </Link>
          )}
        </Text>
      ) : null}
    </Table.Td>
  );
}
