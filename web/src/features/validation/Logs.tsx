/** The files of a project: sent, looked at with their signals drawn, mapped to ours, cut into maneuvers. */

import { ActionIcon, Alert, Button, FileButton, SegmentedControl, Text, Tooltip } from "@mantine/core";
import { useQuery } from "@tanstack/react-query";
import { useEffect, useState } from "react";
import { projectJob, useCancelJob, useDeleteFile, useJob, usePatch, usePutFile, validationKinds } from "../../api/validations";
import { formatBytes, formatFixed, formatNumber, unitText, words } from "../../model/units";
import { addRun, type Cut, type Looked, type Mapping, type Project, type ProjectJob, type RunSet, type Said } from "../../model/validation";
import { TimeChart } from "../../charts/TimeChart";
import { useZoom } from "../../charts/zoom";
import { DropAnywhere } from "../../ui/Drop";
import { Icon } from "../../ui/Icon";
import { notify, notifyError } from "../../ui/notify";
import { Empty, Failure, Loading } from "../../ui/State";
import { MappingForm } from "./MappingForm";
import { Progressing } from "./Progressing";
import classes from "./Validation.module.css";

interface Props {
  project: Project;
  said: Said | null;
  log: string | undefined;
  onLog: (log: string | undefined) => void;
}

export function Logs({ project, said, log, onLog }: Props) {
  const [round, setRound] = useState(0);
  const put = usePutFile(project.name);
  const endings = useQuery(validationKinds).data?.endings ?? [];
  const send = async (files: File[]) => {
    for (const file of files) {
      await put.mutateAsync({ name: file.name, content: file }).then(
        ({ name, kind }) => (kind === "log" ? onLog(name) : undefined),
        notifyError,
      );
    }
  };
  const logs = project.files.filter(({ kind }) => kind === "log");
  return (
    <div className={classes.split}>
      <section className={classes.card} aria-label="Files of the project">
        <h2>Files</h2>
        <FileButton multiple accept={endings.join(",")} onChange={(files) => void send(files)}>
          {(props) => (
            <Button {...props} size="xs" variant="default" loading={put.isPending} leftSection={<Icon name="upload" size={14} />}>
              Send logs …
            </Button>
          )}
        </FileButton>
        <Text size="xs" c="dimmed">
          {endings.join(" ")}; or drop them anywhere.
        </Text>
        <ul className={classes.files}>
          {project.files.map((file) => (
            <FileRow key={file.name} project={project} file={file} chosen={file.name === log} onLog={onLog} />
          ))}
        </ul>
      </section>
      {log !== undefined && logs.some(({ name }) => name === log) ? (
        <Look key={`${log} ${project.digest} ${round}`} project={project} said={said} log={log} onAgain={() => setRound((before) => before + 1)} />
      ) : (
        <Empty icon="chart" title={logs.length === 0 ? "No logs yet" : "No log is looked at"}>
          {logs.length === 0
            ? "Send the recorded drives of the real car: CSV, MDF, CAN traces with their DBC, or NumPy."
            : "Choose one on the left to see what was recorded."}
        </Empty>
      )}
      <DropAnywhere onFiles={(files) => void send(files)}>Drop the logs to take them into the project</DropAnywhere>
    </div>
  );
}

interface FileProps {
  project: Project;
  file: Project["files"][number];
  chosen: boolean;
  onLog: (log: string) => void;
}

function FileRow({ project, file: { name, kind, bytes }, chosen, onLog }: FileProps) {
  const remove = useDeleteFile(project.name);
  return (
    <li aria-current={chosen || undefined}>
      {kind === "log" ? (
        <Button size="compact-xs" variant={chosen ? "light" : "subtle"} onClick={() => onLog(name)}>
          {name}
        </Button>
      ) : (
        <Text size="xs" span pl={8}>
          {name}
        </Text>
      )}
      <Text size="xs" c="dimmed" span>
        {kind === "log" ? "" : `${kind}, `}
        {formatBytes(bytes)}
      </Text>
      {kind === "project" ? null : (
        <Tooltip label="Remove the file">
          <ActionIcon
            variant="subtle"
            color="gray"
            aria-label={`Remove ${name}`}
            onClick={() => remove.mutate(name, { onError: notifyError })}
          >
            <Icon name="trash" size={13} />
          </ActionIcon>
        </Tooltip>
      )}
    </li>
  );
}

