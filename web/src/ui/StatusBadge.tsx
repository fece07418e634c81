/** The status of a run as a badge; one that failed or missed a goal tells why when pointed at. */

import { Badge, Tooltip, VisuallyHidden } from "@mantine/core";
import type { Status } from "../model/run";
import { Icon } from "./Icon";

const COLORS: Record<Status, string> = {
  waiting: "grape",
  starting: "gray",
  running: "blue",
  paused: "yellow",
  done: "teal",
  failed: "red",
  stopped: "gray",
  killed: "red",
  cancelled: "gray",
};

interface Props {
  status: Status;
  error?: string | null;
  /** One sentence per goal that was not met. */
  unmet?: readonly string[];
}

export function StatusBadge({ status, error, unmet = [] }: Props) {
  const missed = status === "done" && unmet.length > 0;
  const badge = (
    <Badge
      color={missed ? "orange" : (COLORS[status] ?? "gray")}
      variant="light"
      size="sm"
      radius="sm"
      tt="none"
      miw={70}
      style={{ overflow: "visible" }}
      rightSection={missed ? <Icon name="warning" size={11} /> : null}
    >
      {status}
      {missed ? <VisuallyHidden>, goals missed</VisuallyHidden> : null}
    </Badge>
  );
  const why = error ? lastLine(error) : missed ? `Done, but ${unmet.join("; ")}.` : "";
  if (!why) return badge;
  return (
    <Tooltip label={why} multiline maw={420} position="right">
      <span style={{ display: "inline-flex" }}>{badge}</span>
    </Tooltip>
  );
}

/** The line of a traceback that says what happened. */
export const lastLine = (error: string): string => error.trim().split("\n").at(-1) ?? error;
