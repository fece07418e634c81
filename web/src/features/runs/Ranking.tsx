/** Which parameters go with a metric, over the runs that are shown. */

import { Select, Table, Text } from "@mantine/core";
import { useMemo, useState } from "react";
import { type Axis, firstAxes } from "../../model/axes";
import type { ListedRun } from "../../model/run";
import { FEWEST, mayBeChance, sensitivities } from "../../model/sensitivity";
import type { Column } from "../../model/table";
import { formatFixed, withUnit } from "../../model/units";

interface Props {
  all: readonly Axis[];
  columns: readonly Column[];
  runs: readonly ListedRun[];
  shown: ReadonlySet<number>;
}

export function Ranking({ all, columns, runs, shown }: Props) {
  const metrics = all.filter(({ column }) => column.group === "metrics");
  const first = useMemo(() => firstAxes(all, runs).find((id) => id.startsWith("metric:")), [all, runs]);
  const [chosen, setChosen] = useState<string>();
  const metric = metrics.find(({ column }) => column.id === (chosen ?? first))?.column;
  const found = useMemo(
    () => (metric ? sensitivities(metric, columns, runs.filter(({ run }) => shown.has(run))) : []),
    [metric, columns, runs, shown],
  );
  return (
    <section aria-label="Sensitivity" style={{ padding: "0 16px" }}>
      <Select
        size="xs"
        w={280}
        label="What goes with"
        searchable
        value={metric?.id ?? null}
        onChange={(next) => setChosen(next ?? undefined)}
        data={metrics.map(({ column }) => ({ value: column.id, label: withUnit(column.title, column.unit) }))}
      />
      {found.length === 0 ? (
        <Text size="sm" c="dimmed" my={6}>
          Fewer than {FEWEST} whole runs that are shown have this metric and a number that varies.
        </Text>
      ) : (
        <Table verticalSpacing={3} horizontalSpacing={8} fz="sm" w="auto" aria-label={`Parameters by how they go with ${metric?.title ?? ""}`}>
          <Table.Thead>
            <Table.Tr>
              <Table.Th>Parameter</Table.Th>
              <Table.Th ta="right">Rank correlation</Table.Th>
              <Table.Th>95 % interval</Table.Th>
              <Table.Th ta="right">Runs</Table.Th>
              <Table.Th />
            </Table.Tr>
          </Table.Thead>
          <Table.Tbody style={{ fontVariantNumeric: "tabular-nums" }}>
            {found.map((each) => (
              <Table.Tr key={each.column.id}>
                <Table.Th scope="row" title={each.column.name}>
                  {each.column.title}
                </Table.Th>
                <Table.Td ta="right">{formatFixed(each.rank, 2)}</Table.Td>
                <Table.Td>
                  {formatFixed(each.low, 2)} to {formatFixed(each.high, 2)}
                </Table.Td>
                <Table.Td ta="right">{each.count}</Table.Td>
                <Table.Td c="dimmed">{mayBeChance(each) ? "may be chance" : each.rank > 0 ? "▲ rises with it" : "▼ falls with it"}</Table.Td>
              </Table.Tr>
            ))}
          </Table.Tbody>
        </Table>
      )}
      <Text size="xs" c="dimmed" mt={4}>
        Spearman’s coefficient over the runs that are shown. It tells no causes, and parameters that were changed together are not told apart.
      </Text>
    </section>
  );
}
