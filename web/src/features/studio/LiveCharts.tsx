/** The charts of a run, by default the platoon's speed and gap: they grow while it goes, and are arranged as one likes. */

import { ActionIcon, Button, Popover, Select, Stack, Text, Tooltip } from "@mantine/core";
import { useMemo } from "react";
import { useGlossary } from "../../api/glossary";
import { type Columns, type Line, TimeChart } from "../../charts/TimeChart";
import { type Curve, XYChart } from "../../charts/XYChart";
import type { Zoom } from "../../charts/zoom";
import { beyondOf, type Spanned } from "../../model/beyond";
import { drawn, leadersOf, parts, type Quantity, quantity, recorded, vehiclesOf } from "../../model/channel";
import {
  type Layout,
  otherUnit,
  replaced,
  type Setup,
  type TimeSetup,
  timeSetup,
  withChannel,
  without,
  withoutChannel,
  type XYSetup,
} from "../../model/layout";
import { carColors, lineColor } from "../../model/palette";
import type { Channel, Json } from "../../model/run";
import type { Samples } from "../../model/samples";
import { withUnit, words } from "../../model/units";
import { bandsOf } from "../../model/wanted";
import { useDark } from "../../ui/dark";
import { Icon } from "../../ui/Icon";
import { QuantitySelect } from "../../ui/QuantitySelect";
import { Empty, Loading } from "../../ui/State";
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
  /** The scenario of the run, for its goals and platoons. */
  document: Json | undefined;
  /** Where vehicles were outside their validated span. */
  spanned: readonly Spanned[] | undefined;
}

interface Props extends Omit<Shared, "samples"> {
  /** Whether a run is shown, whose samples come. */
  coming: boolean;
  samples: Samples | undefined;
  /** What there is to choose from. */
  channels: readonly Channel[];
  layout: Layout;
  onLayout: (layout: Layout) => void;
}

export function LiveCharts({ coming, samples, channels, layout, onLayout, ...shared }: Props) {
  const glossary = useGlossary().channels;
  const quantities = useMemo(() => recorded(channels, glossary), [channels, glossary]);
  const names = useMemo(() => channels.map(({ name }) => name), [channels]);
  if (!samples || channels.length === 0) {
    return (
      <div className={classes.charts} data-empty>
        {coming ? (
          <Loading what="what was recorded" />
        ) : (
          <Empty icon="chart" title="No samples yet">
            Press Run, or space: speeds and gaps of the cars are drawn here while the run goes.
          </Empty>
        )}
      </div>
    );
  }
  const unitOf = (name: string) => quantity(name.slice(name.indexOf(".") + 1), quantities).unit;
  const common = { names, quantities, samples, unitOf, ...shared };
  return (
    <div className={classes.chartsFrame} role="region" aria-label="Charts">
      <div className={classes.charts}>
      {layout.map((setup, place) => {
        const change = (next: Setup) => onLayout(replaced(layout, place, next));
        const tools = layout.length > 1 ? <Remove onClick={() => onLayout(without(layout, place))} /> : null;
        return setup.form === "xy" ? (
          <XY key={place} setup={setup} onChange={change} tools={tools} {...common} />
        ) : (
          <OverTime
            key={place}
            setup={setup}
            onChange={change}
            tools={
              <>
                <Channels
                  setup={setup}
                  channels={channels}
                  onAdd={(channel) => onLayout(withChannel(layout, place, channel, unitOf))}
                  onRemove={(channel) => change(withoutChannel(setup, channel))}
                />
                {tools}
              </>
            }
            {...common}
          />
        );
      })}
      </div>
      <div className={classes.addChart}>
        <Button size="compact-xs" variant="subtle" leftSection={<Icon name="plus" size={12} />} onClick={() => onLayout([...layout, timeSetup("acceleration")])}>
          Chart over time
        </Button>
        <Button size="compact-xs" variant="subtle" leftSection={<Icon name="plus" size={12} />} onClick={() => onLayout([...layout, { form: "xy", x: "gap", y: "speed" }])}>
          XY chart
        </Button>
      </div>
    </div>
  );
}

interface ChartProps<Kind extends Setup> extends Shared {
  setup: Kind;
  onChange: (setup: Setup) => void;
  tools: React.ReactNode;
  /** Of all channels. */
  names: readonly string[];
  quantities: readonly Quantity[];
  unitOf: (channel: string) => string;
}

function OverTime({ setup, onChange, tools, names, quantities, unitOf, samples, version, paints, document, spanned, ...chart }: ChartProps<TimeSetup>) {
  const dark = useDark();
  const more = useMemo(() => setup.more.filter((name) => names.includes(name)), [setup, names]);
  const shown = useMemo(() => {
    const own = drawn(setup.quantity, names, leadersOf(document));
    return [...own, ...more.filter((name) => !own.includes(name))];
  }, [setup, names, more, document]);
  const { label, unit } = quantity(setup.quantity, quantities);
  const right = otherUnit({ ...setup, more }, unitOf);
  const lines = useMemo(
    () => linesOf(shown, names, paints, dark).map((line) => extra(line, setup, right, unitOf, quantities)),
    [shown, names, paints, dark, setup, right, quantities],
  );
  // The columns grow in place, `version` tells when.
  const data = useMemo<Columns>(
    () => [samples.time, ...shown.map((channel) => samples.channels[channel] ?? [])],
    [samples, shown, version],
  );
  const shades = useMemo(() => bandsOf(document, setup.quantity), [document, setup.quantity]);
  const beyond = useMemo(() => beyondOf(spanned, shown.map((channel) => parts(channel).vehicle)), [spanned, shown]);
  return (
    <div className={classes.chart}>
      <TimeChart
        title={label}
        unit={unit}
        lines={lines}
        data={data}
        version={version}
        sync="live"
        height={60}
        rightUnit={right}
        shades={shades}
        beyond={beyond}
        {...chart}
        lead={
          <>
            <QuantitySelect value={setup.quantity} quantities={quantities} onChange={(name) => onChange({ ...setup, quantity: name })} />
            {tools}
          </>
        }
      />
    </div>
  );
}

