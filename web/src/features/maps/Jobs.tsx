/** Imports on their way: how much is sent, what is being done, for how long, and what went wrong. */

import { ActionIcon, Button, Progress, Text, Tooltip } from "@mantine/core";
import { useCancel } from "../../api/maps";
import type { MapJob } from "../../model/map";
import type { Problem } from "../../model/run";
import { formatDuration } from "../../model/units";
import { Icon } from "../../ui/Icon";
import { notifyError } from "../../ui/notify";
import { ProblemList } from "../../ui/Problems";
import { store, type Upload, useDismissed, useJobs, useSend, useUploads } from "./imports";
import classes from "./Maps.module.css";

interface Props {
  /** Only those of this map. */
  map?: string;
}

/** All that goes on, or has failed and was not waved away. */
export function Jobs({ map }: Props) {
  const [uploads, jobs, dismissed] = [useUploads(), useJobs(), useDismissed()];
  const sending = map === undefined ? uploads.filter(({ job }) => job === undefined) : [];
  const shown = jobs.filter(
    (job) =>
      (map === undefined || job.map === map) &&
      (job.status === "running" || (job.status === "failed" && !dismissed.has(job.id))),
  );
  if (sending.length + shown.length === 0) return null;
  return (
    <div className={classes.jobs} aria-live="polite" data-testid="map-jobs">
      {sending.map((upload) => (
        <Sending key={upload.key} upload={upload} />
      ))}
      {shown.map((job) => (
        <Going
          key={job.id}
          job={job}
          failure={map === undefined ? `${job.map} was not imported` : "The map stays as it was"}
          upload={uploads.find((upload) => upload.job === job.id)}
        />
      ))}
    </div>
  );
}

function Sending({ upload }: { upload: Upload }) {
  const { key, name, share, error } = upload;
  if (error) {
    return (
      <Failed
        title={`${name} was not imported`}
        message={error.message}
        problems={error.problems ?? []}
        upload={upload}
        onClose={() => store.forget(key)}
      />
    );
  }
  return (
    <Row title={name} what={share < 1 ? `sending ${Math.round(share * 100)} %` : "is being taken"} share={share}>
      <Cancel label={`Cancel the upload of ${name}`} onClick={() => store.cancel(key)} />
    </Row>
  );
}

interface GoingProps {
  job: MapJob;
  failure: string;
  upload: Upload | undefined;
}

function Going({ job, failure, upload }: GoingProps) {
  const cancel = useCancel();
  if (job.status === "failed") {
    return (
      <Failed
        title={failure}
        message={job.problem?.message ?? "The import has failed."}
        problems={job.problem?.problems ?? []}
        upload={upload}
        onClose={() => store.dismiss(job.id)}
      />
    );
  }
  return (
    <Row title={job.map} what={`${job.stage} · ${formatDuration(job.seconds)}`} share={job.share}>
      <Cancel
        label={`Cancel the import of ${job.map}`}
        onClick={() => cancel.mutate(job.id, { onError: notifyError })}
        loading={cancel.isPending}
      />
    </Row>
  );
}

interface RowProps {
  title: string;
  what: string;
  /** Null where nobody knows. */
  share: number | null;
  children: React.ReactNode;
}

function Row({ title, what, share, children }: RowProps) {
  return (
    <div className={classes.job} data-testid="map-job">
      <b>{title}</b>
      <Text size="xs" c="dimmed" data-testid="map-job-stage">
        {what}
      </Text>
      <Progress value={(share ?? 1) * 100} animated={share === null} striped={share === null} aria-label={title} />
      {children}
    </div>
  );
}

interface CancelProps {
  label: string;
  onClick: () => void;
  loading?: boolean;
}

function Cancel({ label, onClick, loading = false }: CancelProps) {
  return (
    <Button
      size="compact-xs"
      variant="default"
      aria-label={label}
      data-testid="cancel-import"
      loading={loading}
      onClick={onClick}
    >
      Cancel
    </Button>
  );
}

interface FailedProps {
  title: string;
  message: string;
  problems: readonly Problem[];
  /** What was sent, so that it can be sent again. */
  upload: Upload | undefined;
  onClose: () => void;
}

function Failed({ title, message, problems, upload, onClose }: FailedProps) {
  const send = useSend();
  const again = (replace: boolean) => {
    if (!upload) return;
    onClose();
    void send([upload.file], { name: upload.name, bbox: upload.bbox, replace });
  };
  return (
    <div className={classes.job} data-failed role="alert" data-testid="import-failed">
      <Icon name="warning" />
      <div className={classes.why}>
        <b>{title}</b>
        <Text size="sm">{message}</Text>
        <ProblemList problems={problems} />
      </div>
      {upload ? (
        <Button size="compact-xs" variant="default" onClick={() => again(upload.replace)}>
          Try again
        </Button>
      ) : null}
      <Tooltip label="Dismiss">
        <ActionIcon size="sm" variant="subtle" color="gray" aria-label="Dismiss" onClick={onClose}>
          <Icon name="close" size={14} />
        </ActionIcon>
      </Tooltip>
    </div>
  );
}
