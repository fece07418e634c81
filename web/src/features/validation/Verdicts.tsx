/** What a validation found: the span, every criterion, and the recorded zones with the simulations in them. */

import { Alert, Anchor, Button, Group, Modal, Text, Textarea } from "@mantine/core";
import { useQuery } from "@tanstack/react-query";
import { useState } from "react";
import { courses, iteration, paperOf, reportOf, usePatch, vehicleOf } from "../../api/validations";
import { formatNumber, words } from "../../model/units";
import { interval, measured, override, overrideOf, type Project, type Said, takeBackOverride } from "../../model/validation";
import { notify, notifyError } from "../../ui/notify";
import { Empty, Failure, Loading } from "../../ui/State";
import classes from "./Validation.module.css";
import { Valid } from "./ValidationsPage";
import { ZoneChart } from "./ZoneChart";

interface Verdict {
  maneuver: string;
  criterion: string;
  ours: number | null;
  theirs: number | null;
  low: number | null;
  high: number | null;
  error: number | null;
  limit: number | null;
  verdict: "pass" | "fail" | "overridden" | "unjudged";
  reason: string;
  unit?: string;
  error_unit?: string;
}

type Spanned = Record<string, [number, number]>;

interface Result {
  verdicts: Verdict[];
  span: { whole: Spanned | null; maneuvers: Record<string, Spanned> };
  interval: string;
  valid: boolean;
  /** These three are not there in what an older studio judged. */
  doubtful?: number;
  hints?: string[];
  unjudged?: Record<string, string[]>;
}

interface Props {
  project: Project;
  said: Said;
  at: number | undefined;
  onAt: (at: number) => void;
}

export function Verdicts({ project, said, at }: Props) {
  const validations = project.iterations.filter(({ valid }) => valid !== null);
  const shown = validations.find((each) => each.iteration === at) ?? validations[0];
  const { data, error } = useQuery(iteration(shown?.iteration));
  if (!shown) {
    return (
      <Empty icon="check" title="Not validated yet">
        Validate drives the car with the recorded inputs of every run for validation, and judges it by the criteria of its maneuvers.
      </Empty>
    );
  }
  if (error) return <Failure error={error} />;
  if (!data) return <Loading what="the verdicts" />;
  const result = data.result as unknown as Result;
  return (
    <div className={classes.stack}>
      <section className={classes.card} aria-label="Verdict">
        <h2>
          Iteration {shown.iteration} <Valid valid={result.valid} />
        </h2>
        <Text size="sm">
          {shown.told}; {result.interval}.{" "}
          {data.parent === null ? "The car is as the project names it." : `With the values of iteration ${data.parent}.`}
        </Text>
        <Span span={result.span.whole} />
        <Doubts result={result} />
        {shown.has_report ? (
          <Group gap="lg">
            <Anchor size="sm" href={reportOf(project.name, shown.iteration)} target="_blank" rel="noreferrer">
              Open the report, to be read and printed
            </Anchor>
            <Anchor size="sm" href={paperOf(project.name, shown.iteration)} download>
              Download the report as PDF
            </Anchor>
            {result.span.whole ? (
              <Anchor size="sm" href={vehicleOf(project.name, shown.iteration)} download>
                Download the vehicle with its span
              </Anchor>
            ) : null}
          </Group>
        ) : null}
        <VerdictTable project={project} said={said} verdicts={result.verdicts} />
        {Object.entries(result.unjudged ?? {}).map(([maneuver, left]) => (
          <Text key={maneuver} size="sm" c="dimmed">
            Not judged in {maneuver}: {left.join("; ")}.
          </Text>
        ))}
      </section>
      {shown.has_report ? <Zones project={project.name} number={shown.iteration} /> : null}
    </div>
  );
}

const UNITS: Readonly<Record<string, string>> = { speed: "m/s", yaw_rate: "rad/s" };

function Span({ span }: { span: Spanned | null }) {
  if (!span) return <Text size="sm">Nothing is validated: no maneuver met all of its criteria.</Text>;
  const parts = Object.entries(span).map(([name, [low, high]]) =>
    low === high
      ? `${words(name).toLowerCase()} not covered by any run`
      : `${words(name).toLowerCase()} ${formatNumber(low)} to ${formatNumber(high)} ${UNITS[name] ?? "m/s²"}`,
  );
  return <Text size="sm">Validated span: {parts.join("; ")}.</Text>;
}

/** What a person should look at, though no verdict changes by it. */
function Doubts({ result: { doubtful = 0, hints = [] } }: { result: Result }) {
  const wide = `Of the criteria that are met, ${doubtful} by nothing but an interval that is wider than the limit: they prove little.`;
  const found = [...hints, ...(doubtful > 0 ? [wide] : [])];
  if (found.length === 0) return null;
  return (
    <Alert color="yellow" title="Look at these" role="note">
      {found.map((each) => (
        <Text key={each} size="sm">
          {each}
        </Text>
      ))}
    </Alert>
  );
}

