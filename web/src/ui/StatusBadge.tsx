/** The status of a run as a badge; a failed run tells why when pointed at. */

import { Badge, Tooltip } from "@mantine/core";
import type { Status } from "../model/run";

const COLORS: Record<Status, string> = {
  starting: "gray",
  running: "blue",
  paused: "yellow",
  done: "teal",
  failed: "red",
  stopped: "gray",
  killed: "red",
};

export function StatusBadge({ status, error }: { status: Status; error?: string | null }) {
  const badge = (
    <Badge color={COLORS[status] ?? "gray"} variant="light" size="sm" radius="sm" tt="none" miw={70} style={{ overflow: "visible" }}>
      {status}
    </Badge>
  );
  if (!error) return badge;
  return (
    <Tooltip label={lastLine(error)} multiline maw={420} position="right">
      <span>{badge}</span>
    </Tooltip>
  );
}

/** The line of a traceback that says what happened. */
export const lastLine = (error: string): string => error.trim().split("\n").at(-1) ?? error;
