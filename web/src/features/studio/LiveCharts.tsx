/** Two charts of the platoon, by default speed and gap, that grow while the run goes. */

import { useMemo } from "react";
import { useGlossary } from "../../api/glossary";
import { type Columns, type Line, TimeChart } from "../../charts/TimeChart";
import type { Zoom } from "../../charts/zoom";
import { drawn, parts, type Quantity, quantity, recorded, vehiclesOf } from "../../model/channel";
import { carColors } from "../../model/palette";
import type { Channel } from "../../model/run";
import type { Samples } from "../../model/samples";
import { words } from "../../model/units";
import { useDark } from "../../ui/dark";
import { QuantitySelect } from "../../ui/QuantitySelect";
import { Empty } from "../../ui/State";
import type { Playhead } from "./playhead";
import classes from "./Studio.module.css";

interface Shared {
  samples: Samples;
  version: number;
  duration: number;
  /** The paint of the cars, by name. */
  paints: Readonly<Record<string, string>>;
  /** Of a run that is played back. */
  head: Playhead | undefined;
  zoom: Zoom;
}

interface Props extends Omit<Shared, "samples"> {
  samples: Samples | undefined;
  /** What there is to choose from. */
  channels: readonly Channel[];
  /** The quantities that are shown, one per chart. */
  chosen: readonly string[];
  onChoose: (chosen: string[]) => void;
}

export function LiveCharts({ samples, channels, chosen, onChoose, ...shared }: Props) {
  const glossary = useGlossary().channels;
  const quantities = useMemo(() => recorded(channels, glossary), [channels, glossary]);
  const names = useMemo(() => channels.map(({ name }) => name), [channels]);
  if (!samples || channels.length === 0) {
    return (
      <div className={classes.charts} data-empty>
        <Empty icon="chart" title="No samples yet">
          Press Run, or space: the platoon's speeds and gaps are drawn here while the run goes.
        </Empty>
      </div>
    );
  }
  const choose = (place: number, name: string) =>
    onChoose(chosen.map((old, index) => (index === place ? name : old)));
  return (
    <div className={classes.charts}>
      {chosen.map((name, place) => (
        <LiveChart
          key={place}
          name={name}
          names={names}
          quantities={quantities}
          samples={samples}
          onChoose={(next) => choose(place, next)}
          {...shared}
        />
      ))}
    </div>
  );
}

interface ChartProps extends Shared {
  name: string;
  /** Of all channels. */
  names: readonly string[];
  quantities: readonly Quantity[];
  onChoose: (name: string) => void;
}

function LiveChart({ name, names, quantities, samples, version, duration, paints, head, zoom, onChoose }: ChartProps) {
  const dark = useDark();
  const shown = useMemo(() => drawn(name, names), [name, names]);
  const lines = useMemo(() => linesOf(shown, names, paints, dark), [shown, names, paints, dark]);
  // The columns grow in place, `version` tells when.
  const data = useMemo<Columns>(
    () => [samples.time, ...shown.map((channel) => samples.channels[channel] ?? [])],
    [samples, shown, version],
  );
  const { label, unit } = quantity(name, quantities);
  return (
    <div className={classes.chart}>
      <TimeChart
        title={label}
        unit={unit}
        lines={lines}
        data={data}
        version={version}
        sync="live"
        duration={duration}
        height={60}
        head={head}
        zoom={zoom}
        lead={<QuantitySelect value={name} quantities={quantities} onChange={onChoose} />}
      />
    </div>
  );
}

/** One line per vehicle; a vehicle has the same colour in every chart. */
function linesOf(
  channels: readonly string[],
  all: readonly string[],
  paints: Readonly<Record<string, string>>,
  dark: boolean,
): Line[] {
  const vehicles = vehiclesOf(all);
  const colors = carColors(vehicles, paints, dark);
  return channels.map((channel) => {
    const { vehicle } = parts(channel);
    return { key: channel, label: words(vehicle), color: colors[vehicles.indexOf(vehicle)] as string };
  });
}