interface LookProps {
  project: Project;
  said: Said | null;
  log: string;
  /** Look at it anew. */
  onAgain: () => void;
}

/** What is in a log: asked for when it is chosen, and again when the project has changed; nobody looks on when one has left. */
export function Look({ project, said, log, onAgain }: LookProps) {
  const { mutateAsync, data: begun, error } = useJob(project.name);
  const { mutate: cancel } = useCancelJob();
  useEffect(() => {
    const asked = mutateAsync({ task: "look", log });
    asked.catch(() => undefined); // it is shown below
    return () => void asked.then(({ id }) => cancel(id)).catch(() => undefined);
  }, [mutateAsync, cancel, log]);
  const { data: job, error: lost } = useQuery(projectJob(begun?.id));
  const refused = error ?? lost ?? (job?.problem ? refusalOf(job.problem) : null);
  if (refused) return <Failure error={refused} onRetry={onAgain} />;
  if (job?.status === "cancelled") {
    return (
      <Empty icon="chart" title="It was not looked at to the end" action={<Button size="xs" variant="default" onClick={onAgain}>Look again</Button>}>
        Reading {log} was cancelled.
      </Empty>
    );
  }
  if (job?.status === "running") return <Progressing job={job} />;
  return job?.looked ? <Seen project={project} said={said} log={log} found={job.looked} onAgain={onAgain} /> : <Loading what={log} />;
}

const refusalOf = ({ message, problems }: NonNullable<ProjectJob["problem"]>) => Object.assign(new Error(message), { problems });

function Seen({ project, said, log, found, onAgain }: LookProps & { found: Looked }) {
  const [mapping, setMapping] = useState(found.ours.length === 0);
  const refused = found.problem && refusalOf(found.problem);
  return (
    <div className={classes.stack}>
      {refused ? <Failure error={refused} /> : null}
      {found.hints.map((each) => (
        <Alert key={each} color="orange" variant="outline" icon={<Icon name="warning" />} py={6}>
          {each}
        </Alert>
      ))}
      {said && found.ours.length > 0 ? <Cuts project={project} said={said} log={log} cuts={found.cuts} /> : null}
      <section className={classes.card} aria-label="Signals">
        <h2>
          {found.ours.length > 0 ? "Our signals" : "Recorded signals"} <span className={classes.dim}>{log}</span>
        </h2>
        <SignalTable found={found.ours.length > 0 ? found.ours : found.recorded} />
        <Button size="compact-xs" variant="default" onClick={() => setMapping(!mapping)} aria-expanded={mapping}>
          {mapping ? "Hide the mapping" : "Which signal is which …"}
        </Button>
        {mapping ? <MappingForm project={project} said={said} recorded={found.recorded} mapping={found.mapping as unknown as Mapping | null} onSaved={onAgain} /> : null}
      </section>
      <Drawings found={found} />
    </div>
  );
}

