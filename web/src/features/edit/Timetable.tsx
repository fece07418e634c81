/** What happens when, as far as it is known before the run; and what can never happen, with the reason. */

import { Text, UnstyledButton } from "@mantine/core";
import type { Turn } from "../../model/editing/item";
import { Icon } from "../../ui/Icon";
import classes from "./Edit.module.css";

interface Props {
  turns: readonly Turn[];
  duration: number;
  chosen: readonly string[];
  onChoose: (path: string) => void;
}

export function Timetable({ turns, duration, chosen, onChoose }: Props) {
  if (turns.length === 0)
    return (
      <Text size="sm" c="dimmed" p="xs">
        Nothing happens by itself yet. Add an event, somebody on foot, or an object: it stands here with its time.
      </Text>
    );
  return (
    <div className={classes.timetable} role="list" aria-label="What happens when">
      {turns.map((turn) => (
        <div key={turn.entry} role="listitem" className={classes.turn} data-chosen={chosen.includes(`script.${turn.entry}`) || undefined}>
          <UnstyledButton className={classes.turnName} onClick={() => onChoose(`script.${turn.entry}`)} title={`${turn.why} → ${turn.told}`}>
            {turn.entry}
          </UnstyledButton>
          <Track turn={turn} duration={duration} />
        </div>
      ))}
      <div className={classes.axis} aria-hidden="true">
        <span>0 s</span>
        <span>{duration} s</span>
      </div>
    </div>
  );
}

function Track({ turn: { begins, ends, is_exact, never, why }, duration }: { turn: Turn; duration: number }) {
  if (never)
    return (
      <span className={classes.never} role="note">
        <Icon name="warning" size={13} /> never: {never}
      </span>
    );
  if (begins === null) return <span className={classes.depends}>depends on what happens: {why}</span>;
  const [from, to] = [Math.min(1, begins / duration), Math.min(1, (ends ?? duration) / duration)];
  const text = is_exact ? `at ${begins.toFixed(begins % 1 === 0 ? 0 : 1)} s` : `at ${begins.toFixed(0)} s at the earliest`;
  return (
    <span className={classes.track}>
      <span
        className={classes.span}
        data-guess={!is_exact || undefined}
        data-open={ends === null || undefined}
        title={ends === null ? "When it ends depends on what happens" : `until ${ends.toFixed(1)} s at the latest`}
        style={{ left: `${from * 100}%`, width: `max(5px, ${Math.max(0, to - from) * 100}%)` }}
      />
      <span className={classes.when} style={from > 0.6 ? { right: `${(1 - from) * 100 + 1}%` } : { left: `calc(${from * 100}% + 6px)` }}>
        {text}
      </span>
    </span>
  );
}
