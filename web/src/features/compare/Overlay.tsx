/** The charts of all runs in one, with linked cursors, on the clock of the first run. */

import { Checkbox, Group, NativeSelect, Text } from "@mantine/core";
import { useQueries } from "@tanstack/react-query";
import { Link } from "@tanstack/react-router";
import { type ReactNode, useMemo, useState } from "react";
import { useGlossary } from "../../api/glossary";
import { beyond as beyondQuery, run as runQuery, trace, useAggregates } from "../../api/queries";
import { Stroke } from "../../charts/Stroke";
import { type Columns, type Line, TimeChart } from "../../charts/TimeChart";
import { useZoom, type Zoom } from "../../charts/zoom";
import { commonKinds, merged, namesOf, offsetsOf, type SideBySide } from "../../model/beside";
import { beyondOf, beyondOfRuns } from "../../model/beyond";
import { drawn, leadersOf, parts, type Quantity, quantity, recorded, vehiclesOf } from "../../model/channel";
import { carColors, paintsOf } from "../../model/palette";
import type { Run, RunDetail } from "../../model/run";
import { formatDifference, words } from "../../model/units";
import { useDark } from "../../ui/dark";
import { QuantitySelect } from "../../ui/QuantitySelect";
import { Empty, Failure, Loading } from "../../ui/State";
import { Aggregates } from "../../ui/Aggregates";
import classes from "./Compare.module.css";
import { styleOf } from "./line";

/** Rows of a trace: about as many as a wide screen has pixels. */
const POINTS = 2000;
/** So many lines are in one chart at first: of more nobody sees anything. */
const LINES = 12;

export function Overlay({ found }: { found: SideBySide }) {
  const asked = useQueries({ queries: found.runs.map(({ run }) => runQuery(run)) });
  const details = asked.map(({ data }) => data);
  if (!details.every((each) => each !== undefined)) return <Loading what="the traces" />;
  if (details.every(({ channels }) => channels.length === 0))
    return (
      <Empty icon="chart" title="No traces">
        None of the runs recorded anything.
      </Empty>
    );
  return (
    <>
      <Charts found={found} details={details} />
      <section className={classes.card} aria-label="A channel in numbers">
        <h2>A channel in numbers</h2>
        <Aggregates runs={details} useFound={useAggregates} />
      </section>
    </>
  );
}

function Charts({ found, details }: { found: SideBySide; details: readonly RunDetail[] }) {
  const [chosen, setChosen] = useState(["speed", "gap"]);
  const [hiding, setHidden] = useState<string[]>();
  const [aligned, setAligned] = useState<string>();
  const key = found.runs.map(({ run }) => run).join(" ");
  const zoom = useZoom(`${key} ${aligned ?? ""}`);
  const had = useMemo(() => details.map(({ channels }) => channels.map(({ name }) => name)), [details]);
  const all = useMemo(() => [...new Set(had.flat())], [had]);
  const colors = useColors(all, details);
  const events = details.map((each) => each.events);
  const offsets = offsetsOf(events, aligned);
  const hidden = hiding ?? Object.keys(colors).slice(Math.max(1, Math.floor(LINES / details.length)));
  const names = namesOf(found.runs, found.parameters);
  const known = useGlossary().channels;
  const quantities = recorded(details.flatMap(({ channels }) => channels), known);
  return (
    <section className={`${classes.card} ${classes.wide}`} aria-label="Charts of all runs" data-testid="compare-charts">
      <Group gap="md" mb={4} className={classes.over}>
        <h2>Over time</h2>
        <Align kinds={commonKinds(events)} chosen={aligned} onChoose={setAligned} />
        <Runs names={names} offsets={offsets} />
        <InScene runs={found.runs} aligned={aligned} time={firstTime(events[0] ?? [], aligned)} />
        <Vehicles colors={colors} hidden={hidden} onHidden={setHidden} plain={details.length > 2} />
      </Group>
      <div className={classes.charts}>
        {chosen.map((name, place) => (
          <div key={place}>
            <Chart
              runs={details}
              names={names}
              offsets={offsets}
              shown={quantity(name, quantities)}
              colors={colors}
              had={had}
              hidden={hidden}
              zoom={zoom}
              lead={
                <QuantitySelect
                  value={name}
                  quantities={quantities}
                  onChange={(next) => setChosen(chosen.map((old, index) => (index === place ? next : old)))}
                />
              }
            />
          </div>
        ))}
      </div>
    </section>
  );
}

