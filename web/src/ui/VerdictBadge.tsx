/** What was decided about a run; the reason is told when it is pointed at. */

import { Badge, Tooltip } from "@mantine/core";
import type { Word } from "../model/verdict";
import { Icon, type IconName } from "./Icon";

const LOOKS: Record<Word, { color: string; icon: IconName | undefined }> = {
  open: { color: "gray", icon: undefined },
  candidate: { color: "teal", icon: "check" },
  discarded: { color: "red", icon: "close" },
};

export function VerdictBadge({ verdict, reason = "" }: { verdict: Word; reason?: string }) {
  const { color, icon } = LOOKS[verdict];
  const badge = (
    <Badge
      color={color}
      variant={icon ? "light" : "outline"}
      size="sm"
      radius="sm"
      tt="none"
      miw={88}
      style={{ overflow: "visible", flexShrink: 0 }}
      styles={{ label: { overflow: "visible" } }}
      leftSection={icon ? <Icon name={icon} size={11} /> : null}
    >
      {verdict}
    </Badge>
  );
  if (!reason) return badge;
  return (
    <Tooltip label={reason} multiline maw={420} position="right">
      <span style={{ display: "inline-flex" }}>{badge}</span>
    </Tooltip>
  );
}
