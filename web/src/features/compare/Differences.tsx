/** What differs between runs: parameters, the environment, and how each ended. */

import { Group, Table, Text, TextInput } from "@mantine/core";
import { useLocalStorage } from "@mantine/hooks";
import { Link } from "@tanstack/react-router";
import { useState } from "react";
import { isIgnored, listOf } from "../../model/ignored";
import type { SideBySide } from "../../model/beside";
import { plain } from "../../model/note";
import { unitAt } from "../../model/form";
import type { Json } from "../../model/run";
import { formatValue, withUnit } from "../../model/units";
import { useUnits } from "../../api/units";
import { Path } from "../../ui/Path";
import { StatusBadge } from "../../ui/StatusBadge";
import { VerdictBadge } from "../../ui/VerdictBadge";
import classes from "./Compare.module.css";

export function Differences({ found }: { found: SideBySide }) {
  const { runs } = found;
  const [list, setList] = useLocalStorage<readonly string[]>({ key: "ignored differences", defaultValue: NOTHING, getInitialValueInEffect: false });
  const parameters = found.parameters.filter(({ path }) => !isIgnored(path, list));
  const environment = found.environment.filter(({ name }) => !isIgnored(name, list));
  const left = found.parameters.length + found.environment.length - parameters.length - environment.length;
  const units = useUnits(runs);
  const scenarios = [...new Set(runs.map(({ scenario }) => scenario))];
  return (
    <section className={classes.card} data-testid="compare-parameters" aria-label="What differs">
      <Group justify="space-between" align="flex-start">
        <h2>What differs</h2>
        <Ignored list={list} left={left} onList={setList} />
      </Group>
      {scenarios.length > 1 ? (
        <Text size="xs" c="dimmed" mb={6}>
          The runs are of {scenarios.length} scenarios: {scenarios.join(", ")}.
        </Text>
      ) : null}
      <Table verticalSpacing={4} horizontalSpacing={8} fz="sm" className={classes.figures}>
        <Table.Thead>
          <Table.Tr>
            <Table.Th>Parameter</Table.Th>
            <Heads found={found} />
          </Table.Tr>
        </Table.Thead>
        <Table.Tbody>
          {parameters.length === 0 ? (
            <Table.Tr>
              <Table.Td colSpan={runs.length + 1} c="dimmed">
                No parameter differs.
              </Table.Td>
            </Table.Tr>
          ) : null}
          {parameters.map(({ path, values, unit }) => (
            <Row key={path} name={withUnit(path, unit || unitAt(units, path))} values={values} />
          ))}
          {environment.map(({ name, values }) => (
            <Row key={`environment ${name}`} name={`Environment: ${name}`} values={values} />
          ))}
          <Table.Tr>
            <Table.Td>Status, verdict</Table.Td>
            {runs.map((run) => (
              <Table.Td key={run.run} ta="right">
                <StatusBadge status={run.status} error={run.error} unmet={run.unmet} />{" "}
                {run.verdict === "open" ? null : <VerdictBadge verdict={run.verdict} reason={run.reason} />}
              </Table.Td>
            ))}
          </Table.Tr>
          {runs.some(({ note }) => note) ? <Row name="Note" values={runs.map(({ note }) => plain(note) || null)} /> : null}
        </Table.Tbody>
      </Table>
    </section>
  );
}

const NOTHING: readonly string[] = [];

/** What is left out of the differences; the browser keeps it. */
function Ignored({ list, left, onList }: { list: readonly string[]; left: number; onList: (list: readonly string[]) => void }) {
  const [text, setText] = useState(list.join(", "));
  return (
    <TextInput
      size="xs"
      w={280}
      label="Ignore"
      placeholder="host, radio.*"
      description={left === 0 ? "names or paths, with commas" : left === 1 ? "1 difference is left out" : `${left} differences are left out`}
      value={text}
      onChange={(event) => {
        setText(event.currentTarget.value);
        onList(listOf(event.currentTarget.value));
      }}
    />
  );
}

/** One thing of all runs; what is not as in the first one stands out. */
function Row({ name, values }: { name: string; values: readonly Json[] }) {
  const first = formatValue(values[0]);
  return (
    <Table.Tr>
      <Table.Td className={classes.path}>
        <Path path={name} />
      </Table.Td>
      {values.map((value, place) => (
        <Table.Td key={place} ta="right" className={classes.value} fw={formatValue(value) === first ? undefined : 700}>
          {formatValue(value)}
        </Table.Td>
      ))}
    </Table.Tr>
  );
}

/** The runs as heads of columns. */
export function Heads({ found: { runs } }: { found: SideBySide }) {
  return runs.map(({ run, name, parent }, place) => (
    <Table.Th key={run} ta="right" title={parent === null ? undefined : `Child of #${parent}`}>
      <Link to="/runs/$run" params={{ run: String(run) }} className={classes.link}>
        #{run}
      </Link>{" "}
      {name}
      {place === 0 ? <span className={classes.base}> baseline</span> : null}
    </Table.Th>
  ));
}
