/** A job on its way: what is being done, how far it is, and the way to end it; or why it came to nothing. */

import { Button, Progress, Text } from "@mantine/core";
import { useCancelJob } from "../../api/validations";
import type { ProjectJob } from "../../model/validation";
import { formatDuration } from "../../model/units";
import { notify, notifyError } from "../../ui/notify";
import { Failure } from "../../ui/State";
import classes from "./Validation.module.css";

export function Progressing({ job, onDismiss }: { job: ProjectJob; onDismiss?: () => void }) {
  const cancel = useCancelJob();
  // Told by the promise: this part of the page is gone once the job is.
  const end = () =>
    cancel
      .mutateAsync(job.id)
      .then(({ status }) => status === "cancelled" && notify("Cancelled", "Of the step that went on nothing was kept.", "gray"))
      .catch(notifyError);
  if (job.status === "failed" && job.problem) {
    const error = Object.assign(new Error(job.problem.message), { problems: job.problem.problems });
    return <Failure error={error} {...(onDismiss ? { onDismiss } : {})} />;
  }
  if (job.status !== "running") return null;
  return (
    <div className={classes.job} role="status" data-testid="validation-job">
      <Text size="sm">
        {job.stage} … {formatDuration(job.seconds)}
      </Text>
      <Progress
        flex={1}
        size="sm"
        animated={job.share === null}
        value={100 * (job.share ?? 1)}
        aria-label={`How far: ${job.stage}`}
      />
      <Button size="compact-xs" variant="default" loading={cancel.isPending} onClick={end}>
        Cancel
      </Button>
    </div>
  );
}
