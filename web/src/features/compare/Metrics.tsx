/** What came out of each run, and how it stands against the first one. */

import { Table, Text } from "@mantine/core";
import { Link } from "@tanstack/react-router";
import { useGlossary } from "../../api/glossary";
import { changeOf, differs, goalsTold, type MetricBeside, type SideBySide, type Stand, standOf, tally } from "../../model/beside";
import { explained, titleOf } from "../../model/measure";
import { whom } from "../../model/scope";
import { formatDifference, formatNumber, formatRelative, formatTime, unitText, withUnit, words } from "../../model/units";
import classes from "./Compare.module.css";
import { Heads } from "./Differences";

/** A word and a sign, so that it is no matter of colour alone. */
const STANDS: Record<Stand, string> = {
  better: "▲ better",
  worse: "▼ worse",
  same: "= same",
  "no goal": "no goal",
  "not ranked": "not ranked",
  missing: "only one has it",
};

interface Props {
  found: SideBySide;
  /** Whether metrics that are the same in all runs are shown too. */
  everything: boolean;
}

export function Metrics({ found, everything }: Props) {
  const { runs, metrics, unranked, alike } = found;
  const shown = everything ? metrics : metrics.filter(differs);
  return (
    <section className={classes.card} data-testid="compare-metrics" aria-label="Metrics">
      <h2>
        Metrics{" "}
        <Text span size="xs" c="dimmed">
          each against the baseline; {formatNumber(100 * alike)} % and less may be chance, a thousandth of the unit nobody measures
        </Text>
      </h2>
      {[...new Set(unranked.filter(Boolean))].map((why) => (
        <Text key={why} size="sm" role="note" mb={6}>
          {why}
        </Text>
      ))}
      {metrics.length === 0 ? (
        <Text size="sm" c="dimmed">
          None of the runs has metrics.
        </Text>
      ) : (
        <Table verticalSpacing={4} horizontalSpacing={8} fz="sm" className={classes.figures}>
          <Table.Thead>
            <Table.Tr>
              <Table.Th>Metric</Table.Th>
              <Heads found={found} />
            </Table.Tr>
          </Table.Thead>
          <Table.Tbody>
            <Goals found={found} />
            {shown.map((metric) => (
              <MetricRow key={metric.name} metric={metric} found={found} />
            ))}
            {shown.length === metrics.length ? null : (
              <Table.Tr>
                <Table.Td colSpan={runs.length + 1} c="dimmed">
                  {metrics.length - shown.length} more are the same in all runs, or in none.
                </Table.Td>
              </Table.Tr>
            )}
            <Table.Tr>
              <Table.Td c="dimmed">In all</Table.Td>
              {runs.map(({ run }, place) => (
                <Table.Td key={run} ta="right" c="dimmed">
                  {place === 0 || unranked[place] ? null : <Tally metrics={metrics} place={place} />}
                </Table.Td>
              ))}
            </Table.Tr>
          </Table.Tbody>
        </Table>
      )}
    </section>
  );
}

/** How many of its goals each run met; what it missed stands below. */
function Goals({ found: { runs, goals } }: { found: SideBySide }) {
  if (!goals.some((each) => each && each.of > 0)) return null;
  return (
    <Table.Tr>
      <Table.Th scope="row">Goals met</Table.Th>
      {runs.map(({ run }, place) => {
        const said = goalsTold(goals[place] ?? null);
        return (
          <Table.Td key={run} ta="right" title={said.why} fw={700}>
            {said.text}
            {goals[place]?.missed.map((each) => (
              <Text key={each} size="xs" c="dimmed" className={classes.about}>
                {each}
              </Text>
            ))}
          </Table.Td>
        );
      })}
    </Table.Tr>
  );
}

function Tally({ metrics, place }: { metrics: readonly MetricBeside[]; place: number }) {
  const { better, worse, same } = tally(metrics, place, "");
  return (
    <>
      {better} better, {worse} worse, {same} the same
    </>
  );
}

function MetricRow({ metric, found }: { metric: MetricBeside; found: SideBySide }) {
  const { name, unit, goal } = metric;
  const known = useGlossary().metrics;
  return (
    <Table.Tr data-metric={name}>
      <Table.Td title={`${explained(name, known)}\n${goal ? `${words(goal)} is better` : "No goal is set"}`}>
        {withUnit(titleOf(name, known), unit)}
      </Table.Td>
      {found.runs.map((run, place) => (
        <MetricCell key={run.run} metric={metric} found={found} place={place} />
      ))}
    </Table.Tr>
  );
}

/** A value, how it stands, whom it is about, and when that was; a click goes there. */
function MetricCell({ metric, found, place }: { metric: MetricBeside; found: SideBySide; place: number }) {
  const run = found.runs[place] as SideBySide["runs"][number];
  const { about = "", time = null } = run.metrics[metric.name] ?? {};
  const value = metric.values[place] ?? null;
  const stand = place === 0 ? undefined : standOf(metric, place, found.unranked[place] ?? "");
  return (
    <Table.Td ta="right" data-verdict={stand} className={classes.stand}>
      {value === null ? "–" : formatNumber(value)}
      {stand === undefined || value === null ? null : (
        <span className={classes.against}>
          {" "}
          {against(metric, place)} {STANDS[stand]}
        </span>
      )}
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

/** The difference to the baseline: relative, or in its unit where a share would tell nothing; nothing where there is none. */
function against(metric: MetricBeside, place: number): string {
  const { difference, relative } = changeOf(metric, place);
  if (!difference) return "";
  if (relative !== null) return formatRelative(relative);
  return [formatDifference(Number(difference.toPrecision(4))), unitText(metric.unit)].filter(Boolean).join(" ");
}
