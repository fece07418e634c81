/** What is said of a run: the verdict with its history, and its name, tags and note. */

import { Button, Group, Text, Textarea, TextInput } from "@mantine/core";
import { type FormEvent, useState } from "react";
import { useRemark } from "../../api/queries";
import type { RunDetail } from "../../model/run";
import { formatMoment } from "../../model/units";
import { ACTS, hindrance, suggestion, tagsOf, type Word } from "../../model/verdict";
import { notifyError } from "../../ui/notify";
import { useShortcuts } from "../../ui/shortcut";
import { Note } from "../../ui/Note";
import { VerdictBadge } from "../../ui/VerdictBadge";
import classes from "./Runs.module.css";
import { VerdictForm } from "./VerdictForm";

interface Props {
  run: RunDetail;
  /** Where the times of a note lead. */
  onSeek?: ((time: number) => void) | undefined;
}

export function VerdictCard({ run, onSeek }: Props) {
  const hint = suggestion(run);
  const [word, setWord] = useState<Word>(hint?.word ?? (hindrance(run, "candidate") ? "discarded" : "candidate"));
  const choose = (next: Word) => () => {
    setWord(next);
    document.querySelector<HTMLElement>("[data-testid=verdict-reason]")?.focus();
  };
  useShortcuts({ c: choose("candidate"), C: choose("candidate"), d: choose("discarded"), D: choose("discarded") });
  return (
    <>
      <Group gap="xs" mb="xs" data-testid="verdict-now">
        <VerdictBadge verdict={run.verdict} />
        <Text size="sm">{run.reason || "Nobody has decided about this run yet."}</Text>
      </Group>
      {hint && run.verdicts.length === 0 ? (
        <Text size="xs" c="dimmed" mb="xs">
          {hint.why} {ACTS[hint.word]}?
        </Text>
      ) : null}
      <VerdictForm run={run} word={word} onWord={setWord} />
      <History run={run} />
      <Remarks key={[run.name, ...run.tags, run.note].join("\n")} run={run} onSeek={onSeek} />
    </>
  );
}

/** All verdicts, the last first. */
function History({ run }: { run: RunDetail }) {
  if (run.verdicts.length === 0) return null;
  return (
    <ol className={classes.verdicts} aria-label="Verdicts so far" reversed>
      {run.verdicts.toReversed().map(({ verdict, reason, who, when }, place) => (
        <li key={run.verdicts.length - place}>
          <VerdictBadge verdict={verdict} />
          <span>{reason}</span>
          <small>
            {who}, {formatMoment(when)}
          </small>
        </li>
      ))}
    </ol>
  );
}

/** What it is called, and found by. */
function Remarks({ run, onSeek }: Props) {
  const [name, setName] = useState(run.name);
  const [tags, setTags] = useState(run.tags.join(", "));
  const [note, setNote] = useState(run.note);
  const remark = useRemark();
  const changed = name !== run.name || tags !== run.tags.join(", ") || note !== run.note;
  const save = (event: FormEvent) => {
    event.preventDefault();
    remark.mutate({ run: run.run, name, tags: tagsOf(tags), note }, { onError: notifyError });
  };
  return (
    <form onSubmit={save} aria-label={`Name, tags and note of run ${run.run}`} className={classes.remarks}>
      <TextInput size="xs" label="Name" value={name} onChange={(event) => setName(event.currentTarget.value)} />
      <TextInput
        size="xs"
        label="Tags"
        placeholder="separated by commas"
        value={tags}
        onChange={(event) => setTags(event.currentTarget.value)}
      />
      <Textarea
        size="xs"
        label="Note"
        description="**strong**, *emphasis*, `literal`, lists, links; @12.3 s leads to that time"
        autosize
        minRows={2}
        value={note}
        onChange={(event) => setNote(event.currentTarget.value)}
      />
      {note ? (
        <section aria-label="The note as it is read" className={classes.note}>
          <Note note={note} onSeek={onSeek} />
        </section>
      ) : null}
      <Group justify="flex-end" gap="xs">
        <Button type="submit" size="compact-xs" variant="light" disabled={!changed} loading={remark.isPending}>
          Save
        </Button>
      </Group>
    </form>
  );
}
