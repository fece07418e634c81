/** One validation project: its logs, what is done with them, and what came out. */

import { Button, Tabs, Text, Title } from "@mantine/core";
import { useQuery } from "@tanstack/react-query";
import { Link } from "@tanstack/react-router";
import { lazy, Suspense, useEffect, useRef, useState } from "react";
import { projectJobs, useJob, useRefreshed, validation } from "../../api/validations";
import { goesOn, type Project, type ProjectJob, type Said } from "../../model/validation";
import { Icon } from "../../ui/Icon";
import { notifyError } from "../../ui/notify";
import { ProblemList } from "../../ui/Problems";
import { Failure, Loading } from "../../ui/State";
import { Calibrations } from "./Calibrations";
import { Iterations } from "./Iterations";
import { Logs } from "./Logs";
import { Maneuvers } from "./Maneuvers";
import { Progressing } from "./Progressing";
import classes from "./Validation.module.css";
import { Verdicts } from "./Verdicts";

const ProjectText = lazy(async () => ({ default: (await import("./ProjectText")).ProjectText }));

export const TABS = ["logs", "maneuvers", "calibration", "verdicts", "text"] as const;
export type Tab = (typeof TABS)[number];
const LABELS: Record<Tab, string> = {
  logs: "Logs",
  maneuvers: "Maneuvers",
  calibration: "Calibration",
  verdicts: "Verdicts",
  text: "Text",
};

/** What the address says: the tab, the log that is looked at, the iteration. */
export interface ProjectView {
  tab?: Tab | undefined;
  log?: string | undefined;
  at?: number | undefined;
}

interface Props {
  name: string;
  view: ProjectView;
  onView: (view: ProjectView) => void;
}

export function ProjectPage({ name, view, onView }: Props) {
  const { data, error, refetch } = useQuery(validation(name));
  if (error && !data) return <Failure error={error} onRetry={() => void refetch()} />;
  if (!data) return <Loading what="the project" />;
  return <Desk project={data} view={view} onView={onView} />;
}

function Desk({ project, view, onView }: { project: Project; view: ProjectView; onView: (view: ProjectView) => void }) {
  const tab = view.tab ?? (project.document && hasRuns(project) ? "maneuvers" : "logs");
  const said = project.document as unknown as Said | null;
  // Once it is open the text stays, for what is written there is not saved yet.
  const [opened, setOpened] = useState(false);
  const writing = opened || tab === "text";
  useEffect(() => setOpened(writing), [writing]);
  const work = useWork(project.name, (job) => {
    const made = job.kept?.iterations.at(-1);
    if (made !== undefined) onView({ tab: job.task === "validate" ? "verdicts" : "calibration", at: made });
  });
  return (
    <article className={classes.page} data-narrow="">
      <header className={classes.head}>
        <Link to="/validate" className={classes.back}>
          <Icon name="left" size={14} /> Validation
        </Link>
        <Title order={1} fz="lg">
          {said?.title ?? project.name}
        </Title>
        <Text size="sm" c="dimmed">
          {said?.vehicle}
        </Text>
        <div className={classes.tools}>
          <Button size="xs" variant="default" disabled={work.busy} onClick={() => work.start({ task: "calibrate" })}>
            Calibrate
          </Button>
          <Button size="xs" disabled={work.busy} onClick={() => work.start({ task: "validate" })}>
            Validate
          </Button>
        </div>
      </header>
      {work.job ? <Progressing job={work.job} onDismiss={work.dismiss} /> : null}
      {project.problems.length > 0 ? (
        <section className={classes.card} aria-label="Problems of the project">
          <ProblemList problems={project.problems} />
        </section>
      ) : null}
      <Tabs value={tab} onChange={(next) => onView({ ...view, tab: (next as Tab) ?? undefined })} keepMounted={false} keepMountedMode="display-none">
        <Tabs.List aria-label="Parts of the project">
          {TABS.map((each) => (
            <Tabs.Tab key={each} value={each}>
              {LABELS[each]}
            </Tabs.Tab>
          ))}
        </Tabs.List>
        <Tabs.Panel value="logs" pt="sm">
          <Logs project={project} said={said} log={view.log} onLog={(log) => onView({ ...view, tab: "logs", log })} />
        </Tabs.Panel>
        <Tabs.Panel value="maneuvers" pt="sm">
          {said ? <Maneuvers project={project} said={said} onLog={(log) => onView({ tab: "logs", log })} /> : <Unreadable />}
        </Tabs.Panel>
        <Tabs.Panel value="calibration" pt="sm">
          {said ? (
            <Calibrations
              project={project}
              said={said}
              at={view.at}
              busy={work.busy}
              onAt={(at) => onView({ tab: "calibration", at })}
              onStart={(step) => work.start({ task: "calibrate", step })}
            />
          ) : (
            <Unreadable />
          )}
        </Tabs.Panel>
        <Tabs.Panel value="verdicts" pt="sm">
          {said ? (
            <Verdicts project={project} said={said} at={view.at} onAt={(at) => onView({ tab: "verdicts", at })} />
          ) : (
            <Unreadable />
          )}
        </Tabs.Panel>
        <Tabs.Panel value="text" pt="sm" keepMounted>
          {writing ? (
            <Suspense fallback={<Loading what="the text" />}>
              <ProjectText project={project} />
            </Suspense>
          ) : null}
        </Tabs.Panel>
      </Tabs>
      <Iterations
        project={project}
        at={view.at}
        onAt={(at, isCalibration) => onView({ tab: isCalibration ? "calibration" : "verdicts", at })}
      />
    </article>
  );
}

const Unreadable = () => <Text size="sm">The project cannot be read. Mend its text first.</Text>;

const hasRuns = ({ document }: Project): boolean =>
  Object.keys((document as unknown as Said | null)?.maneuvers ?? {}).length > 0;

/** The job of this project that goes on, or the one that has failed; `onDone` hears of one that was begun here. */
function useWork(project: string, onDone: (job: ProjectJob) => void) {
  const { data: jobs } = useQuery(projectJobs);
  const start = useJob(project);
  const refreshed = useRefreshed(project);
  const mine = jobs?.filter((each) => each.project === project && each.task !== "look") ?? [];
  const going = mine.find(goesOn);
  const [dismissed, setDismissed] = useState<number>();
  const [begun, setBegun] = useState<number>();
  const last = mine[0];
  const heard = useRef<number>(undefined);
  useEffect(() => {
    if (!last || goesOn(last) || last.id !== begun || heard.current === begun) return;
    heard.current = begun;
    void refreshed().then(() => onDone(last));
  });
  return {
    busy: going !== undefined || start.isPending,
    job: going ?? (last?.status === "failed" && last.id !== dismissed && last.id === begun ? last : undefined),
    dismiss: () => setDismissed(last?.id),
    start: (what: Parameters<typeof start.mutate>[0]) =>
      start.mutate(what, { onSuccess: ({ id }) => setBegun(id), onError: notifyError }),
  };
}
