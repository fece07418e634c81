/** A scenario as text: edited with its problems at their lines, saved, and kept apart from what others have done meanwhile. */

import { Alert, Badge, Button, Group, Text, Title } from "@mantine/core";
import { useDebouncedValue } from "@mantine/hooks";
import { useQuery, useQueryClient } from "@tanstack/react-query";
import { Link, useBlocker, useNavigate } from "@tanstack/react-router";
import type { EditorView } from "@codemirror/view";
import { useCallback, useEffect, useMemo, useRef, useState } from "react";
import { scenarios } from "../../api/queries";
import {
  isGone,
  isStale,
  readText,
  type Text as Read,
  text as textQuery,
  textCheck,
  useImport,
  useSaveText,
} from "../../api/scenarios";
import type { Problem } from "../../model/run";
import { byLine, freeName, pathOf, type TextProblem } from "../../model/scenario";
import { Icon } from "../../ui/Icon";
import { NameDialog } from "../../ui/NameDialog";
import { notify, notifyError } from "../../ui/notify";
import { ProblemList, ProblemText } from "../../ui/Problems";
import { LeaveQuestion } from "../../ui/LeaveQuestion";
import { Failure, Loading } from "../../ui/State";
import { useSaveKey } from "../../ui/shortcut";
import { goTo, mark, openEditor, replaceAll } from "../../ui/editor";
import shared from "../../ui/TextEditor.module.css";
import classes from "./Scenarios.module.css";

export function TextPage({ id }: { id: string }) {
  const { data, error, refetch } = useQuery(textQuery(id));
  if (error) return <Failure error={error} onRetry={() => void refetch()} />;
  if (!data) return <Loading what="the text" />;
  return <Editing id={id} read={data} />;
}

function Editing({ id, read }: { id: string; read: Read }) {
  // What stands in the file as far as is known here, and what stands in the editor.
  const [saved, setSaved] = useState(read);
  const [now, setNow] = useState(read.text);
  const editor = useRef<EditorView>(null);
  const rows = useQuery(scenarios).data;
  const row = rows?.find((each) => each.id === id);
  const problems = useProblems(id, now, editor);
  const dirty = now !== saved.text;
  const saving = useSaving(id, now, saved.digest, setSaved);
  const save = () => {
    if (dirty && !saving.pending && !row?.sealed) saving.save();
  };
  useSaveKey(save);
  const leave = useBlocker({ shouldBlockFn: () => dirty, enableBeforeUnload: () => dirty, withResolver: true });
  const [naming, setNaming] = useState(false);
  const show = useCallback((read: Read) => {
    if (editor.current) replaceAll(editor.current, read.text);
    setSaved(read);
  }, []);

  return (
    <div className={classes.text}>
      <header className={classes.textHead}>
        <Title order={1} fz="md">
          {row?.title ?? id}
        </Title>
        <Text size="sm" c="dimmed">
          {id}.yaml
        </Text>
        <Badge variant="light" tt="none" flex="none" color={dirty ? "orange" : "gray"} role="status" data-testid="text-state">
          {row?.sealed ? "may be read only" : saving.pending ? "saving …" : dirty ? "not saved" : "saved"}
        </Badge>
        <Group gap="xs" ml="auto" wrap="nowrap" flex="none">
          <Button component={Link} to="/scenarios" size="xs" variant="subtle" leftSection={<Icon name="left" size={14} />}>
            All scenarios
          </Button>
          <Button
            component={Link}
            to="/studio/$scenario"
            params={{ scenario: id } as never}
            search={{} as never}
            size="xs"
            variant="default"
          >
            Open in the studio
          </Button>
          <Button size="xs" variant="default" disabled={!dirty} onClick={() => show(saved)}>
            Back to the file
          </Button>
          <Button size="xs" variant="default" onClick={() => setNaming(true)}>
            Save as …
          </Button>
          <Button
            size="xs"
            leftSection={<Icon name="save" size={14} />}
            disabled={!dirty || row?.sealed}
            loading={saving.pending}
            onClick={save}
          >
            Save
          </Button>
        </Group>
      </header>
      <Refused id={id} saving={saving} onTheirs={show} onAnother={() => setNaming(true)} />
      <Editor read={read} label={`Text of ${id}.yaml`} onText={setNow} editor={editor} />
      <Problems {...problems} onGo={(line, column) => editor.current && goTo(editor.current, line, column)} />
      {naming ? <SaveAs id={id} now={now} names={rows?.map((each) => each.id) ?? []} onClose={() => setNaming(false)} /> : null}
      <LeaveQuestion
        leave={leave}
        pending={saving.pending}
        onSave={() => saving.save(leave.proceed, leave.reset)}
        canSave={!row?.sealed}
      />
    </div>
  );
}

interface EditorProps {
  read: Read;
  label: string;
  onText: (text: string) => void;
  editor: React.RefObject<EditorView | null>;
}

/** It is made once, with what was read at first; React does not draw its inside. */
function Editor({ read, label, onText, editor }: EditorProps) {
  const place = useRef<HTMLDivElement>(null);
  const first = useRef({ text: read.text, label, onText });
  useEffect(() => {
    if (!place.current) return;
    const view = openEditor(place.current, first.current);
    editor.current = view;
    view.focus();
    return () => {
      editor.current = null;
      view.destroy();
    };
  }, [editor]);
  return <div ref={place} className={shared.editor} />;
}

