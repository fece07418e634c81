/** What happened in a run, in the order of time. */

import type { RunEvent } from "../model/run";
import { formatTime, words } from "../model/units";
import classes from "./EventList.module.css";

export function EventList({ events }: { events: readonly RunEvent[] }) {
  return (
    <ol className={classes.events} data-testid="events">
      {events.map(({ time, text, vehicle }, index) => (
        <li key={index}>
          <span className={classes.time}>{formatTime(time)} s</span>
          <span>
            {vehicle ? <b>{words(vehicle)}: </b> : null}
            {text}
          </span>
        </li>
      ))}
    </ol>
  );
}
