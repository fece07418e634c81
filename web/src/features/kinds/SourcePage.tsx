/** The source of an application: read and proved by the server while it is typed, written into the user's own file by the browser. */

import type { EditorView } from "@codemirror/view";
import { Alert, Badge, Button, Code, Group, Text, Title } from "@mantine/core";
import { useDebouncedValue } from "@mantine/hooks";
import { useQuery, useQueryClient } from "@tanstack/react-query";
import { Link, useBlocker } from "@tanstack/react-router";
import { type RefObject, useCallback, useEffect, useMemo, useRef, useState } from "react";
import { canWrite, download } from "../../api/disk";
import { applicationStarts, kinds, type Manuscript, manuscript, textProof, vocabulary } from "../../api/queries";
import { beneath, entitled, keepText, keptText } from "../../model/source";
import { goTo, mark, openEditor, replaceAll } from "../../ui/editor";
import { Icon } from "../../ui/Icon";
import { LeaveQuestion } from "../../ui/LeaveQuestion";
import { pythonText } from "../../ui/python";
import { Empty, Failure, Loading } from "../../ui/State";
import { useSaveKey } from "../../ui/shortcut";
import { NewApplication } from "./NewApplication";
import { useSaving } from "./saving";
import shared from "../../ui/TextEditor.module.css";
import classes from "./Sources.module.css";

interface Props {
  name: string;
  /** The start of a new one. */
  start: string | undefined;
}

export function SourcePage({ name, start }: Props) {
  const every = useQuery(kinds);
  const isKnown = every.data?.kinds.some((each) => each.sort === "application" && each.name === name);
  const isNew = isKnown === false;
  useQuery({ ...kinds, refetchInterval: isNew ? 2000 : false });
  const known = useQuery({ ...manuscript("application", name), enabled: isKnown === true });
  const starts = useQuery({ ...applicationStarts, enabled: isNew });
  const failed = [every, known, starts].find((each) => each.error && !each.data);
  if (failed?.error) return <Failure error={failed.error} onRetry={() => void failed.refetch()} />;
  if (known.data) return <Editing key={known.data.own ? "own" : "built in"} name={name} found={known.data} first={known.data.text} />;
  if (!isNew || !starts.data) return <Loading what="the source" />;
  const begun = starts.data.find((each) => each.name === start);
  if (begun || keptText(name)) return <Editing key="own" name={name} found={null} first={begun ? entitled(begun.text, name) : ""} />;
  return (
    <Empty icon="text" title={`There is no application ${name}`}>
      It may lie in a folder that the studio was not started with. Those that are there stand under Kinds, where a new one is begun too.
    </Empty>
  );
}

interface EditingProps {
  name: string;
  /** The file as the server has it; null while it has none of that name. */
  found: Manuscript | null;
  first: string;
}

