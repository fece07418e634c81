/** A verdict on a run: which one, and why. It can be taken back afterwards. */

import { Button, Group, SegmentedControl, Text, TextInput } from "@mantine/core";
import { notifications } from "@mantine/notifications";
import { useQueryClient } from "@tanstack/react-query";
import { type FormEvent, useState } from "react";
import { run as runQuery, useJudge } from "../../api/queries";
import type { Run } from "../../model/run";
import { hindrance, LONGEST, takenBack, type Word, WORDS } from "../../model/verdict";
import { notify, notifyError } from "../../ui/notify";

interface Props {
  run: Pick<Run, "run" | "status">;
  word: Word;
  onWord: (word: Word) => void;
  onDone?: () => void;
  autoFocus?: boolean;
}

export function VerdictForm({ run, word, onWord, onDone, autoFocus = false }: Props) {
  const [reason, setReason] = useState("");
  const { give, busy } = useVerdict(run.run);
  const why = hindrance(run, word);
  const send = (event: FormEvent) => {
    event.preventDefault();
    if (why || !reason.trim()) return;
    give(word, reason, () => {
      setReason("");
      onDone?.();
    });
  };
  return (
    <form onSubmit={send} aria-label={`Verdict on run ${run.run}`}>
      <SegmentedControl
        size="xs"
        fullWidth
        aria-label="Verdict"
        value={word}
        onChange={(next) => onWord(next as Word)}
        data={[...WORDS]}
      />
      <Group gap="xs" mt="xs" align="flex-start" wrap="nowrap">
        <TextInput
          size="xs"
          flex={1}
          label="Reason"
          placeholder="Why, in one line, for who reads it later"
          maxLength={LONGEST}
          value={reason}
          onChange={(event) => setReason(event.currentTarget.value)}
          data-autofocus={autoFocus || undefined}
          data-testid="verdict-reason"
        />
        <Button type="submit" size="xs" mt={24} disabled={Boolean(why) || !reason.trim()} loading={busy} data-testid="verdict-give">
          Decide
        </Button>
      </Group>
      {why ? (
        <Text size="xs" c="dimmed" mt={4}>
          {why}
        </Text>
      ) : null}
    </form>
  );
}

/** Give a verdict on a run, and tell so with a way back. */
function useVerdict(run: number) {
  const judge = useJudge();
  const kept = useQueryClient();
  const send = (verdict: Word, reason: string, onSuccess: () => void) =>
    judge.mutate({ run, verdict, reason, who: "" }, { onSuccess, onError: notifyError });
  const undo = async () => {
    notifications.clean();
    const { verdicts } = await kept.fetchQuery({ ...runQuery(run), staleTime: 0 });
    const back = takenBack(verdicts);
    if (back) send(back.verdict, back.reason, () => notify(`Run #${run} is ${back.verdict} again.`, ""));
  };
  const give = (verdict: Word, reason: string, done: () => void) =>
    send(verdict, reason.trim(), () => {
      done();
      const back = (
        <Button size="compact-xs" variant="subtle" onClick={() => void undo()}>
          Undo
        </Button>
      );
      notify(`Run #${run} is ${verdict}.`, back, verdict === "discarded" ? "red" : "teal");
    });
  return { give, busy: judge.isPending };
}