/** The colour of each vehicle. */
type Colors = Readonly<Record<string, string>>;

function useColors(all: readonly string[], details: readonly RunDetail[]): Colors {
  const dark = useDark();
  return useMemo(() => {
    const vehicles = vehiclesOf(all);
    const paints = Object.assign({}, ...details.map(({ document }) => paintsOf(document)).reverse());
    const found = carColors(vehicles, paints, dark);
    return Object.fromEntries(vehicles.map((vehicle, index) => [vehicle, found[index] as string]));
  }, [all, details, dark]);
}

interface AlignProps {
  kinds: readonly string[];
  chosen: string | undefined;
  onChoose: (kind: string | undefined) => void;
}

/** What is at the same place of the time axis in all runs. */
function Align({ kinds, chosen, onChoose }: AlignProps) {
  return (
    <NativeSelect
      size="xs"
      aria-label="Align the runs by"
      value={chosen ?? ""}
      onChange={({ currentTarget: { value } }) => onChoose(value || undefined)}
      data={[
        { value: "", label: "Aligned by time" },
        ...kinds.map((kind) => ({ value: kind, label: `by the first “${words(kind).toLowerCase()}”` })),
      ]}
    />
  );
}

/** When the event was by which the runs are aligned [s]; without one, when they begin. */
const firstTime = (events: RunDetail["events"], kind: string | undefined): number => events.find((event) => event.kind === kind)?.time ?? 0;

/** The first run in the 3D scene, and the others as ghosts among its cars, on one clock. */
function InScene({ runs: [first, ...others], aligned, time }: { runs: readonly Run[]; aligned: string | undefined; time: number }) {
  if (!first || others.length === 0) return null;
  return (
    <Link
      to="/studio/$scenario"
      params={{ scenario: first.scenario }}
      search={{ run: first.run, ghosts: others.map(({ run }) => run).join(","), align: aligned, time }}
      className={classes.link}
      style={{ fontSize: "var(--mantine-font-size-sm)" }}
    >
      Show in the scene
    </Link>
  );
}

/** Which line is whose, and by how much it was moved. */
function Runs({ names, offsets }: { names: readonly string[]; offsets: readonly number[] }) {
  const dark = useDark();
  return names.map((name, place) => (
    <Text key={name} size="xs" span className={classes.run}>
      <Stroke {...styleOf({ place, of: names.length, vehicle: 0, color: "currentColor", dark })} width={22} /> {name}
      {offsets[place] ? `, moved by ${formatDifference(-Number(offsets[place].toFixed(2)))} s` : ""}
    </Text>
  ));
}

interface VehiclesProps {
  colors: Colors;
  hidden: readonly string[];
  onHidden: (hidden: string[]) => void;
  /** Whether colours stand for runs, and not for vehicles. */
  plain: boolean;
}

/** Which vehicles are drawn. */
function Vehicles({ colors, hidden, onHidden, plain }: VehiclesProps) {
  return Object.entries(colors).map(([vehicle, color]) => (
    <Checkbox
      key={vehicle}
      size="xs"
      {...(plain ? {} : { color })}
      autoContrast
      label={words(vehicle)}
      checked={!hidden.includes(vehicle)}
      onChange={() =>
        onHidden(
          hidden.includes(vehicle) ? hidden.filter((other) => other !== vehicle) : [...hidden, vehicle],
        )
      }
    />
  ));
}

