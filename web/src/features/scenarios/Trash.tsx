/** Scenarios that were deleted, each with the way back. */

import { Button, Table, Text } from "@mantine/core";
import { useQuery } from "@tanstack/react-query";
import { trash } from "../../api/scenarios";
import type { Deleted } from "../../model/scenario";
import { formatBytes, formatMoment } from "../../model/units";
import { Icon } from "../../ui/Icon";
import classes from "./Scenarios.module.css";

interface Props {
  onRestore: (entry: Deleted) => void;
  pending: boolean;
}

export function Trash({ onRestore, pending }: Props) {
  const { data = [] } = useQuery(trash);
  if (data.length === 0) return null;
  return (
    <details className={classes.trash}>
      <summary>
        <Icon name="trash" size={14} /> Deleted ({data.length})
      </summary>
      <Text size="xs" c="dimmed" mt={4}>
        They lie in the folder <code>trash</code> beside the scenarios until you remove them there.
      </Text>
      <Table verticalSpacing={4} fz="sm" w="auto" aria-label="Deleted scenarios">
        <Table.Tbody>
          {data.map((entry) => (
            <Table.Tr key={entry.id}>
              <Table.Td>{entry.scenario}</Table.Td>
              <Table.Td c="dimmed">deleted {formatMoment(entry.deleted)}</Table.Td>
              <Table.Td c="dimmed" className={classes.number}>
                {formatBytes(entry.bytes)}
              </Table.Td>
              <Table.Td>
                <Button
                  size="compact-xs"
                  variant="default"
                  leftSection={<Icon name="undo" size={12} />}
                  aria-label={`Bring back ${entry.scenario}, deleted ${formatMoment(entry.deleted)}`}
                  disabled={pending}
                  onClick={() => onRestore(entry)}
                >
                  Bring back
                </Button>
              </Table.Td>
            </Table.Tr>
          ))}
        </Table.Tbody>
      </Table>
    </details>
  );
}
