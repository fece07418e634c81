/** One map: its plan, what its import found and guessed, and the way to drive there. */

import { Button, CloseButton, Text, TextInput, Title } from "@mantine/core";
import { useQuery } from "@tanstack/react-query";
import { Link, useNavigate } from "@tanstack/react-router";
import { useEffect, useMemo, useRef, useState } from "react";
import { map as mapQuery, plan as planQuery, useDrive } from "../../api/maps";
import type { Picked, PlanPicture } from "../../charts/PlanPicture";
import { again, type Filter, type Finding, findings, type Mark, ordered, type SortKey, shown } from "../../model/finding";
import type { MapDetail, MapRow, Plan as PlanData } from "../../model/map";
import { DropAnywhere } from "../../ui/Drop";
import { Icon } from "../../ui/Icon";
import { notifyError } from "../../ui/notify";
import { Failure, Loading } from "../../ui/State";
import { useShortcuts } from "../../ui/shortcut";
import { DeleteQuestion } from "./DeleteQuestion";
import { FindingDetails, RoadDetails } from "./Details";
import { Filters } from "./Filters";
import { FindingsTable, type Sort } from "./FindingsTable";
import { useRefresh, useSend } from "./imports";
import { Jobs } from "./Jobs";
import classes from "./Maps.module.css";
import { Plan } from "./Plan";
import { Summary } from "./Summary";

/** What the address says: what is selected, what is hidden, searched for, and the order of the table. */
export interface MapView {
  /** The id of a finding. */
  at?: string | undefined;
  road?: string | undefined;
  /** Kinds, and marks with a tilde before them. */
  hide?: string | undefined;
  q?: string | undefined;
  sort?: string | undefined;
}

interface Props {
  id: string;
  view: MapView;
  onView: (view: MapView) => void;
}

export function MapPage({ id, view, onView }: Props) {
  const { data, error, refetch } = useQuery(mapQuery(id));
  const plan = useQuery(planQuery(id, data?.digest));
  const navigate = useNavigate();
  const send = useSend();
  useRefresh();
  const take = (files: File[]) => {
    void send(files);
    void navigate({ to: "/maps" });
  };
  const broken = error ?? plan.error;
  const retry = () => void Promise.all([refetch(), plan.refetch()]);
  return (
    <>
      {data ? <Head map={data} /> : null}
      {broken && !(data && plan.data) ? (
        <Failure error={broken} onRetry={retry} />
      ) : data && plan.data ? (
        <Desk map={data} plan={plan.data} view={view} onView={onView} />
      ) : (
        <Loading what={data ? "the plan" : "the map"} />
      )}
      <DropAnywhere onFiles={take}>Drop the map file to import it</DropAnywhere>
    </>
  );
}

function Head({ map }: { map: MapRow }) {
  const navigate = useNavigate();
  const drive = useDrive(map.id);
  const [doomed, setDoomed] = useState(false);
  const open = () =>
    drive.mutate(undefined, {
      onError: notifyError,
      onSuccess: ({ scenario }) => navigate({ to: "/studio/$scenario", params: { scenario }, search: {} }),
    });
  return (
    <header className={classes.head}>
      <Link to="/maps" className={classes.back}>
        <Icon name="left" size={14} /> Maps
      </Link>
      <Title order={1} fz="lg">
        {map.title}
      </Title>
      <Text size="xs" c="dimmed" truncate>
        {[map.attribution, map.licence].filter(Boolean).join(" · ")}
      </Text>
      <div className={classes.ways}>
        {map.kind === "import" ? (
          <Button
            size="xs"
            variant="default"
            leftSection={<Icon name="trash" size={14} />}
            onClick={() => setDoomed(true)}
          >
            Delete
          </Button>
        ) : null}
        <Button
          size="xs"
          data-testid="drive-here"
          leftSection={<Icon name="car" size={15} />}
          loading={drive.isPending}
          onClick={open}
        >
          Drive here
        </Button>
      </div>
      <DeleteQuestion
        map={doomed ? map : undefined}
        onClose={() => setDoomed(false)}
        onDeleted={() => void navigate({ to: "/maps" })}
      />
    </header>
  );
}

interface DeskProps {
  map: MapDetail;
  plan: PlanData;
  view: MapView;
  onView: (view: MapView) => void;
}

/** The plan and the report, linked both ways. */
function Desk({ map, plan, view, onView }: DeskProps) {
  const picture = useRef<PlanPicture>(undefined);
  const report = useReport(map, view);
  const { all, listed, selected } = report;
  const road = view.road === undefined ? undefined : plan.roads.find(({ id }) => id === view.road);

  const select = (finding: Finding | undefined) => onView({ ...view, at: finding?.id, road: undefined });
  const show = (finding: Finding) => {
    select(finding);
    picture.current?.centre(finding);
  };
  const pick = ({ members, lane }: Picked) => {
    const [first] = members;
    if (members.length > 1 && isSpread(members) && !picture.current?.nearest) picture.current?.frameAll(members);
    else if (first) select(first);
    else onView({ ...view, at: undefined, road: lane?.road });
  };
  const close = () => select(undefined);
  useFollowing(map.digest, selected, all, select);
  useFirstLook(selected, picture);
  useShortcuts({ Escape: close });
  const { id, digest, corrections } = map;
  const details = { map: id, plan, corrections, digest, editable: map.kind === "import", onClose: close };
  return (
    <div className={classes.desk}>
      <Summary report={map.report} />
      <Plan plan={plan} findings={listed} selected={selected} road={road?.id} picture={picture} onPick={pick} />
      <aside className={classes.panel} aria-label="What the import found and guessed">
        <Jobs map={id} />
        <Findings {...report} view={view} onView={onView} onSelect={show} />
        {selected ? <FindingDetails finding={selected} {...details} /> : null}
        {road && !selected ? <RoadDetails road={road} {...details} /> : null}
      </aside>
    </div>
  );
}

