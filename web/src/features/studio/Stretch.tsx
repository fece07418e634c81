/** A stretch of a run that is played back: from here, to here, over and over, and what it measures. */

import { Button, Checkbox, Group, Popover, ScrollArea, Stack, Text } from "@mantine/core";
import { useQuery } from "@tanstack/react-query";
import { useState } from "react";
import { useGlossary } from "../../api/glossary";
import { stretch } from "../../api/queries";
import type { Span } from "../../charts/zoom";
import { titleOf } from "../../model/measure";
import { formatNumber, formatTime, unitText } from "../../model/units";
import { Icon } from "../../ui/Icon";
import { NumberEntry } from "../../ui/NumberEntry";
import { Failure, Loading } from "../../ui/State";
import { useShortcuts } from "../../ui/shortcut";
import { type Playhead, useLoop, useMoment } from "./playhead";
import classes from "./Studio.module.css";

interface Props {
  head: Playhead;
  /** The stretch that the charts show [s]. */
  span: Span | undefined;
  active: boolean;
}

/** [s] Whether a stretch can begin or end here need not be told of every picture. */
const GRAIN = 0.1;

export function Stretch({ head, span, active }: Props) {
  const loop = useLoop(head);
  const [open, setOpen] = useState(false);
  const [from, to] = loop ?? [head.begin, head.end];
  const begin = (time: number) => head.repeat([time, time < to ? to : head.end]);
  const end = (time: number) => head.repeat([time > from ? from : head.begin, time]);
  const time = useMoment(head, GRAIN) ?? head.time;
  const fromHere = [time, time < to ? to : head.end] as const;
  const toHere = [time > from ? from : head.begin, time] as const;
  useShortcuts({ i: () => head.repeat(fromHere), o: () => head.repeat(toHere) }, active);
  return (
    <Popover position="bottom-end" shadow="md" withinPortal trapFocus opened={open} onChange={setOpen} returnFocus>
      <Popover.Target>
        <Button size="compact-xs" variant={loop ? "light" : "default"} onClick={() => setOpen(!open)} leftSection={<Icon name="swap" size={12} />}>
          {loop ? `${formatTime(from)}–${formatTime(to)} s` : "Stretch"}
        </Button>
      </Popover.Target>
      <Popover.Dropdown aria-label="Stretch of the run">
        <Stack gap="xs" w={360}>
          <Group gap="xs" wrap="nowrap">
            <Edge label="From" value={from} range={[head.begin, to]} onTime={begin} />
            <Edge label="To" value={to} range={[from, head.end]} onTime={end} />
          </Group>
          <Group gap={6}>
            <Button size="compact-xs" variant="default" disabled={!head.holds(fromHere)} onClick={() => head.repeat(fromHere)}>
              From here (i)
            </Button>
            <Button size="compact-xs" variant="default" disabled={!head.holds(toHere)} onClick={() => head.repeat(toHere)}>
              To here (o)
            </Button>
            <Button size="compact-xs" variant="default" disabled={!span || !head.holds(span)} onClick={() => span && head.repeat(span)}>
              As the charts show
            </Button>
          </Group>
          <Checkbox
            size="xs"
            label="Play it over and over"
            checked={loop !== undefined}
            onChange={() => head.repeat(loop ? undefined : [from, to])}
          />
          {loop ? <Measures run={head.run} span={loop} /> : null}
        </Stack>
      </Popover.Dropdown>
    </Popover>
  );
}

interface EdgeProps {
  label: string;
  value: number;
  /** What it may be [s]. */
  range: Span;
  onTime: (time: number) => void;
}

function Edge({ label, value, range: [low, high], onTime }: EdgeProps) {
  const [refused, refuse] = useState(false);
  const take = (time: number) => {
    const fits = time >= low && time <= high;
    refuse(!fits);
    if (fits) onTime(time);
  };
  return (
    <label className={classes.edge}>
      <Text size="xs" span>
        {label}
      </Text>
      <NumberEntry size="xs" w={110} unit="s" decimals={3} value={value} onNumber={take} onEmpty={() => refuse(false)} error={refused ? `${formatTime(low)} to ${formatTime(high)} s` : undefined} />
    </label>
  );
}

/** What the stretch measures; what cannot be told of a part of a run says so. */
function Measures({ run, span }: { run: number; span: Span }) {
  const known = useGlossary().metrics;
  const { data, error, refetch } = useQuery(stretch(run, span));
  if (error) return <Failure error={error} onRetry={refetch} />;
  if (!data) return <Loading what="the metrics of this stretch" />;
  const rows = Object.entries(data.metrics);
  const silent = rows.filter(([, { value }]) => value === null);
  return (
    <ScrollArea.Autosize mah={320} type="auto">
      <table className={classes.measures} aria-label="Metrics of this stretch">
        <tbody>
          {rows.map(([name, { value, unit, about }]) =>
            value === null ? null : (
              <tr key={name} title={about}>
                <th scope="row">{titleOf(name, known)}</th>
                <td>{formatNumber(value)}</td>
                <td>{unitText(unit)}</td>
              </tr>
            ),
          )}
        </tbody>
      </table>
      {silent.length ? (
        <details>
          <summary>{silent.length} have no value here</summary>
          <ul>
            {silent.map(([name, { about }]) => (
              <li key={name}>
                {titleOf(name, known)}
                {about ? `: ${about}` : ""}
              </li>
            ))}
          </ul>
        </details>
      ) : null}
    </ScrollArea.Autosize>
  );
}
