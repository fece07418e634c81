/** The timeline of a run that is over: play, step, jump, an exact time, and what happened when. */

import { ActionIcon, NativeSelect, Slider, Text, Tooltip, VisuallyHidden } from "@mantine/core";
import { memo, useMemo } from "react";
import type { Span } from "../../charts/zoom";
import { type Beyond, beyondOf, type Spanned } from "../../model/beyond";
import type { RunEvent } from "../../model/run";
import { formatNumber, formatTime } from "../../model/units";
import { Icon, type IconName } from "../../ui/Icon";
import { NumberEntry } from "../../ui/NumberEntry";
import { useShortcuts } from "../../ui/shortcut";
import { PACES, type Playhead, useMoment, usePace, usePlaying } from "./playhead";
import { Stretch } from "./Stretch";
import classes from "./Studio.module.css";

interface Props {
  head: Playhead;
  events: readonly RunEvent[];
  /** What is not as it was, or is missing. */
  notes: readonly string[];
  active: boolean;
  /** The stretch that the charts show [s]; none when they show all of it. */
  span: Span | undefined;
  /** Where vehicles were outside their validated span. */
  spanned: readonly Spanned[] | undefined;
}

export const Timeline = memo(function Timeline({ head, events, notes, active, span, spanned }: Props) {
  const toEvent = (way: 1 | -1) => {
    const time = nextEvent(events, head.time, way);
    if (time !== undefined) head.seek(time);
  };
  useShortcuts(
    {
      ",": () => head.move(-1),
      ".": () => head.move(1),
      "<": () => head.jump(-1),
      ">": () => head.jump(1),
      "[": () => toEvent(-1),
      "]": () => toEvent(1),
    },
    active,
  );
  const beyond = useMemo(() => beyondOf(spanned), [spanned]);
  const step = `${formatNumber(Number((1000 * head.step).toFixed(3)))} ms`;
  return (
    <div className={classes.timeline} role="toolbar" aria-label="Playback">
      <ActionIcon.Group>
        <Press icon="left" label="Previous event ([)" onClick={() => toEvent(-1)} />
        <Press icon="back" label={`Back by one sample, ${step} (,)`} onClick={() => head.move(-1)} />
        <Toggle head={head} />
        <Press icon="step" label={`On by one sample, ${step} (.)`} onClick={() => head.move(1)} />
        <Press icon="right" label="Next event (])" onClick={() => toEvent(1)} />
      </ActionIcon.Group>
      <Speed head={head} />
      <Scrubber head={head} events={events} beyond={beyond} />
      <Moment head={head} />
      <Stretch head={head} span={span} active={active} />
      {notes.length ? (
        <Tooltip label={notes.join(" ")} multiline maw={360}>
          <span className={classes.notes} role="note" tabIndex={0} data-testid="playback-notes">
            <Icon name="warning" size={14} />
            <VisuallyHidden>{notes.join(" ")}</VisuallyHidden>
          </span>
        </Tooltip>
      ) : null}
    </div>
  );
});

/** The time of the next event after, or of the last before, a time [s]. */
export function nextEvent(events: readonly RunEvent[], time: number, way: 1 | -1): number | undefined {
  const times = events.map((event) => event.time);
  const some = way > 0 ? times.filter((each) => each > time + SAME) : times.filter((each) => each < time - SAME);
  return some.length ? (way > 0 ? Math.min(...some) : Math.max(...some)) : undefined;
}

/** [s] Times that differ by less are the same. */
const SAME = 1e-6;

function Press({ icon, label, onClick }: { icon: IconName; label: string; onClick: () => void }) {
  return (
    <Tooltip label={label}>
      <ActionIcon size={28} variant="default" aria-label={label} onClick={onClick}>
        <Icon name={icon} size={14} />
      </ActionIcon>
    </Tooltip>
  );
}

function Toggle({ head }: { head: Playhead }) {
  const playing = usePlaying(head);
  return <Press icon={playing ? "pause" : "run"} label={playing ? "Pause playback (space)" : "Play (space)"} onClick={head.toggle} />;
}

function Speed({ head }: { head: Playhead }) {
  const pace = usePace(head);
  return (
    <NativeSelect
      size="xs"
      className={classes.pace}
      aria-label="Pace of the playback"
      data={PACES.map((each) => ({ value: String(each), label: Number.isFinite(each) ? `${each} × real time` : "Without a limit" }))}
      value={String(pace)}
      onChange={({ currentTarget: { value } }) => head.choosePace(Number(value))}
    />
  );
}

function Scrubber({ head, events, beyond }: { head: Playhead; events: readonly RunEvent[]; beyond: Beyond | undefined }) {
  const time = useMoment(head, 0.01) ?? head.begin;
  const marks = useMemo(
    () => [...new Set(events.map((event) => event.time))].map((value) => ({ value })),
    [events],
  );
  return (
    <div className={classes.scrubber}>
      <Slider
        size="sm"
        min={head.begin}
        max={head.end}
        step={head.step}
        value={time}
        onChange={head.seek}
        marks={marks}
        restrictToMarks={false}
        label={(value) => `${formatTime(value)} s`}
        thumbLabel="Time of the playback"
      />
      {beyond ? <Outside beyond={beyond} begin={head.begin} end={head.end} /> : null}
    </div>
  );
}

/** Under the slider, when a vehicle was outside the span that it was validated for. */
function Outside({ beyond, begin, end }: { beyond: Beyond; begin: number; end: number }) {
  const share = (time: number) => (100 * (Math.min(Math.max(time, begin), end) - begin)) / Math.max(end - begin, 1e-9);
  const told = `Outside its validated span: ${beyond.worst}`;
  return (
    <Tooltip label={`Outside the validated span.\n${beyond.all}`} multiline maw={420} style={{ whiteSpace: "pre-line" }}>
      <div className={classes.beyond} role="img" aria-label={told}>
        {beyond.parts.map(([from, to]) => (
          <span key={from} style={{ left: `${share(from)}%`, width: `max(2px, ${share(to) - share(from)}%)` }} />
        ))}
      </div>
    </Tooltip>
  );
}

function Moment({ head }: { head: Playhead }) {
  const time = useMoment(head, 0.001) ?? head.begin;
  return (
    <span className={classes.moment}>
      <NumberEntry
        size="xs"
        w={92}
        aria-label="Time"
        data-testid="playhead"
        unit="s"
        decimals={3}
        value={time}
        onNumber={(value) => {
          if (Math.abs(value - head.time) > 5e-4) head.seek(value);
        }}
        onEmpty={() => undefined}
      />
      <Text span size="xs" c="dimmed">
        / {formatNumber(Number(head.end.toFixed(3)))} s
      </Text>
    </span>
  );
}