function VerdictTable({ project, said, verdicts }: { project: Project; said: Said; verdicts: readonly Verdict[] }) {
  const [judging, setJudging] = useState<Verdict>();
  return (
    <div className={classes.scroll}>
      <table className={classes.table} data-testid="verdicts">
        <thead>
          <tr>
            <th scope="col">Maneuver</th>
            <th scope="col">Criterion</th>
            <th scope="col">Ours</th>
            <th scope="col">Theirs</th>
            <th scope="col">Interval</th>
            <th scope="col">Error</th>
            <th scope="col">Limit</th>
            <th scope="col">Verdict</th>
          </tr>
        </thead>
        <tbody>
          {verdicts.map((each) => (
            <tr key={`${each.maneuver} ${each.criterion}`} data-verdict={each.verdict}>
              <td>{each.maneuver}</td>
              <th scope="row">{each.criterion}</th>
              <td>{measured(each.ours, each.unit)}</td>
              <td>{measured(each.theirs, each.unit)}</td>
              <td>{interval(each.low, each.high, each.unit)}</td>
              <td>{measured(each.error, each.error_unit)}</td>
              <td>{measured(each.limit, each.error_unit)}</td>
              <td>
                <b className={classes[each.verdict]}>{each.verdict}</b>
                {each.reason ? (
                  <Text size="xs" c="dimmed">
                    {each.reason}
                  </Text>
                ) : null}
                <Otherwise project={project} said={said} verdict={each} onJudge={() => setJudging(each)} />
              </td>
            </tr>
          ))}
        </tbody>
      </table>
      {judging ? <Judge project={project} said={said} verdict={judging} onClose={() => setJudging(undefined)} /> : null}
    </div>
  );
}

/** What a person has judged otherwise, which counts from the next validation on and can be taken back; or the way to do so. */
function Otherwise({ project, said, verdict, onJudge }: Omit<JudgeProps, "onClose"> & { onJudge: () => void }) {
  const patch = usePatch(project.name, project.digest);
  const given = overrideOf(said, verdict.maneuver, verdict.criterion);
  if (given < 0)
    return verdict.verdict === "fail" ? (
      <Button size="compact-xs" variant="subtle" onClick={onJudge}>
        Judge otherwise …
      </Button>
    ) : null;
  return (
    <Text size="xs" component="div" data-testid="judged">
      {verdict.verdict === "fail" ? `Judged otherwise, for the next validation: ${said.overrides[given]?.reason}` : null}
      <Button
        size="compact-xs"
        variant="subtle"
        loading={patch.isPending}
        onClick={() => patch.mutate(takeBackOverride(said, given), { onError: notifyError, onSuccess: () => notify("Taken back", "The next validation judges by the criterion.") })}
      >
        Take it back
      </Button>
    </Text>
  );
}

/** The shortest reason that the project takes, in characters. */
const SHORTEST = 10;

interface JudgeProps {
  project: Project;
  said: Said;
  verdict: Verdict;
  onClose: () => void;
}

/** A person judges a criterion otherwise, with a reason; the next validation shows it beside what failed. */
function Judge({ project, said, verdict, onClose }: JudgeProps) {
  const patch = usePatch(project.name, project.digest);
  const [reason, setReason] = useState("");
  const judge = () =>
    patch.mutate(override(said, verdict.maneuver, verdict.criterion, reason.trim()), {
      onError: notifyError,
      onSuccess: () => {
        onClose();
        notify("Judged otherwise", "The next validation counts it, and shows the reason beside what failed.");
      },
    });
  return (
    <Modal opened onClose={onClose} title="Judge otherwise" size="md">
      <Text size="sm">
        {verdict.maneuver}: {verdict.criterion}
      </Text>
      <Textarea
        mt="sm"
        label="Why it counts as valid all the same"
        data-autofocus
        autosize
        minRows={3}
        value={reason}
        onChange={(event) => setReason(event.currentTarget.value)}
        description={`At least ${SHORTEST} characters; it stands in every report.`}
      />
      <Group justify="flex-end" gap="xs" mt="md">
        <Button size="xs" variant="default" onClick={onClose}>
          Cancel
        </Button>
        <Button size="xs" disabled={reason.trim().length < SHORTEST} loading={patch.isPending} onClick={judge}>
          Keep it
        </Button>
      </Group>
    </Modal>
  );
}

function Zones({ project, number: at }: { project: string; number: number }) {
  const { data, error } = useQuery(courses(project, at));
  if (error) return <Failure error={error} />;
  if (!data) return <Loading what="the zones" />;
  return (
    <section className={classes.charts} aria-label="Zones">
      {data.courses.map((course) => (
        <ZoneChart key={`${course.maneuver} ${course.signal} ${course.runs.join()}`} course={course} interval={data.interval} />
      ))}
    </section>
  );
}
