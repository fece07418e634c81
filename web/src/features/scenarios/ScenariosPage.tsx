/** The scenario files: which there are, what is wrong with them, and all that can be done with a file. */

import {
  ActionIcon,
  Button,
  CloseButton,
  FileButton,
  Table,
  Text,
  TextInput,
  Title,
  Tooltip,
  VisuallyHidden,
} from "@mantine/core";
import { useQuery } from "@tanstack/react-query";
import { Link, useNavigate } from "@tanstack/react-router";
import { type KeyboardEvent, type MouseEvent, useMemo, useRef, useState } from "react";
import { scenarios } from "../../api/queries";
import {
  mapId,
  matchingScenarios,
  ORDERS,
  type Order,
  ordered,
  problemLines,
  type ScenarioRow,
} from "../../model/scenario";
import { formatMoment, formatNumber } from "../../model/units";
import { DropAnywhere } from "../../ui/Drop";
import { Icon } from "../../ui/Icon";
import { Empty, Failure, Loading } from "../../ui/State";
import { useShortcuts } from "../../ui/shortcut";
import { Asked, useDeeds } from "./deeds";
import { useImports } from "./imports";
import { NewDialog } from "./NewDialog";
import { type Deed, type OpenMenu, RowMenu } from "./RowMenu";
import classes from "./Scenarios.module.css";
import { Trash } from "./Trash";

/** What the address says about the list. */
export interface ScenariosView {
  q?: string | undefined;
  sort?: string | undefined;
}

interface Props {
  view: ScenariosView;
  onView: (view: ScenariosView) => void;
}

const NONE: ScenarioRow[] = [];

export function ScenariosPage({ view, onView }: Props) {
  const { data, error, refetch } = useQuery(scenarios);
  const rows = data ?? NONE;
  const [making, setMaking] = useState(false);
  const [menu, setMenu] = useState<OpenMenu>();
  const search = useRef<HTMLInputElement>(null);
  const navigate = useNavigate();
  const deeds = useDeeds(rows);
  const imports = useImports(deeds.taken);
  useShortcuts({ "/": () => search.current?.focus(), n: () => setMaking(true) });
  const order = ORDERS.find((each) => each === view.sort) ?? "title";
  const shown = useMemo(() => ordered(matchingScenarios(rows, view.q ?? ""), order), [rows, view.q, order]);
  const names = rows.map(({ id }) => id);
  const take = (files: File[]) => void imports.files(files);
  const open = (scenario: string) => void navigate({ to: "/studio/$scenario", params: { scenario }, search: {} });

  return (
    <div className={classes.page}>
      <header className={classes.head}>
        <Title order={1} fz="lg">
          Scenarios
        </Title>
        <Text size="sm" c="dimmed" role="status">
          {data ? (shown.length === rows.length ? rows.length : `${shown.length} of ${rows.length}`) : ""}
        </Text>
        <div className={classes.tools}>
          <TextInput
            ref={search}
            size="xs"
            w={230}
            placeholder="Search scenarios (/)"
            aria-label="Search scenarios"
            leftSection={<Icon name="search" size={14} />}
            rightSection={
              view.q ? (
                <CloseButton size="xs" aria-label="Clear the search" onClick={() => onView({ ...view, q: undefined })} />
              ) : null
            }
            value={view.q ?? ""}
            onChange={(event) => onView({ ...view, q: event.currentTarget.value || undefined })}
          />
          <ImportButton onFiles={take} pending={imports.pending} />
          <Button
            size="xs"
            leftSection={<Icon name="plus" size={14} />}
            data-testid="new-scenario"
            onClick={() => setMaking(true)}
          >
            New scenario
          </Button>
        </div>
      </header>
      {imports.refused.map(({ file, error: why }) => (
        <Failure
          key={file}
          error={Object.assign(new Error(`${file} was not taken. ${why.message}`), { problems: why.problems ?? [] })}
          onDismiss={() => imports.dismiss(file)}
        />
      ))}
      {error && !data ? <Failure error={error} onRetry={() => void refetch()} /> : null}
      {!data && !error ? <Loading what="the scenarios" /> : null}
      {data?.length === 0 ? (
        <Empty
          icon="car"
          title="No scenarios yet"
          action={
            <Button size="xs" onClick={() => setMaking(true)}>
              Make the first one
            </Button>
          }
        >
          A scenario says who drives where and what happens: a file that you can read. Begin with a template on one of
          your maps, or drop a scenario file anywhere on this page.
        </Empty>
      ) : null}
      {rows.length > 0 && shown.length === 0 ? (
        <Empty
          icon="search"
          title={`No scenario matches “${view.q}”`}
          action={
            <Button size="xs" variant="default" onClick={() => onView({ ...view, q: undefined })}>
              Clear the search
            </Button>
          }
        >
          The search looks at title, description, file, map and problem.
        </Empty>
      ) : null}
      {shown.length > 0 ? (
        <ScenarioTable
          rows={shown}
          order={order}
          onOrder={(sort) => onView({ ...view, sort: sort === "title" ? undefined : sort })}
          onMenu={setMenu}
          onDeed={deeds.begin}
        />
      ) : null}
      <Trash onRestore={deeds.restore} pending={deeds.restoring} />
      <RowMenu open={menu} onClose={() => setMenu(undefined)} onDeed={deeds.begin} />
      {making ? <NewDialog taken={names} onClose={() => setMaking(false)} onMade={open} /> : null}
      <Asked deeds={deeds} imports={imports} names={names} />
      <DropAnywhere onFiles={take}>Drop the scenario file to import it</DropAnywhere>
    </div>
  );
}

interface ImportProps {
  onFiles: (files: File[]) => void;
  pending: boolean;
}