function SignalTable({ found }: { found: Looked["recorded"] }) {
  const number = (value: number | null) => (value === null ? "–" : formatNumber(value));
  return (
    <div className={classes.scroll}>
      <table className={classes.table} data-testid="signals">
        <thead>
          <tr>
            <th scope="col">Signal</th>
            <th scope="col">Unit</th>
            <th scope="col">Samples</th>
            <th scope="col">Rate [1/s]</th>
            <th scope="col">From [s]</th>
            <th scope="col">To [s]</th>
            <th scope="col">Lowest</th>
            <th scope="col">Highest</th>
            <th scope="col">Gaps</th>
          </tr>
        </thead>
        <tbody>
          {found.map(({ name, unit, count, rate, since, until, low, high, gaps }) => (
            <tr key={name}>
              <th scope="row">{name}</th>
              <td>{unitText(unit) || "–"}</td>
              <td>{count}</td>
              <td>{number(rate)}</td>
              <td>{number(since)}</td>
              <td>{number(until)}</td>
              <td>{number(low)}</td>
              <td>{number(high)}</td>
              <td title={gaps.map((gap) => `${formatFixed(gap.since, 2)} to ${formatFixed(gap.until, 2)} s`).join(", ")}>
                {gaps.length || "–"}
              </td>
            </tr>
          ))}
        </tbody>
      </table>
    </div>
  );
}

interface CutsProps {
  project: Project;
  said: Said;
  log: string;
  cuts: readonly Cut[];
}

/** The maneuvers that were found, and what they are taken for. */
function Cuts({ project, said, log, cuts }: CutsProps) {
  const kinds = useQuery(validationKinds).data?.maneuvers ?? [];
  const patch = usePatch(project.name, project.digest);
  const [set, setSet] = useState<RunSet>("validation");
  const take = (kind: string, begin: number, end: number | null) =>
    patch.mutate(addRun(said, kind, set, { log, begin, end }), {
      onError: notifyError,
      onSuccess: () => notify("Taken", `${log} is a run for ${set} now.`),
    });
  return (
    <section className={classes.card} aria-label="Maneuvers in this log">
      <h2>Maneuvers in this log</h2>
      <SegmentedControl
        size="xs"
        aria-label="Taken for"
        value={set}
        onChange={(next) => setSet(next as RunSet)}
        data={[
          { value: "calibration", label: "Take for calibration" },
          { value: "validation", label: "Take for validation" },
        ]}
      />
      <ul className={classes.files}>
        {cuts.map(({ kind, begin, end }) => (
          <li key={`${kind} ${begin}`}>
            <Text size="sm" span>
              {kinds.find((each) => each.name === kind)?.title ?? kind}, {formatFixed(begin, 2)} to {formatFixed(end, 2)} s
            </Text>
            <Button size="compact-xs" variant="default" loading={patch.isPending} onClick={() => take(kind, begin, end)}>
              Take it
            </Button>
          </li>
        ))}
        <li>
          <Text size="sm" span>
            The whole log as any steered drive
          </Text>
          <Button size="compact-xs" variant="default" loading={patch.isPending} onClick={() => take("steered", 0, null)}>
            Take it
          </Button>
        </li>
      </ul>
      {cuts.length === 0 ? (
        <Text size="xs" c="dimmed">
          No maneuver of the method was found in it.
        </Text>
      ) : null}
    </section>
  );
}

/** So many signals are drawn at first. */
const DRAWN = 6;

function Drawings({ found }: { found: Looked }) {
  const zoom = useZoom(found.log);
  const [all, setAll] = useState(false);
  const shown = all ? found.drawn : found.drawn.slice(0, DRAWN);
  return (
    <section className={classes.charts} aria-label="Signals over time">
      {shown.map(({ name, unit, time, values }) => (
        <div key={name} className={classes.chart}>
          <TimeChart
            title={words(name)}
            unit={unit}
            lines={[{ key: name, label: words(name), color: "var(--mantine-primary-color-filled)" }]}
            data={[time, values]}
            sync={`log ${found.log}`}
            zoom={zoom}
            height={120}
          />
        </div>
      ))}
      {found.drawn.length > DRAWN ? (
        <Button size="compact-xs" variant="default" onClick={() => setAll(!all)}>
          {all ? "Draw fewer" : `Draw all ${found.drawn.length} signals`}
        </Button>
      ) : null}
    </section>
  );
}