/** The findings of a map: all, those that the address lets through, in its order, and the one that it names. */
function useReport({ report }: MapDetail, { at, hide, q, sort: order }: MapView) {
  const all = useMemo(() => findings(report), [report]);
  const filter = useMemo(() => readFilter(hide ?? hiddenAtFirst(all)), [hide, all]);
  const sort = readSort(order);
  const { key, descending } = sort;
  const listed = useMemo(() => ordered(shown(all, filter, q), key, descending), [all, filter, q, key, descending]);
  const selected = at === undefined ? undefined : all.find(({ id }) => id === at);
  return { all, filter, sort, listed, selected };
}

interface FindingsProps extends ReturnType<typeof useReport> {
  view: MapView;
  onView: (view: MapView) => void;
  onSelect: (finding: Finding) => void;
}

/** The table with what chooses its rows. */
function Findings({ all, filter, sort, listed, selected, view, onView, onSelect }: FindingsProps) {
  const search = useRef<HTMLInputElement>(null);
  useShortcuts({ "/": () => search.current?.focus() });
  const find = (q: string) => onView({ ...view, q: q || undefined });
  return (
    <>
      <Filters findings={all} filter={filter} onFilter={(next) => onView({ ...view, hide: writeFilter(next) })} />
      <TextInput
        ref={search}
        size="xs"
        className={classes.search}
        placeholder="Search the findings (/)"
        aria-label="Search the findings"
        leftSection={<Icon name="search" size={14} />}
        rightSection={
          view.q ? <CloseButton size="xs" aria-label="Clear the search" onClick={() => find("")} /> : null
        }
        value={view.q ?? ""}
        onChange={(event) => find(event.currentTarget.value)}
      />
      {listed.length > 0 ? (
        <FindingsTable
          findings={listed}
          selected={selected}
          sort={sort}
          onSort={(next) => onView({ ...view, sort: writeSort(next) })}
          onSelect={onSelect}
        />
      ) : (
        <Nothing any={all.length > 0} onAll={() => onView({ ...view, hide: "", q: undefined })} />
      )}
    </>
  );
}

function Nothing({ any, onAll }: { any: boolean; onAll: () => void }) {
  return (
    <div className={classes.nothing}>
      <Text size="sm" c="dimmed">
        {any ? "Nothing of that is shown." : "Nothing was guessed, and nothing was left out."}
      </Text>
      {any ? (
        <Button size="compact-xs" variant="default" onClick={onAll}>
          Show everything
        </Button>
      ) : null}
    </div>
  );
}

/** Whether enlarging the plan can take these apart [m]. */
const isSpread = (members: readonly Finding[]): boolean =>
  members.some(({ x, y }) => Math.hypot(x - (members[0]?.x ?? x), y - (members[0]?.y ?? y)) > 2);

/** Another import gives other numbers: what was selected stays so, as what it has become. */
function useFollowing(
  digest: string,
  selected: Finding | undefined,
  all: readonly Finding[],
  select: (finding: Finding | undefined) => void,
) {
  const before = useRef({ digest, selected });
  useEffect(() => {
    const last = before.current;
    const other = last.digest !== digest;
    before.current = { digest, selected };
    if (!other || !last.selected) return;
    const now = again(last.selected, all);
    before.current = { digest, selected: now };
    select(now);
  });
}

/** A link to a finding leads there. */
function useFirstLook(selected: Finding | undefined, picture: React.RefObject<PlanPicture | undefined>) {
  const first = useRef(selected);
  useEffect(() => {
    if (first.current) picture.current?.centre(first.current);
  }, [picture]);
}

const SORTS: readonly string[] = ["mark", "kind", "what", "where"] satisfies SortKey[];

/** `-where` in the address is that column, falling. */
function readSort(text = "mark"): Sort {
  const key = text.replace(/^-/, "");
  return { key: SORTS.includes(key) ? (key as SortKey) : "mark", descending: text.startsWith("-") };
}

const writeSort = ({ key, descending }: Sort): string | undefined =>
  key === "mark" && !descending ? undefined : `${descending ? "-" : ""}${key}`;

/** Guessed heights do not matter to driving, and in a city they would cover everything that does. */
const hiddenAtFirst = (all: readonly Finding[]): string =>
  all.filter(({ kind }) => kind === "height").length > MANY ? "height" : "";

const MANY = 50;

/** `height,~high` in the address hides the kind height and the mark high. */
function readFilter(text: string): Filter {
  const names = text.split(",").filter(Boolean);
  const marks = names.filter((name) => name.startsWith("~")).map((name) => name.slice(1) as Mark);
  return { kinds: new Set(names.filter((name) => !name.startsWith("~"))), marks: new Set(marks) };
}

const writeFilter = ({ kinds, marks }: Filter): string => [...kinds, ...[...marks].map((mark) => `~${mark}`)].join(",");