/** A line that is not of the chart's own quantity says what it is of. */
function extra(line: Line, setup: TimeSetup, right: string | undefined, unitOf: (name: string) => string, quantities: readonly Quantity[]): Line {
  const { vehicle, quantity: name } = parts(line.key);
  if (name === setup.quantity) return line;
  const label = `${words(vehicle)} ${quantity(name, quantities).label.toLowerCase()}`;
  return { ...line, label, dash: [5, 3], right: right !== undefined && unitOf(line.key) === right };
}

function XY({ setup, onChange, tools, names, quantities, samples, version, paints, document, head }: ChartProps<XYSetup>) {
  const dark = useDark();
  const curves = useMemo<Curve[]>(() => {
    const pairs = drawn(setup.y, names, leadersOf(document)).map((name) => [`${parts(name).vehicle}.${setup.x}`, name] as const);
    const both = pairs.filter(([x]) => names.includes(x));
    const lines = linesOf(both.map(([, y]) => y), names, paints, dark);
    return both.map(([x, y], place) => ({
      ...(lines[place] as Line),
      time: samples.time,
      x: samples.channels[x] ?? [],
      y: samples.channels[y] ?? [],
    }));
  }, [setup, names, paints, document, dark, samples, version]);
  const named = (name: string) => withUnit(quantity(name, quantities).label, quantity(name, quantities).unit);
  return (
    <div className={classes.chart}>
      <XYChart
        x={named(setup.x)}
        y={named(setup.y)}
        curves={curves}
        version={version}
        head={head}
        lead={
          <>
            <QuantitySelect label="Upwards" value={setup.y} quantities={quantities} onChange={(y) => onChange({ ...setup, y })} />
            over
            <QuantitySelect label="To the right" value={setup.x} quantities={quantities} onChange={(x) => onChange({ ...setup, x })} />
            {tools}
          </>
        }
      />
    </div>
  );
}

function Remove({ onClick }: { onClick: () => void }) {
  return (
    <Tooltip label="Remove this chart">
      <ActionIcon size={24} variant="subtle" color="gray" aria-label="Remove this chart" onClick={onClick}>
        <Icon name="close" size={12} />
      </ActionIcon>
    </Tooltip>
  );
}

interface ChannelsProps {
  setup: TimeSetup;
  channels: readonly Channel[];
  onAdd: (channel: string) => void;
  onRemove: (channel: string) => void;
}

/** Any recorded channel of anybody, into this chart. */
function Channels({ setup, channels, onAdd, onRemove }: ChannelsProps) {
  const data = useMemo(
    () => channels.filter(({ name }) => !setup.more.includes(name)).map(({ name, unit, label }) => ({ value: name, label: `${name}, ${withUnit(label, unit)}` })),
    [channels, setup],
  );
  return (
    <Popover position="top-start" shadow="md" withinPortal trapFocus returnFocus>
      <Popover.Target>
        <Tooltip label="Add channels of other cars or units">
          <ActionIcon size={24} variant="subtle" color="gray" aria-label="Channels of this chart">
            <Icon name="plus" size={12} />
          </ActionIcon>
        </Tooltip>
      </Popover.Target>
      <Popover.Dropdown aria-label="Channels of this chart">
        <Stack gap={6} w={340}>
          <Select
            size="xs"
            searchable
            limit={60}
            label="Add a channel"
            placeholder="speed, traffic_03, radar …"
            nothingFoundMessage="No such channel was recorded"
            comboboxProps={{ withinPortal: false }}
            data={data}
            value={null}
            onChange={(name) => name && onAdd(name)}
          />
          {setup.more.map((name) => (
            <span key={name} className={classes.channel}>
              <Text size="xs" span>
                {name}
              </Text>
              <ActionIcon size={20} variant="subtle" color="gray" aria-label={`Remove ${name}`} onClick={() => onRemove(name)}>
                <Icon name="close" size={10} />
              </ActionIcon>
            </span>
          ))}
          <Text size="xs" c="dimmed">
            Channels of one other unit get an axis at the right; those of a third get a chart of their own.
          </Text>
        </Stack>
      </Popover.Dropdown>
    </Popover>
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
  return channels.map((channel, place) => {
    const { vehicle } = parts(channel);
    const known = vehicles.indexOf(vehicle);
    return { key: channel, label: words(vehicle), color: known < 0 ? lineColor(place, dark) : (colors[known] as string) };
  });
}