function Editing({ name, found, first }: EditingProps) {
  const editor = useRef<EditorView>(null);
  const isOwn = found === null || found.own;
  const text = useText(name, found, first, isOwn, editor);
  const { now, base } = text;
  const slips = useSlips(now, isOwn, editor);
  const saving = useSaving({ name, file: found?.file ?? "", now, base, onSaved: text.setBase, onTheirs: text.setTheirs });
  const dirty = isOwn && (now !== base || (found === null && !saving.isSaved));
  const save = () => {
    if (dirty && canWrite() && !saving.pending) void saving.save();
  };
  useSaveKey(save);
  const leave = useBlocker({
    shouldBlockFn: ({ current, next }) => now !== base && current.pathname !== next.pathname,
    enableBeforeUnload: () => now !== base,
    withResolver: true,
  });
  const [copying, setCopying] = useState(false);
  return (
    <div className={classes.page}>
      <header className={classes.head}>
        <Title order={1} fz="md">
          {name}
        </Title>
        <Text size="sm" c="dimmed" className={classes.file}>
          {found?.file || `${name}.py`}
        </Text>
        <Badge variant="light" tt="none" flex="none" color={dirty ? "orange" : "gray"} role="status" data-testid="source-state">
          {!isOwn ? "may be read only" : saving.pending ? "saving …" : dirty ? "not saved" : "saved"}
        </Badge>
        <Group gap="xs" ml="auto">
          <Button component={Link} to="/kinds" size="xs" variant="subtle" leftSection={<Icon name="left" size={14} />}>
            All kinds
          </Button>
          <Button size="xs" variant="default" leftSection={<Icon name="download" size={14} />} onClick={() => download(`${name}.py`, now)}>
            Download
          </Button>
          {isOwn ? (
            <>
              <Button size="xs" variant="default" disabled={now === base} onClick={() => text.show(base)}>
                Back to the file
              </Button>
              <Button size="xs" leftSection={<Icon name="save" size={14} />} disabled={!dirty || !canWrite()} loading={saving.pending} onClick={save}>
                {found ? "Save" : "Save as …"}
              </Button>
            </>
          ) : (
            <Button size="xs" leftSection={<Icon name="copy" size={14} />} onClick={() => setCopying(true)}>
              Copy as my own
            </Button>
          )}
        </Group>
      </header>
      <Standing name={name} found={found} isSaved={saving.isSaved} />
      <Beneath name={name} theirs={text.theirs} now={now} onTheirs={text.take} onMine={() => void saving.save(text.theirs ?? "")} />
      <Editor first={now} label={`Source of ${name}`} readOnly={!isOwn} onText={text.setNow} editor={editor} />
      <Slips {...slips} onGo={(line, column) => editor.current && goTo(editor.current, line, column)} />
      {copying ? <NewApplication start={name} onClose={() => setCopying(false)} /> : null}
      <LeaveQuestion leave={leave} pending={saving.pending} onSave={() => void saving.save(undefined, leave.proceed)} canSave={canWrite()} />
    </div>
  );
}

/** What stands in the editor, what in the file as far as is known, and what the file has instead when both were changed. */
function useText(name: string, found: Manuscript | null, first: string, isOwn: boolean, editor: RefObject<EditorView | null>) {
  const [begun] = useState(() => (isOwn ? keptText(name) : null));
  const [now, setNow] = useState(begun?.text ?? first);
  const [base, setBase] = useState(begun?.base ?? (found ? first : ""));
  const [theirs, setTheirs] = useState<string | null>(null);
  const file = found && !found.missing ? found.text.replaceAll("\r\n", "\n") : null;
  const show = useCallback((text: string) => editor.current && replaceAll(editor.current, text), [editor]);
  const take = useCallback(
    (text: string) => {
      show(text);
      setNow(text);
      setBase(text);
      setTheirs(null);
    },
    [show],
  );
  // What the server says is up to two seconds old: only what is new in it tells of a change.
  const heard = useRef<string | null>(begun ? begun.base : file);
  useEffect(() => {
    if (file === null || file === heard.current) return;
    heard.current = file;
    const become = beneath(now, base, file);
    if (become === "follow") take(file);
    if (become === "saved") setBase(file);
    setTheirs(become === "conflict" ? file : null);
  }, [file, now, base, take]);
  useEffect(() => {
    if (isOwn) keepText(name, { text: now, base });
  }, [isOwn, name, now, base]);
  const saved = useCallback((text: string) => {
    setBase(text);
    setTheirs(null);
  }, []);
  return { now, setNow, base, setBase: saved, theirs, setTheirs, show, take };
}

interface EditorProps {
  first: string;
  label: string;
  readOnly: boolean;
  onText: (text: string) => void;
  editor: RefObject<EditorView | null>;
}

/** It is made once, with what was read at first; React does not draw its inside. */
function Editor({ first, label, readOnly, onText, editor }: EditorProps) {
  const place = useRef<HTMLDivElement>(null);
  const kept = useQueryClient();
  const begun = useRef({ text: first, label, readOnly, onText });
  useQuery(vocabulary);
  useEffect(() => {
    if (!place.current) return;
    const language = pythonText(() => kept.getQueryData(vocabulary.queryKey));
    const view = openEditor(place.current, { ...begun.current, language });
    editor.current = view;
    view.focus();
    return () => {
      editor.current = null;
      view.destroy();
    };
  }, [editor, kept]);
  return <div ref={place} className={shared.editor} />;
}

