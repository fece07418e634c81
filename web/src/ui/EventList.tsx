/** What happened in a run, in the order of time. */

import type { RunEvent } from "../model/run";
import { formatTime, words } from "../model/units";
import classes from "./EventList.module.css";

interface Props {
  events: readonly RunEvent[];
  /** The time of the playback [s]: what happened last until then is marked. */
  now?: number | undefined;
  /** Go to the time of an event [s]. */
  onSeek?: ((time: number) => void) | undefined;
}

export function EventList({ events, now, onSeek }: Props) {
  const last = now === undefined ? -1 : events.filter(({ time }) => time <= now + SAME).length - 1;
  return (
    <ol className={classes.events} data-testid="events">
      {events.map(({ time, text, vehicle }, index) => (
        <li key={index} aria-current={index === last ? "time" : undefined}>
          {onSeek ? (
            <button type="button" className={classes.time} onClick={() => onSeek(time)} title="Go there">
              {formatTime(time)} s
            </button>
          ) : (
            <span className={classes.time}>{formatTime(time)} s</span>
          )}
          <span>
            {vehicle ? <b>{words(vehicle)}: </b> : null}
            {text}
          </span>
        </li>
      ))}
    </ol>
  );
}

/** [s] The time of the playback is told in such steps. */
const SAME = 0.05;
