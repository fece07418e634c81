/** What the runs have used in another form than the first: the texts of applications and other kinds, line by line. */

import { Text } from "@mantine/core";
import type { SideBySide, SourceBeside } from "../../model/beside";
import classes from "./Compare.module.css";

export function Sources({ found: { sources, runs } }: { found: SideBySide }) {
  if (sources.length === 0) return null;
  return (
    <section className={classes.card} data-testid="compare-sources" aria-label="Source">
      <h2>
        Source{" "}
        <Text span size="xs" c="dimmed">
          of what was used, against #{runs[0]?.run}
        </Text>
      </h2>
      {sources.map((source) => (
        <Source key={`${source.run} ${source.kind} ${source.file}`} source={source} />
      ))}
    </section>
  );
}

function Source({ source: { kind, file, run, only, diff } }: { source: SourceBeside }) {
  const named = kind.replace(".", " ");
  if (only !== null)
    return (
      <Text size="sm">
        {only === run ? `#${run} alone uses the ${named}.` : `#${run} does not use the ${named}.`}
      </Text>
    );
  const lines = diff.split("\n");
  const count = (sign: string) => lines.filter((line) => line.startsWith(sign)).length;
  return (
    <details open={lines.length < LONG}>
      <summary>
        #{run}: {named}, {file}: {count("+")} lines more, {count("-")} fewer
      </summary>
      <pre className={classes.diff}>
        {lines.map((line, index) => (
          <span key={index} data-sign={line[0]}>
            {`${line}\n`}
          </span>
        ))}
      </pre>
    </details>
  );
}

/** A longer difference is opened when somebody wants it. */
const LONG = 60;