/** What the server finds wrong by reading, shortly after the last key; meanwhile what it found in the text before. */
function useSlips(now: string, asked: boolean, editor: RefObject<EditorView | null>) {
  const [settled] = useDebouncedValue(now, 350);
  const { data, error } = useQuery({ ...textProof(settled), enabled: asked, placeholderData: (before) => before });
  const slips = useMemo(() => data?.slips ?? [], [data]);
  useEffect(() => {
    if (editor.current) mark(editor.current, slips.map((each) => ({ ...each, where: "", value: "", allowed: "" })));
  }, [slips, editor]);
  return { slips, asked, checked: data !== undefined && settled === now, error };
}

interface SlipsProps extends ReturnType<typeof useSlips> {
  onGo: (line: number, column: number) => void;
}

function Slips({ slips, asked, checked, error, onGo }: SlipsProps) {
  if (error) return <Failure error={error} />;
  if (!asked) return <p className={classes.said}>It comes with the studio and is not changed here: copy it as your own.</p>;
  if (slips.length === 0)
    return (
      <p className={classes.said} role="status">
        {checked ? "Nothing is found wrong by reading." : "Reading …"}
      </p>
    );
  return (
    <ul className={shared.problems} aria-label="What is wrong in this text">
      {slips.map(({ line, column, what, remedy }) => (
        <li key={`${line} ${column} ${what}`}>
          <button type="button" className={classes.place} onClick={() => onGo(line, column)}>
            Line {line}
          </button>
          <span>
            {what}
            {remedy ? `; ${remedy}` : ""}
          </span>
        </li>
      ))}
    </ul>
  );
}

interface StandingProps {
  name: string;
  found: Manuscript | null;
  isSaved: boolean;
}

/** Which version runs, and what hinders this one. */
function Standing({ name, found, isSaved }: StandingProps) {
  if (found?.missing) return <Told title="The file cannot be read">{found.missing}. Shown is what was loaded of it.</Told>;
  if (found?.refused)
    return (
      <Told title={`The file does not load: ${found.refused}`}>Until that is mended, runs use the last version that did. Nothing of yours is lost.</Told>
    );
  if (!canWrite() && (found === null || found.own))
    return (
      <Told title="This browser cannot write files">
        Chromium, Chrome and Edge can, at the studio's own address on this machine or over HTTPS. Download the text here, or write in an editor of your
        own: the page follows the file. What is not saved is kept in this browser.
      </Told>
    );
  if (!found && isSaved)
    return (
      <Told title="The studio does not read this file yet">
        Save it into a folder that the studio was started with: <Code>studio --kinds FOLDER</Code>; there it is found by itself.{" "}
        <Code>studio new application {name}</Code> begins one with a test and a scenario.
      </Told>
    );
  return null;
}

const Told = ({ title, children }: { title: string; children: React.ReactNode }) => (
  <Alert color="yellow" variant="light" radius={0} py={6} icon={<Icon name="warning" />} title={title} role="status">
    {children}
  </Alert>
);

interface BeneathProps {
  name: string;
  theirs: string | null;
  now: string;
  onTheirs: (text: string) => void;
  onMine: () => void;
}

/** Both have changed: nothing is written until somebody decides, and each can be kept. */
function Beneath({ name, theirs, now, onTheirs, onMine }: BeneathProps) {
  if (theirs === null) return null;
  return (
    <Alert
      color="red"
      variant="outline"
      radius={0}
      py={8}
      role="alert"
      icon={<Icon name="warning" />}
      title="The file has changed on the disk. Your text is still here, and not saved."
    >
      <details>
        <summary>What stands in the file</summary>
        <pre className={classes.theirs} tabIndex={0} aria-label="What stands in the file">
          {theirs}
        </pre>
      </details>
      <Group gap="xs" mt="xs">
        <Button size="compact-xs" mih={24} variant="default" onClick={() => download(`${name}_mine.py`, now)}>
          Download mine
        </Button>
        {canWrite() ? (
          <Button size="compact-xs" mih={24} variant="default" onClick={onMine}>
            Save mine over it
          </Button>
        ) : null}
        <Button size="compact-xs" mih={24} variant="default" onClick={() => onTheirs(theirs)}>
          Take the file's, drop mine
        </Button>
      </Group>
    </Alert>
  );
}