const NOTHING = { time: [], channels: {} };

interface ChartProps {
  runs: readonly RunDetail[];
  names: readonly string[];
  offsets: readonly number[];
  shown: Quantity;
  colors: Colors;
  /** The channels of each run. */
  had: readonly (readonly string[])[];
  hidden: readonly string[];
  zoom: Zoom;
  lead: ReactNode;
}

function Chart({ runs, names, offsets, shown: { name, label, unit }, colors, had, hidden, zoom, lead }: ChartProps) {
  const dark = useDark();
  // A run is asked only for what it has recorded, and for the stretch of its own clock that is seen.
  const own = useMemo(() => {
    const isShown = (channel: string) => !hidden.includes(parts(channel).vehicle);
    return had.map((known, place) => drawn(name, known, leadersOf(runs[place]?.document)).filter(isShown));
  }, [runs, had, name, hidden]);
  const asked = useQueries({
    queries: runs.map(({ run }, place) => trace(run, own[place] ?? [], { points: POINTS, span: moved(zoom.span, offsets[place] ?? 0) })),
  });
  const traces = asked.map(({ data }) => data ?? NOTHING);
  const version = asked.map(({ dataUpdatedAt }) => dataUpdatedAt).join(" ");
  const shift = offsets.join(" ");
  const lines = useMemo<Line[]>(() => linesOf(own, names, colors, dark), [own, names.join("\n"), colors, dark]);
  const data = useMemo<Columns>(() => merged(traces, offsets, own), [version, shift, own]);
  const beyond = useBeyond(runs, names, offsets, own);
  const error = asked.find((each) => each.error)?.error;
  if (error) return <Failure error={error} />;
  if (own.every((channels) => channels.length === 0))
    return (
      <Empty icon="chart" title="Nothing to draw">
        No shown vehicle has this quantity.
      </Empty>
    );
  if (asked.some(({ isLoading }) => isLoading)) return <Loading what="the traces" />;
  return (
    <div className={classes.chart}>
      <TimeChart title={label} unit={unit} lines={lines} data={data} sync="compare" zoom={zoom} lead={lead} beyond={beyond} />
    </div>
  );
}

/** When vehicles that are drawn were outside their validated spans, in any of the runs. */
function useBeyond(runs: readonly RunDetail[], names: readonly string[], offsets: readonly number[], own: readonly (readonly string[])[]) {
  const asked = useQueries({ queries: runs.map((run) => beyondQuery(run)) });
  const version = asked.map(({ dataUpdatedAt }) => dataUpdatedAt).join(" ");
  return useMemo(() => {
    const vehicles = own.map((channels) => channels.map((channel) => parts(channel).vehicle));
    const found = asked.map(({ data }, place) => ({
      name: names[place] ?? "",
      offset: offsets[place] ?? 0,
      beyond: beyondOf(data, vehicles[place]),
    }));
    return beyondOfRuns(found);
  }, [version, names.join("\n"), offsets.join(" "), own]);
}

/** A stretch of the first run's clock on that of a run that is so much later [s]. */
const moved = (span: Zoom["span"], offset: number): Zoom["span"] => (span ? [Math.max(0, span[0] + offset), span[1] + offset] : undefined);

/** Run after run, as `merged` puts them. The legend names only what there is more than one of. */
function linesOf(own: readonly (readonly string[])[], names: readonly string[], colors: Colors, dark: boolean): Line[] {
  const vehicles = vehiclesOf(own.flat());
  return own.flatMap((channels, place) =>
    channels.map((channel) => {
      const { vehicle } = parts(channel);
      const at = vehicles.indexOf(vehicle);
      const style = styleOf({ place, of: own.length, vehicle: at, color: colors[vehicle] as string, dark });
      return { key: `${place} ${channel}`, label: vehicles.length > 1 ? words(vehicle) : (names[place] as string), ...style };
    }),
  );
}
