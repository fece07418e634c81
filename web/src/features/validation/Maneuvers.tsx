/** The maneuvers of a project with their runs, apart for calibration and validation; times can be corrected here. */

import { ActionIcon, Button, Text, Tooltip, VisuallyHidden } from "@mantine/core";
import { useQuery } from "@tanstack/react-query";
import { useEffect, useRef, useState } from "react";
import { Refusal } from "../../api/client";
import { usePatch, validationKinds } from "../../api/validations";
import { words } from "../../model/units";
import { cutRun, type Project, type Run, type RunSet, removeRun, type Said, SETS } from "../../model/validation";
import { Icon } from "../../ui/Icon";
import { NumberEntry } from "../../ui/NumberEntry";
import { notifyError } from "../../ui/notify";
import { ProblemList } from "../../ui/Problems";
import { useUndoKeys } from "../../ui/shortcut";
import { Empty } from "../../ui/State";
import classes from "./Validation.module.css";

/** A change as the server answers it: the digest after it, and what undoes it. */
type Done = Awaited<ReturnType<ReturnType<typeof usePatch>["mutateAsync"]>>;

/** Changes that can be taken back. */
const MOST_KEPT = 100;

/** Changes of this page, the latest last: what undoes each, and what makes each that was undone again. */
interface Steps {
  done: readonly Done[];
  undone: readonly Done[];
  /** How many changes are on their way to the server. */
  sent: number;
  /** What is to be turned round as soon as nothing is on its way: the field that one leaves by pressing the button is sent first. */
  wish?: "done" | "undone" | undefined;
}

const NOTHING: Steps = { done: [], undone: [], sent: 0 };

/** The latest of one list went to the other: the answer to its inverse is what turns it round once more. */
const moved = (steps: Steps, from: "done" | "undone", made: Done): Steps => ({
  done: from === "done" ? steps.done.slice(0, -1) : [...steps.done, made],
  undone: from === "undone" ? steps.undone.slice(0, -1) : [...steps.undone, made],
  sent: steps.sent - 1,
});

interface Props {
  project: Project;
  said: Said;
  onLog: (log: string) => void;
}

