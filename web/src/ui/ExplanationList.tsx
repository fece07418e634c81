/** Why things happened in a run, in the order of time: each event with what there is to say about it. */

import type { Explanation } from "../model/run";
import { formatTime, words } from "../model/units";
import classes from "./EventList.module.css";

interface Props {
  explanations: readonly Explanation[];
  /** Go to the time of an event [s]. */
  onSeek?: (time: number) => void;
}

export function ExplanationList({ explanations, onSeek }: Props) {
  return (
    <ol className={classes.events} data-testid="explanations">
      {explanations.map(({ time, text, units, lines }, index) => (
        <li key={index}>
          {onSeek ? (
            <button type="button" className={classes.time} onClick={() => onSeek(time)} title="Go there">
              {formatTime(time)} s
            </button>
          ) : (
            <span className={classes.time}>{formatTime(time)} s</span>
          )}
          <details>
            <summary>
              {units[0] ? <b>{words(units[0])}: </b> : null}
              {text}
            </summary>
            <ul>
              {lines.map((line, place) => (
                <li key={place}>{line.replaceAll("_", " ")}</li>
              ))}
            </ul>
          </details>
        </li>
      ))}
    </ol>
  );
}
