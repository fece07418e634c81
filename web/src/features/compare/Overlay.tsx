/** The charts of both runs in one: A solid, B dashed, one colour per vehicle, linked cursors. */

import { Checkbox, Group } from "@mantine/core";
import { useQuery } from "@tanstack/react-query";
import { type ReactNode, useMemo, useState } from "react";
import { useGlossary } from "../../api/glossary";
import { run as runQuery, trace } from "../../api/queries";
import { type Columns, type Line, TimeChart } from "../../charts/TimeChart";
import { useZoom, type Zoom } from "../../charts/zoom";
import { drawn, parts, type Quantity, quantity, recorded, vehiclesOf } from "../../model/channel";
import { merge } from "../../model/compare";
import { carColors, paintsOf } from "../../model/palette";
import type { Run } from "../../model/run";
import { words } from "../../model/units";
import { useDark } from "../../ui/dark";
import { QuantitySelect } from "../../ui/QuantitySelect";
import { Empty, Failure, Loading } from "../../ui/State";
import classes from "./Compare.module.css";

/** Rows of a trace: about as many as a wide screen has pixels. */
const POINTS = 2000;

export function Overlay({ a, b }: { a: Run; b: Run }) {
  const one = useQuery(runQuery(a.run));
  const other = useQuery(runQuery(b.run));
  const [chosen, setChosen] = useState(["speed", "gap"]);
  const [hidden, setHidden] = useState<string[]>([]);
  const zoom = useZoom(`${a.run} ${b.run}`);
  const names = useMemo(
    () => [one.data, other.data].map((run) => (run?.channels ?? []).map(({ name }) => name)),
    [one.data, other.data],
  );
  const all = useMemo(() => [...new Set(names.flat())], [names]);
  const known = useGlossary().channels;
  const dark = useDark();
  const colors = useMemo(() => {
    const vehicles = vehiclesOf(all);
    const paints = { ...paintsOf(other.data?.document), ...paintsOf(one.data?.document) };
    const found = carColors(vehicles, paints, dark);
    return Object.fromEntries(vehicles.map((vehicle, index) => [vehicle, found[index] as string]));
  }, [all, one.data, other.data, dark]);
  if (!one.data || !other.data) return <Loading what="the traces" />;
  if (all.length === 0)
    return (
      <Empty icon="chart" title="No traces">
        Neither run recorded anything.
      </Empty>
    );
  const quantities = recorded([...one.data.channels, ...other.data.channels], known);
  return (
    <section className={classes.card} aria-label="Charts of both runs" data-testid="compare-charts">
      <Group gap="md" mb={4} className={classes.over}>
        <h2>Over time</h2>
        <Vehicles colors={colors} hidden={hidden} onHidden={setHidden} />
      </Group>
      <div className={classes.charts}>
        {chosen.map((name, place) => (
          <div key={place}>
            <Both
              a={a.run}
              b={b.run}
              shown={quantity(name, quantities)}
              all={all}
              colors={colors}
              had={names}
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

interface VehiclesProps {
  colors: Colors;
  hidden: readonly string[];
  onHidden: (hidden: string[]) => void;
}

/** Which vehicles are drawn. */
function Vehicles({ colors, hidden, onHidden }: VehiclesProps) {
  return Object.entries(colors).map(([vehicle, color]) => (
    <Checkbox
      key={vehicle}
      size="xs"
      color={color}
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

interface BothProps {
  a: number;
  b: number;
  shown: Quantity;
  all: readonly string[];
  colors: Colors;
  /** The channels of each run. */
  had: readonly (readonly string[])[];
  hidden: readonly string[];
  zoom: Zoom;
  lead: ReactNode;
}

function Both({ a, b, shown: { name, label, unit }, all, colors, had, hidden, zoom, lead }: BothProps) {
  const channels = useMemo(
    () => drawn(name, all).filter((channel) => !hidden.includes(parts(channel).vehicle)),
    [name, all, hidden],
  );
  // A run is asked only for what it has recorded.
  const [ofA, ofB] = had.map((known) => channels.filter((channel) => known.includes(channel)));
  const one = useQuery(trace(a, ofA ?? [], { points: POINTS, span: zoom.span }));
  const other = useQuery(trace(b, ofB ?? [], { points: POINTS, span: zoom.span }));
  const lines = useMemo<Line[]>(() => linesOf(channels, colors), [channels, colors]);
  const data = useMemo<Columns>(
    () => merge(one.data ?? NOTHING, other.data ?? NOTHING, channels),
    [one.data, other.data, channels],
  );
  const error = one.error ?? other.error;
  if (error) return <Failure error={error} />;
  if (channels.length === 0)
    return (
      <Empty icon="chart" title="Nothing to draw">
        No shown vehicle has this quantity.
      </Empty>
    );
  if (one.isLoading || other.isLoading) return <Loading what="the traces" />;
  return (
    <div className={classes.chart}>
      <TimeChart title={label} unit={unit} lines={lines} data={data} sync="compare" zoom={zoom} lead={lead} />
    </div>
  );
}

/** First all lines of A, then all of B, as `merge` puts them. */
function linesOf(channels: readonly string[], colors: Colors): Line[] {
  return (["A", "B"] as const).flatMap((side) =>
    channels.map((channel) => {
      const { vehicle } = parts(channel);
      const color = colors[vehicle] as string;
      return { key: `${side} ${channel}`, label: words(vehicle), color, dashed: side === "B" };
    }),
  );
}