export function Maneuvers({ project, said, onLog }: Props) {
  const kinds = useQuery(validationKinds).data?.maneuvers ?? [];
  const patch = usePatch(project.name, project.digest);
  const [{ done, undone, sent, wish }, setSteps] = useState(NOTHING);
  const send = (operations: Parameters<typeof patch.mutate>[0], then: (before: Steps, made: Done) => Steps) => {
    setSteps((before) => ({ ...before, sent: before.sent + 1, wish: undefined }));
    return patch.mutateAsync(operations).then(
      (made) => setSteps((before) => then(before, made)),
      (error: Error) => {
        setSteps((before) => ({ ...before, sent: before.sent - 1, wish: undefined }));
        throw error;
      },
    );
  };
  const change = (operations: Parameters<typeof patch.mutate>[0]) =>
    send(operations, (before, made) => ({
      ...before,
      done: [...before.done, made].slice(-MOST_KEPT),
      undone: [],
      sent: before.sent - 1,
    }));
  // What was changed elsewhere since then is neither undone nor made again by what was meant for the text before.
  const [last, next] = [done, undone].map((each) => (each.at(-1)?.digest === project.digest ? each.at(-1) : undefined));
  const turned = wish === "done" ? last : wish === "undone" ? next : undefined;
  useEffect(() => {
    if (wish && turned && sent === 0) void send(turned.inverse, (before, made) => moved(before, wish, made)).catch(notifyError);
  });
  const want = (which: "done" | "undone", is: Done | undefined) =>
    setSteps((before) => ({ ...before, wish: before.sent > 0 || is ? which : undefined }));
  const takeBack = () => want("done", last);
  const makeAgain = () => want("undone", next);
  useUndoKeys(takeBack, makeAgain);
  const back =
    last || next || sent ? (
      <div className={classes.row}>
        <Tooltip label="Ctrl+Z">
          <Button size="xs" variant="default" disabled={!last && sent === 0} onClick={takeBack}>
            Take back the last change
          </Button>
        </Tooltip>
        <Tooltip label="Ctrl+Y">
          <Button size="xs" variant="default" disabled={!next && sent === 0} onClick={makeAgain}>
            Make it again
          </Button>
        </Tooltip>
      </div>
    ) : null;
  const names = Object.keys(said.maneuvers);
  if (names.length === 0) {
    return (
      <Empty icon="table" title="No maneuvers yet" action={back}>
        Send logs under Logs, say there which signal is which, and take the maneuvers that are found in them.
      </Empty>
    );
  }
  return (
    <div className={classes.stack}>
      {back}
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
            <div className={classes.scroll}>
            <table className={classes.table}>
              <thead>
                <tr>
                  <th scope="col">For</th>
                  <th scope="col">Log</th>
                  <th scope="col">Begin</th>
                  <th scope="col">End</th>
                  <th scope="col">
                    <VisuallyHidden>Actions</VisuallyHidden>
                  </th>
                </tr>
              </thead>
              <tbody>
                {SETS.flatMap((set) =>
                  trial[set].map((run, place) => (
                    <RunRow
                      key={`${set} ${place} ${run.log}`}
                      set={set}
                      run={run}
                      onLog={() => onLog(run.log)}
                      onRun={(next) => change(cutRun(name, set, place, next))}
                      onRemove={() => void change(removeRun(said, name, set, place)).catch(notifyError)}
                    />
                  )),
                )}
              </tbody>
            </table>
            </div>
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
  /** Is over when the project has changed; fails with the refusal. */
  onRun: (run: Run) => Promise<unknown>;
  onRemove: () => void;
}

type Times = Partial<Pick<Run, "begin" | "end">>;

/** Times are kept here while one types, and sent when one leaves the row, or by Enter. */
export function RunRow({ set: taken, run, onLog, onRun, onRemove }: RowProps) {
  const what = `of ${run.log} for ${taken}`;
  const [times, setTimes] = useState<Times>({});
  // Leaving a field may still change it: what counts is what was typed last, not what was drawn last.
  const typed = useRef(times);
  const sent = useRef<Times>(undefined);
  const [refused, setRefused] = useState<Error>();
  const set = (next: Times) => {
    setRefused(undefined);
    setTimes((typed.current = next));
  };
  const { begin, end } = { ...run, ...times };
  const isTyped = (begin !== run.begin || end !== run.end) && !refused;
  const send = () => {
    const now = typed.current;
    const next = { ...run, ...now };
    if (now === sent.current || (next.begin === run.begin && next.end === run.end)) return;
    sent.current = now;
    // What was refused stays as it was typed, with the reason beside it.
    onRun(next).then(
      () => typed.current === now && set({}),
      (error: Error) => typed.current === now && setRefused(error),
    );
  };
  return (
    <tr
      onBlur={(event) => event.currentTarget.contains(event.relatedTarget) || send()}
      onKeyDown={(event) => event.key === "Enter" && event.target instanceof HTMLInputElement && send()}
    >
      <td>{taken}</td>
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
          value={begin}
          onNumber={(next) => set({ ...typed.current, begin: next })}
          onEmpty={() => set({ ...typed.current, begin: 0 })}
        />
      </td>
      <td>
        <NumberEntry
          size="xs"
          w={110}
          unit="s"
          placeholder="end of log"
          aria-label={`End ${what}`}
          value={end ?? ""}
          onNumber={(next) => set({ ...typed.current, end: next })}
          onEmpty={() => set({ ...typed.current, end: null })}
        />
        {isTyped ? (
          <Text size="xs" c="dimmed">
            Not saved yet: press Enter, or leave the row.
          </Text>
        ) : null}
        {refused ? (
          <div role="alert">
            <Text size="xs" c="red">
              {refused.message} Not saved.
            </Text>
            <ProblemList problems={refused instanceof Refusal ? refused.problems : []} />
          </div>
        ) : null}
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
