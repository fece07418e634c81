/** The metrics of a run: of whom, when, in which window, and what they are; a click on a time goes there. */

import { Badge, Table, Text, Tooltip } from "@mantine/core";
import type { KnownKind } from "../model/form";
import { type Measure, titleOf } from "../model/measure";
import type { Metric, RunDetail } from "../model/run";
import { settingsOf, whom, windowOf } from "../model/scope";
import { formatNumber, formatTime, unitText } from "../model/units";
import classes from "./MetricList.module.css";

interface Props {
  run: Pick<RunDetail, "metrics" | "unmet" | "document">;
  /** The server's words for them. */
  known: readonly Measure[];
  kinds: readonly KnownKind[];
  /** Go to a time [s] of the run; left out where there is none to go to. */
  onSeek?: ((time: number) => void) | undefined;
}

const GOALS = { higher: "higher is better", lower: "lower is better" };

export function MetricList({ run, ...shared }: Props) {
  const rows = Object.entries(run.metrics);
  if (rows.length === 0)
    return (
      <Text size="sm" c="dimmed">
        No metrics: they are computed when a run ends.
      </Text>
    );
  return (
    <Table verticalSpacing={3} horizontalSpacing={6} fz="sm" data-testid="metrics">
      <Table.Tbody>
        {rows.map(([name, metric]) => (
          <MetricRow key={name} name={name} metric={metric} run={run} {...shared} />
        ))}
      </Table.Tbody>
    </Table>
  );
}

function MetricRow({ name, metric, run, known, kinds, onSeek }: Props & { name: string; metric: Metric }) {
  const { value, unit, goal } = metric;
  return (
    <Table.Tr data-metric={name}>
      <Table.Td>
        <details className={classes.definition}>
          <summary>
            {titleOf(name, known)}
            <Unmet sentence={run.unmet.find((sentence) => sentence.startsWith(`${name} `))} />
          </summary>
          <Definition name={name} metric={metric} run={run} known={known} kinds={kinds} />
        </details>
        {goal ? (
          <Text size="xs" c="dimmed">
            {GOALS[goal]}
          </Text>
        ) : null}
        <About metric={metric} onSeek={onSeek} />
      </Table.Td>
      <Table.Td ta="right" className={classes.value}>
        <b>{value === null ? "–" : formatNumber(value)}</b>
      </Table.Td>
      <Table.Td c="dimmed" className={classes.value}>
        {unitText(unit)}
      </Table.Td>
    </Table.Tr>
  );
}

/** What exactly is measured, in which part of the run, and under which name goals and sweeps call it. */
function Definition({ name, metric, run, known, kinds }: Omit<Props, "onSeek"> & { name: string; metric: Metric }) {
  const kind = metric.kind || name;
  const explanation = known.find((each) => each.name === kind)?.explanation;
  const settings = settingsOf(run.document, name, kinds);
  return (
    <div className={classes.text}>
      {explanation ? <p>{explanation}</p> : null}
      {settings.length ? <p>{settings.join(", ")}.</p> : null}
      <p>Measured over {windowOf(run.document, name)}.</p>
      <p>
        <code>{name}</code>
        {kind === name ? "" : ` (${kind})`}
      </p>
    </div>
  );
}

/** Whom it is about, and when that was. */
function About({ metric: { about, time }, onSeek }: { metric: Metric } & Pick<Props, "onSeek">) {
  if (!about && time === null) return null;
  return (
    <Text size="xs">
      {whom(about, time)}{" "}
      {time === null ? null : !onSeek ? (
        `at ${formatTime(time)} s`
      ) : (
        <button type="button" className={classes.time} title="Go there" onClick={() => onSeek(time)}>
          at {formatTime(time)} s
        </button>
      )}
    </Text>
  );
}

function Unmet({ sentence }: { sentence: string | undefined }) {
  if (!sentence) return null;
  return (
    <Tooltip label={sentence}>
      <Badge
        size="xs"
        color="orange"
        variant="light"
        tt="none"
        ml={6}
        tabIndex={0}
        aria-label={`Goal not met: ${sentence}`}
      >
        goal not met
      </Badge>
    </Tooltip>
  );
}
