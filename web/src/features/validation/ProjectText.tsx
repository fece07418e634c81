/** The project as text, with its problems at their lines. */

import { Button, Text } from "@mantine/core";
import type { EditorView } from "@codemirror/view";
import { useQuery } from "@tanstack/react-query";
import { useBlocker } from "@tanstack/react-router";
import { useEffect, useRef, useState } from "react";
import { usePutText, validation } from "../../api/validations";
import { Refusal } from "../../api/client";
import type { Project } from "../../model/validation";
import { LeaveQuestion } from "../../ui/LeaveQuestion";
import { ProblemList } from "../../ui/Problems";
import { useSaveKey } from "../../ui/shortcut";
import { mark, openEditor, replaceAll } from "../../ui/editor";
import classes from "./Validation.module.css";

/** How often somebody else's change is looked for while the text is open [ms]. */
const LOOK = 5000;

const PLACE = /, line (\d+), column (\d+)/;

export function ProjectText({ project }: { project: Project }) {
  const place = useRef<HTMLDivElement>(null);
  const editor = useRef<EditorView>(undefined);
  const first = useRef(project.text);
  const [read, setRead] = useState({ text: project.text, digest: project.digest });
  const [now, setNow] = useState(project.text);
  const put = usePutText(project.name);
  const dirty = now !== read.text;
  useQuery({ ...validation(project.name), refetchInterval: LOOK });
  const isOther = project.digest !== read.digest;
  useEffect(() => {
    if (!place.current) return;
    const view = openEditor(place.current, { text: first.current, label: "Text of project.yaml", onText: setNow });
    editor.current = view;
    return () => view.destroy();
  }, []);
  // Changed by a form of another tab: what was not touched here follows.
  useEffect(() => {
    if (!isOther || dirty || !editor.current) return;
    replaceAll(editor.current, project.text);
    setRead({ text: project.text, digest: project.digest });
  }, [isOther, dirty, project]);
  const problems = put.error instanceof Refusal ? put.error.problems : [];
  useEffect(() => {
    const found = problems.map((each) => {
      const [, line, column] = PLACE.exec(each.where) ?? [];
      return { ...each, line: line ? Number(line) : null, column: column ? Number(column) : null };
    });
    if (editor.current) mark(editor.current, found);
  }, [put.error]);
  const save = (then?: () => void, otherwise?: () => void) => {
    if (!dirty || put.isPending) return;
    put.mutate(
      { text: now, digest: read.digest },
      {
        onSuccess: ({ digest }) => {
          setRead({ text: now, digest });
          then?.();
        },
        onError: () => otherwise?.(),
      },
    );
  };
  useSaveKey(() => save());
  // Another tab of the project does not lose it: this one stays as it is.
  const leave = useBlocker({
    shouldBlockFn: ({ current, next }) => dirty && next.pathname !== current.pathname,
    enableBeforeUnload: () => dirty,
    withResolver: true,
  });
  return (
    <section className={classes.card} aria-label="Text of the project">
      <div className={classes.row}>
        <Button size="xs" disabled={!dirty} loading={put.isPending} onClick={() => save()}>
          Save
        </Button>
        <Text size="xs" c="dimmed" role="status">
          {dirty ? "not saved" : "saved"}
          {dirty && isOther && !put.isPending ? "; the project has been changed elsewhere meanwhile" : ""}
        </Text>
      </div>
      {put.error ? (
        <div role="alert">
          <Text size="sm" c="red">
            {put.error.message} Your text is still here, and not saved.
          </Text>
          <ProblemList problems={problems} />
        </div>
      ) : null}
      <div ref={place} className={classes.editor} />
      <LeaveQuestion leave={leave} pending={put.isPending} onSave={() => save(leave.proceed, leave.reset)} canSave />
    </section>
  );
}
