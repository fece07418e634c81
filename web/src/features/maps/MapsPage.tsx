/** The maps that there are, and the ways to a new one. */

import { ActionIcon, Badge, Group, Table, Text, Title, Tooltip, VisuallyHidden } from "@mantine/core";
import { useQuery, useQueryClient } from "@tanstack/react-query";
import { Link, useNavigate } from "@tanstack/react-router";
import { useRef, useState } from "react";
import { maps, noteJob } from "../../api/maps";
import type { MapJob, MapRow } from "../../model/map";
import { formatBytes, formatNumber } from "../../model/units";
import { DropAnywhere } from "../../ui/Drop";
import { Icon } from "../../ui/Icon";
import { Empty, Failure, Loading } from "../../ui/State";
import { useShortcuts } from "../../ui/shortcut";
import { DeleteQuestion } from "./DeleteQuestion";
import { ImportPanel, type Wishes } from "./ImportPanel";
import { useEnds, useRefresh, useSend } from "./imports";
import { Jobs } from "./Jobs";
import classes from "./Maps.module.css";

const NO_WISHES: Wishes = { name: "", bbox: "", replace: false };

export function MapsPage() {
  const { data, error, refetch } = useQuery(maps);
  const [wishes, setWishes] = useState(NO_WISHES);
  const field = useRef<HTMLInputElement>(null);
  const { send, started } = useOpening(() => setWishes(NO_WISHES));
  useRefresh();
  useShortcuts({ "/": () => field.current?.focus() });
  const take = (files: File[]) => void send(files, wishes);
  return (
    <div className={classes.list}>
      <Title order={1} fz="lg">
        Maps
      </Title>
      <ImportPanel wishes={wishes} onWishes={setWishes} onFiles={take} onStarted={started} field={field} />
      <Jobs />
      {error && !data ? <Failure error={error} onRetry={() => void refetch()} /> : null}
      {!data && !error ? <Loading what="maps" /> : null}
      {data?.length === 0 ? (
        <Empty icon="map" title="No maps yet">
          Drop a map file anywhere on this page, or type a place: its roads, signals and buildings are made from it, and
          a car can drive there a moment later.
        </Empty>
      ) : null}
      {data && data.length > 0 ? <MapTable rows={data} /> : null}
      <DropAnywhere onFiles={take}>Drop the map file to import it</DropAnywhere>
    </div>
  );
}

/** When the only import that was started here is done, its map is opened. */
function useOpening(onTaken: () => void) {
  const navigate = useNavigate();
  const kept = useQueryClient();
  const sendFiles = useSend();
  const waiting = useRef<number[]>([]);
  useEnds(({ id, map, status }) => {
    const last = waiting.current.length === 1 && waiting.current[0] === id;
    waiting.current = waiting.current.filter((other) => other !== id);
    if (last && status === "done") void navigate({ to: "/maps/$map", params: { map }, search: {} });
  });
  const started = (job: MapJob) => {
    waiting.current.push(job.id);
    onTaken();
    noteJob(kept, job);
  };
  const send = async (files: readonly File[], wishes: Wishes) => {
    for (const job of await sendFiles(files, wishes)) started(job);
  };
  return { send, started };
}

function MapTable({ rows }: { rows: readonly MapRow[] }) {
  const [doomed, setDoomed] = useState<MapRow>();
  return (
    <>
      <Table highlightOnHover verticalSpacing={6} fz="sm" data-testid="maps-table">
        <Table.Thead>
          <Table.Tr>
            <Table.Th>Map</Table.Th>
            <Table.Th>Drive side</Table.Th>
            <Table.Th ta="right">Lanes [km]</Table.Th>
            <Table.Th ta="right">On disk</Table.Th>
            <Table.Th>Made from</Table.Th>
            <Table.Th>Attribution, licence</Table.Th>
            <Table.Th>
            <VisuallyHidden>Delete</VisuallyHidden>
          </Table.Th>
          </Table.Tr>
        </Table.Thead>
        <Table.Tbody>
          {rows.map((row) => (
            <Row key={row.id} row={row} onDelete={() => setDoomed(row)} />
          ))}
        </Table.Tbody>
      </Table>
      <DeleteQuestion map={doomed} onClose={() => setDoomed(undefined)} />
    </>
  );
}

function Row({ row, onDelete }: { row: MapRow; onDelete: () => void }) {
  const navigate = useNavigate();
  const open = () => navigate({ to: "/maps/$map", params: { map: row.id }, search: {} });
  return (
    <Table.Tr className={classes.row} data-testid="map-row" onClick={() => void open()}>
      <Table.Td>
        <Link to="/maps/$map" params={{ map: row.id }} search={{}} className={classes.name}>
          {row.title}
        </Link>
        {row.kind === "file" ? (
          <Badge size="xs" variant="default" tt="none" ml={8}>
            file, not imported
          </Badge>
        ) : null}
        {row.problem ? (
          <Text size="xs" className={classes.problem}>
            <Icon name="warning" size={12} /> {row.problem}
          </Text>
        ) : null}
      </Table.Td>
      <Table.Td>{row.drive_side ?? "–"}</Table.Td>
      <Table.Td ta="right" className={classes.number}>
        {row.lane_km === null ? "–" : formatNumber(row.lane_km)}
      </Table.Td>
      <Table.Td ta="right" className={classes.number}>
        {formatBytes(row.bytes)}
      </Table.Td>
      <Table.Td>{row.source}</Table.Td>
      <Table.Td>
        {row.attribution}
        <Text size="xs" c="dimmed">
          {row.licence}
        </Text>
      </Table.Td>
      <Table.Td w={40}>
        {row.kind === "import" ? <Delete row={row} onDelete={onDelete} /> : null}
      </Table.Td>
    </Table.Tr>
  );
}

function Delete({ row, onDelete }: { row: MapRow; onDelete: () => void }) {
  return (
    <Group justify="flex-end">
      <Tooltip label="Delete this map">
        <ActionIcon
          size="sm"
          variant="subtle"
          color="gray"
          aria-label={`Delete the map ${row.title}`}
          onClick={(event) => {
            event.stopPropagation();
            onDelete();
          }}
        >
          <Icon name="trash" size={15} />
        </ActionIcon>
      </Tooltip>
    </Group>
  );
}
