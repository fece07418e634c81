/** Two charts of the platoon, by default speed and gap, that grow while the run goes. */

import { useMemo, useState } from "react";
import { useGlossary } from "../../api/glossary";
import { type Columns, type Line, TimeChart } from "../../charts/TimeChart";
import { drawn, parts, quantitiesOf, quantity, vehiclesOf } from "../../model/channel";
import { carColors } from "../../model/palette";
import type { Samples } from "../../model/samples";
import { words } from "../../model/units";
import { useDark } from "../../ui/dark";
import { QuantitySelect } from "../../ui/QuantitySelect";
import { Empty } from "../../ui/State";
import classes from "./Studio.module.css";

interface Props {
  samples: Samples | undefined;
  version: number;
  duration: number;
  /** The paint of the cars, by name. */
  paints: Readonly<Record<string, string>>;
}

export function LiveCharts({ samples, version, duration, paints }: Props) {
  const [chosen, setChosen] = useState(["speed", "gap"]);
  if (!samples || Object.keys(samples.channels).length === 0) {
    return (
      <div className={classes.charts} data-empty>
        <Empty icon="chart" title="No samples yet">
          Press Run, or space: the platoon's speeds and gaps are drawn here while the run goes.
        </Empty>
      </div>
    );
  }
  const choose = (place: number, name: string) =>
    setChosen(chosen.map((old, index) => (index === place ? name : old)));
  return (
    <div className={classes.charts}>
      {chosen.map((name, place) => (
        <LiveChart
          key={place}
          name={name}
          samples={samples}
          version={version}
          duration={duration}
          paints={paints}
          onChoose={(next) => choose(place, next)}
        />
      ))}
    </div>
  );
}

interface ChartProps {
  name: string;
  samples: Samples;
  version: number;
  duration: number;
  paints: Readonly<Record<string, string>>;
  onChoose: (name: string) => void;
}

function LiveChart({ name, samples, version, duration, paints, onChoose }: ChartProps) {
  const dark = useDark();
  const names = Object.keys(samples.channels).join(" ");
  const shown = useMemo(() => drawn(name, names.split(" ")), [name, names]);
  const lines = useMemo(() => linesOf(shown, names.split(" "), paints, dark), [shown, names, paints, dark]);
  // The columns grow in place, `version` tells when.
  const data = useMemo<Columns>(
    () => [samples.time, ...shown.map((channel) => samples.channels[channel] ?? [])],
    [samples, shown, version],
  );
  const quantities = quantitiesOf(names.split(" "), useGlossary().channels);
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
