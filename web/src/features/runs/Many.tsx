/** What can be said of all chosen runs at once: a verdict, or tags. Either can be taken back. */

import { Button, Group, Modal, SegmentedControl, TagsInput, Text, TextInput } from "@mantine/core";
import { notifications } from "@mantine/notifications";
import { type FormEvent, useMemo, useState } from "react";
import { type Retag, useJudgeMany, useRetag } from "../../api/queries";
import type { ListedRun } from "../../model/run";
import { apart, LONGEST, tagsOf, type Word, WORDS } from "../../model/verdict";
import { Icon } from "../../ui/Icon";
import { notify, notifyError, PRESSED } from "../../ui/notify";
import classes from "./Runs.module.css";

interface Props {
  runs: readonly ListedRun[];
  selected: ReadonlySet<number>;
  onClear: () => void;
}

export function Many({ runs, selected, onClear }: Props) {
  const chosen = useMemo(() => runs.filter(({ run }) => selected.has(run)), [runs, selected]);
  const [said, setSaid] = useState<"verdict" | "tags">();
  const close = () => setSaid(undefined);
  if (chosen.length === 0) return null;
  return (
    <Group className={classes.many} gap="xs" role="toolbar" aria-label="Chosen runs">
      <Text size="sm">{chosen.length === 1 ? "1 run chosen" : `${chosen.length} runs chosen`}</Text>
      <Button size="compact-xs" variant="default" onClick={() => setSaid("verdict")}>
        Verdict …
      </Button>
      <Button size="compact-xs" variant="default" onClick={() => setSaid("tags")}>
        Tags …
      </Button>
      <Button size="compact-xs" variant="subtle" leftSection={<Icon name="close" size={12} />} onClick={onClear}>
        Choose none
      </Button>
      <Modal opened={said === "verdict"} onClose={close} title={`Verdict on ${many(chosen)}`} size="md">
        <VerdictOnMany runs={chosen} onDone={close} />
      </Modal>
      <Modal opened={said === "tags"} onClose={close} title={`Tags of ${many(chosen)}`} size="md">
        <TagsOfMany runs={chosen} all={runs} onDone={close} />
      </Modal>
    </Group>
  );
}

const many = (runs: readonly unknown[]): string => (runs.length === 1 ? "1 run" : `${runs.length} runs`);

interface FormProps {
  runs: readonly ListedRun[];
  onDone: () => void;
}

function VerdictOnMany({ runs, onDone }: FormProps) {
  const [word, setWord] = useState<Word>("discarded");
  const [reason, setReason] = useState("");
  const { give, busy } = useVerdicts();
  const { able, unable } = apart(runs, word);
  const send = (event: FormEvent) => {
    event.preventDefault();
    if (able.length && reason.trim()) give(able, word, reason.trim(), onDone);
  };
  return (
    <form onSubmit={send} aria-label={`Verdict on ${many(runs)}`}>
      <SegmentedControl size="xs" fullWidth aria-label="Verdict" value={word} onChange={(next) => setWord(next as Word)} data={[...WORDS]} />
      <TextInput
        size="xs"
        mt="xs"
        label="Reason"
        placeholder="Why, in one line, for who reads it later"
        maxLength={LONGEST}
        value={reason}
        onChange={(event) => setReason(event.currentTarget.value)}
        data-autofocus
      />
      {unable[0] ? (
        <Text size="xs" c="dimmed" mt={4}>
          {unable.length === 1 ? `#${unable[0].run.run} is left out.` : `${unable.length} of them are left out, such as #${unable[0].run.run}.`}{" "}
          {unable[0].why}
        </Text>
      ) : null}
      <Group justify="flex-end" mt="sm">
        <Button type="submit" size="xs" disabled={!able.length || !reason.trim()} loading={busy}>
          Decide about {many(able)}
        </Button>
      </Group>
    </form>
  );
}

/** Gives verdicts, and tells so with a way back: each run is again what it was. */
function useVerdicts() {
  const { mutateAsync, isPending } = useJudgeMany();
  const give = async (runs: readonly ListedRun[], verdict: Word, reason: string, done: () => void) => {
    const back = `Taken back: ${verdict}, ${reason}`.slice(0, LONGEST);
    await mutateAsync(runs.map(({ run }) => ({ run, verdict, reason })));
    done();
    told(`${many(runs)} ${runs.length === 1 ? "is" : "are"} ${verdict}.`, async () => {
      await mutateAsync(runs.map((each) => ({ run: each.run, verdict: each.verdict, reason: back })));
      notify(`The verdict on ${many(runs)} is taken back.`, "");
    });
  };
  return { give: (...all: Parameters<typeof give>) => void give(...all).catch(notifyError), busy: isPending };
}

function TagsOfMany({ runs, all, onDone }: FormProps & { all: readonly ListedRun[] }) {
  const known = useMemo(() => [...new Set(all.flatMap(({ tags }) => tags))].sort(), [all]);
  const had = useMemo(() => [...new Set(runs.flatMap(({ tags }) => tags))].sort(), [runs]);
  const [put, setPut] = useState<string[]>([]);
  const [typed, setTyped] = useState("");
  const [remove, setRemove] = useState<string[]>([]);
  const { change, busy } = useTags();
  // What stands in the field and was not ended by Enter is meant too.
  const add = tagsOf([...put, typed].join(","));
  const send = (event: FormEvent) => {
    event.preventDefault();
    if (add.length || remove.length) change(runs.map(({ run }) => ({ run, add, remove })), onDone);
  };
  return (
    <form onSubmit={send} aria-label={`Tags of ${many(runs)}`}>
      <TagsInput size="xs" label="Put on" placeholder={put.length ? "" : "Enter or a comma ends a tag"} data={known} value={put} onChange={setPut} searchValue={typed} onSearchChange={setTyped} acceptValueOnBlur data-autofocus />
      <TagsInput
        size="xs"
        mt="xs"
        label="Take off"
        placeholder={remove.length ? "" : had.length ? `They have ${had.slice(0, 5).join(", ")}${had.length > 5 ? ", …" : ""}` : "They have none"}
        disabled={had.length === 0}
        data={had}
        value={remove}
        onChange={(next) => setRemove(next.filter((tag) => had.includes(tag)))}
      />
      <Group justify="flex-end" mt="sm">
        <Button type="submit" size="xs" disabled={!add.length && !remove.length} loading={busy}>
          Change the tags of {many(runs)}
        </Button>
      </Group>
    </form>
  );
}

/** Changes tags, and tells so with a way back. */
function useTags() {
  const { mutateAsync, isPending } = useRetag();
  const change = async (wanted: Retag[], done: () => void) => {
    const changed = await mutateAsync(wanted);
    done();
    if (changed.length === 0) return notify("They had these tags already.", "", "gray");
    told(`The tags of ${many(changed)} are changed.`, async () => {
      await mutateAsync(changed.map(({ run, add = [], remove = [] }) => ({ run, add: remove, remove: add })));
      notify(`The tags of ${many(changed)} are as they were.`, "");
    });
  };
  return { change: (...all: Parameters<typeof change>) => void change(...all).catch(notifyError), busy: isPending };
}

/** What was done to many is told for longer, since its undo stands nowhere else; the dialog is closed by then. */
function told(title: string, undo: () => Promise<void>) {
  const id = `many ${title}`;
  const act = () => {
    notifications.hide(id);
    undo().catch(notifyError);
  };
  const button = (
    <Button size="compact-xs" variant="subtle" onClick={act}>
      Undo
    </Button>
  );
  notify(title, button, "teal", { id, autoClose: PRESSED });
}