/** What the server says of the text, shortly after the last key; meanwhile what it said of the text before. */
function useProblems(id: string, now: string, editor: React.RefObject<EditorView | null>) {
  const [settled] = useDebouncedValue(now, 350);
  const { data, error } = useQuery({ ...textCheck(id, settled), placeholderData: (before) => before });
  const problems = useMemo(() => byLine(data?.problems ?? []), [data]);
  useEffect(() => {
    if (editor.current) mark(editor.current, problems);
  }, [problems, editor]);
  return { problems, checked: data !== undefined && settled === now, error };
}

interface ProblemsProps {
  problems: readonly TextProblem[];
  checked: boolean;
  error: (Error & { problems?: Problem[] }) | null;
  onGo: (line: number, column: number) => void;
}

function Problems({ problems, checked, error, onGo }: ProblemsProps) {
  if (error) return <Failure error={error} />;
  if (problems.length === 0) {
    return (
      <p className={classes.good} role="status">
        {checked ? "No problem found: this can be run." : "Checking …"}
      </p>
    );
  }
  return (
    <ul className={shared.problems} aria-label="Problems of this text">
      {problems.map((problem) => (
        <li key={`${problem.where} ${problem.what}`}>
          {problem.line === null ? (
            <span />
          ) : (
            <button type="button" className={classes.place} onClick={() => onGo(problem.line ?? 1, problem.column ?? 1)}>
              Line {problem.line}
            </button>
          )}
          <ProblemText problem={{ ...problem, where: pathOf(problem) }} />
        </li>
      ))}
    </ul>
  );
}

/** Saving, with what the server refused: the text in the editor stays in any case. */
function useSaving(id: string, now: string, digest: string, onSaved: (read: Read) => void) {
  const put = useSaveText();
  const add = useImport();
  const kept = useQueryClient();
  const save = (then?: () => void, otherwise?: () => void, over = digest) =>
    put.mutate(
      { id, text: now, digest: over },
      {
        onSuccess: (done) => {
          onSaved({ text: now, digest: done.digest });
          then?.();
        },
        onError: () => otherwise?.(),
      },
    );
  const note = (done: { digest: string }) => {
    put.reset();
    onSaved({ text: now, digest: done.digest });
    return kept.invalidateQueries({ queryKey: ["scenarios"] });
  };
  return {
    save: (then?: () => void, otherwise?: () => void) => save(then, otherwise),
    /** Over what somebody else has written meanwhile. */
    overwrite: () =>
      readText(id).then(
        (theirs) => save(undefined, undefined, theirs.digest),
        (error: Error) => notifyError(error),
      ),
    /** Under the old name, when the file is not there any more. */
    anew: () => add.mutate({ name: id, text: now }, { onSuccess: note, onError: notifyError }),
    error: put.error as (Error & { problems?: Problem[] }) | null,
    pending: put.isPending || add.isPending,
    forget: put.reset,
  };
}

interface SaveAsProps {
  id: string;
  now: string;
  names: readonly string[];
  onClose: () => void;
}

/** The text as another file, which is opened then; the old one stays as it is on the disk. */
function SaveAs({ id, now, names, onClose }: SaveAsProps) {
  const add = useImport();
  const navigate = useNavigate();
  const save = (name: string) =>
    add.mutate(
      { name, text: now },
      {
        onSuccess: ({ scenario }) => {
          onClose();
          notify("Saved as another file", `${scenario}.yaml has your text.`);
          void navigate({ to: "/scenarios/$scenario/text", params: { scenario }, ignoreBlocker: true });
        },
      },
    );
  return (
    <NameDialog
      heading="Save as another file"
      action="Save"
      name={freeName(id, names)}
      taken={names}
      error={add.error}
      pending={add.isPending}
      onClose={onClose}
      onName={({ name }) => save(name)}
    />
  );
}

interface RefusedProps {
  id: string;
  saving: ReturnType<typeof useSaving>;
  onTheirs: (read: Read) => void;
  onAnother: () => void;
}

/** Why it was not saved, and the ways on. */
function Refused({ id, saving, onTheirs, onAnother }: RefusedProps) {
  const { error } = saving;
  if (!error) return null;
  const [stale, gone] = [isStale(error), isGone(error)];
  const theirs = () =>
    readText(id).then(
      (read) => {
        saving.forget();
        onTheirs(read);
      },
      (caught: Error) => notifyError(caught),
    );
  return (
    <Alert
      color="red"
      variant="outline"
      radius={0}
      py={8}
      role="alert"
      icon={<Icon name="warning" />}
      title={`${error.message} Your text is still here, and not saved.`}
      withCloseButton
      closeButtonLabel="Close this message"
      onClose={saving.forget}
    >
      <ProblemList problems={error.problems ?? []} />
      {stale || gone ? (
        <Group gap="xs" mt="xs">
          <Button size="compact-xs" variant="default" onClick={onAnother}>
            Save as another file …
          </Button>
          {stale ? (
            <>
              <Button size="compact-xs" variant="default" onClick={() => void saving.overwrite()}>
                Save over theirs
              </Button>
              <Button size="compact-xs" variant="default" onClick={() => void theirs()}>
                Take theirs, drop mine
              </Button>
            </>
          ) : (
            <Button size="compact-xs" variant="default" onClick={saving.anew}>
              Write it again as {id}.yaml
            </Button>
          )}
        </Group>
      ) : null}
    </Alert>
  );
}
