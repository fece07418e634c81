/** The maneuvers of a project with their runs, apart for calibration and validation; times can be corrected here. */

import { ActionIcon, Button, Text, Tooltip } from "@mantine/core";
import { useQuery } from "@tanstack/react-query";
import { usePatch, validationKinds } from "../../api/validations";
import { words } from "../../model/units";
import { cutRun, type Project, type Run, type RunSet, removeRun, type Said, SETS } from "../../model/validation";
import { Icon } from "../../ui/Icon";
import { NumberEntry } from "../../ui/NumberEntry";
import { notifyError } from "../../ui/notify";
import { Empty } from "../../ui/State";
import classes from "./Validation.module.css";

interface Props {
  project: Project;
  said: Said;
  onLog: (log: string) => void;
}

export function Maneuvers({ project, said, onLog }: Props) {
  const kinds = useQuery(validationKinds).data?.maneuvers ?? [];
  const patch = usePatch(project.name, project.digest);
  const change = (operations: Parameters<typeof patch.mutate>[0]) => patch.mutate(operations, { onError: notifyError });
  const names = Object.keys(said.maneuvers);
  if (names.length === 0) {
    return (
      <Empty icon="table" title="No maneuvers yet">
        Send logs under Logs, say there which signal is which, and take the maneuvers that are found in them.
      </Empty>
    );
  }
  return (
    <div className={classes.stack}>
      {names.map((name) => {
        const trial = said.maneuvers[name];
        const kind = kinds.find((each) => each.name === trial?.kind);
        if (!trial) return null;
        return (
          <section key={name} className={classes.card} aria-label={`Maneuver ${name}`}>
            <h2>
              {name} <span className={classes.dim}>{kind?.title ?? trial.kind}</span>
            </h2>
            {kind ? (
              <Text size="xs" c="dimmed">
                Fed with {kind.fed.map((each) => each.split("|").map(words).join(" or ")).join(", ")}; judged by{" "}
                {kind.judged.map(words).join(", ")}.
              </Text>
            ) : null}
            <table className={classes.table}>
              <thead>
                <tr>
                  <th scope="col">For</th>
                  <th scope="col">Log</th>
                  <th scope="col">Begin</th>
                  <th scope="col">End</th>
                  <th scope="col" aria-label="Actions" />
                </tr>
              </thead>
              <tbody>
                {SETS.flatMap((set) =>
                  trial[set].map((run, place) => (
                    <RunRow
                      key={`${set} ${place} ${run.log} ${run.begin} ${run.end}`}
                      set={set}
                      run={run}
                      onLog={() => onLog(run.log)}
                      onRun={(next) => change(cutRun(name, set, place, next))}
                      onRemove={() => change(removeRun(said, name, set, place))}
                    />
                  )),
                )}
              </tbody>
            </table>
          </section>
        );
      })}
    </div>
  );
}

interface RowProps {
  set: RunSet;
  run: Run;
  onLog: () => void;
  onRun: (run: Run) => void;
  onRemove: () => void;
}

function RunRow({ set, run, onLog, onRun, onRemove }: RowProps) {
  const what = `of ${run.log} for ${set}`;
  return (
    <tr>
      <td>{set}</td>
      <td>
        <Button size="compact-xs" variant="subtle" onClick={onLog}>
          {run.log}
        </Button>
      </td>
      <td>
        <NumberEntry
          size="xs"
          w={110}
          unit="s"
          aria-label={`Begin ${what}`}
          value={run.begin}
          onNumber={(begin) => begin !== run.begin && onRun({ ...run, begin })}
          onEmpty={() => onRun({ ...run, begin: 0 })}
        />
      </td>
      <td>
        <NumberEntry
          size="xs"
          w={110}
          unit="s"
          placeholder="end of log"
          aria-label={`End ${what}`}
          value={run.end ?? ""}
          onNumber={(end) => end !== run.end && onRun({ ...run, end })}
          onEmpty={() => onRun({ ...run, end: null })}
        />
      </td>
      <td>
        <Tooltip label="Take this run out">
          <ActionIcon variant="subtle" color="gray" aria-label={`Take out the run ${what}`} onClick={onRemove}>
            <Icon name="trash" size={14} />
          </ActionIcon>
        </Tooltip>
      </td>
    </tr>
  );
}