function ImportButton({ onFiles, pending }: ImportProps) {
  // The same file may be chosen again, which a browser would not tell otherwise.
  const reset = useRef<() => void>(null);
  const take = (files: File[]) => {
    onFiles(files);
    reset.current?.();
  };
  return (
    <FileButton
      onChange={take}
      resetRef={reset}
      multiple
      accept=".yaml,.yml"
      inputProps={{ "aria-label": "Scenario file" }}
    >
      {(props) => (
        <Button
          {...props}
          size="xs"
          variant="default"
          loading={pending}
          leftSection={<Icon name="upload" size={14} />}
        >
          Import a file
        </Button>
      )}
    </FileButton>
  );
}

interface TableProps {
  rows: readonly ScenarioRow[];
  order: Order;
  onOrder: (order: Order) => void;
  onMenu: (menu: OpenMenu) => void;
  onDeed: (deed: Deed, row: ScenarioRow) => void;
}

const HEADS: Record<Order, string> = { title: "Scenario", map: "Map", changed: "Changed", runs: "Runs" };

function ScenarioTable({ rows, order, onOrder, onMenu, onDeed }: TableProps) {
  return (
    <Table highlightOnHover verticalSpacing={6} fz="sm" aria-label="Scenarios">
      <Table.Thead>
        <Table.Tr>
          {ORDERS.map((each) => (
            <Table.Th key={each} ta={each === "runs" ? "right" : "left"} aria-sort={each === order ? sense(each) : "none"}>
              <button
                type="button"
                className={classes.sort}
                data-by={each === order || undefined}
                onClick={() => onOrder(each)}
              >
                {HEADS[each]}
              </button>
            </Table.Th>
          ))}
          <Table.Th ta="right">Vehicles</Table.Th>
          <Table.Th ta="right">Duration</Table.Th>
          <Table.Th>
            <VisuallyHidden>What to do</VisuallyHidden>
          </Table.Th>
        </Table.Tr>
      </Table.Thead>
      <Table.Tbody>
        {rows.map((row) => (
          <Row key={row.id} row={row} onMenu={onMenu} onDeed={onDeed} />
        ))}
      </Table.Tbody>
    </Table>
  );
}

const sense = (order: Order) => (order === "title" || order === "map" ? "ascending" : "descending");
const KEYS: Record<string, Deed> = { F2: "rename", Delete: "delete" };

function Row({ row, onMenu, onDeed }: { row: ScenarioRow } & Pick<TableProps, "onMenu" | "onDeed">) {
  const link = useRef<HTMLAnchorElement>(null);
  const key = (event: KeyboardEvent) => {
    const deed = KEYS[event.key];
    if (!deed || row.sealed) return;
    event.preventDefault();
    onDeed(deed, row);
  };
  const context = (event: MouseEvent) => {
    event.preventDefault();
    onMenu({ row, x: event.clientX, y: event.clientY, from: link.current });
  };
  const button = (event: MouseEvent<HTMLElement>) => {
    const { left, bottom } = event.currentTarget.getBoundingClientRect();
    onMenu({ row, x: left, y: bottom, from: event.currentTarget });
  };
  const map = mapId(row.map);
  return (
    <Table.Tr className={classes.row} data-testid={`scenario-${row.id}`} onContextMenu={context} onKeyDown={key}>
      <Table.Td>
        <Link
          ref={link}
          to="/studio/$scenario"
          params={{ scenario: row.id }}
          search={{}}
          className={classes.name}
          title={row.description}
        >
          {row.title}
        </Link>
        <Text size="xs" c="dimmed">
          {row.file}
          {row.sealed ? ", may be read only" : ""}
        </Text>
        {row.problem ? <ProblemOf row={row} problem={row.problem} /> : null}
      </Table.Td>
      <Table.Td>
        {map ? (
          <Link to="/maps/$map" params={{ map }} search={{}} className={classes.link}>
            {map}
          </Link>
        ) : (
          row.map || "–"
        )}
      </Table.Td>
      <Table.Td className={classes.number}>{row.changed ? formatMoment(row.changed) : "–"}</Table.Td>
      <Table.Td ta="right" className={classes.number}>
        {row.runs ? (
          <Link
            to="/runs"
            search={{ scenario: row.id }}
            className={classes.link}
            aria-label={`${row.runs} runs of ${row.title}`}
          >
            {row.runs}
          </Link>
        ) : (
          (row.runs ?? "–")
        )}
      </Table.Td>
      <Table.Td ta="right" className={classes.number}>
        {row.problem ? "–" : row.vehicles}
      </Table.Td>
      <Table.Td ta="right" className={classes.number}>
        {row.problem ? "–" : `${formatNumber(row.duration_s)} s`}
      </Table.Td>
      <Table.Td w={40}>
        <Tooltip label="What to do with it">
          <ActionIcon
            size="sm"
            variant="subtle"
            color="gray"
            c="var(--mantine-color-text)"
            aria-label={`What to do with ${row.title}`}
            aria-haspopup="menu"
            onClick={button}
          >
            <Icon name="more" size={18} />
          </ActionIcon>
        </Tooltip>
      </Table.Td>
    </Table.Tr>
  );
}

/** That it cannot be run, and why; the text is where it is mended. */
function ProblemOf({ row, problem }: { row: ScenarioRow; problem: string }) {
  const [first, others] = problemLines(problem);
  return (
    <details className={classes.problem}>
      <summary>
        <Icon name="warning" size={12} /> {first}
        {others.length > 0 ? ` (and ${others.length} more)` : ""}
      </summary>
      {others.length > 0 ? <pre>{others.join("\n")}</pre> : null}
      <Link to="/scenarios/$scenario/text" params={{ scenario: row.id }}>
        Mend it in its text
      </Link>
    </details>
  );
}
