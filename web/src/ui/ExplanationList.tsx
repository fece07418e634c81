/** Why things happened in a run, in the order of time: each event with what there is to say about it. */

import type { Explanation } from "../model/run";
import { formatTime, words } from "../model/units";
import classes from "./EventList.module.css";

export function ExplanationList({ explanations }: { explanations: readonly Explanation[] }) {
  return (
    <ol className={classes.events} data-testid="explanations">
      {explanations.map(({ time, text, units, lines }, index) => (
        <li key={index}>
          <span className={classes.time}>{formatTime(time)} s</span>
          <details>
            <summary>
              <b>{units.map(words).join(" and ")}: </b>
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
