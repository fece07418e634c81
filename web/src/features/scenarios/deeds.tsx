/** Rename, duplicate, delete and bring back: each asks for a name where it needs one, and can be taken back. */

import { Button } from "@mantine/core";
import { useRef, useState } from "react";
import { isStale, isTaken, useCopy, useDeleteScenario, useRename, useRestore } from "../../api/scenarios";
import { type Deleted, freeName, plainName, type ScenarioRow } from "../../model/scenario";
import { moveMemory } from "../../ui/memory";
import { NameDialog, type Naming } from "../../ui/NameDialog";
import { closeNotice, notify, notifyError, PRESSED } from "../../ui/notify";
import type { useImports } from "./imports";
import type { Deed } from "./RowMenu";

type Question = { deed: "rename" | "duplicate"; row: ScenarioRow } | { deed: "restore"; entry: Deleted };

export function useDeeds(rows: readonly ScenarioRow[]) {
  const [question, setQuestion] = useState<Question>();
  const [rename, copy, remove, back] = [useRename(), useCopy(), useDeleteScenario(), useRestore()];
  const close = () => {
    for (const each of [rename, copy, back]) each.reset();
    setQuestion(undefined);
  };
  const taken = (scenario: string) => notify("Imported", `${scenario}.yaml is among the scenarios.`);
  const restore = (entry: Deleted, name?: string) =>
    back.mutate(
      { entry: entry.id, ...(name ? { name } : {}) },
      {
        onSuccess: ({ scenario }) => {
          close();
          notify("Brought back", `${scenario}.yaml is among the scenarios again.`);
        },
        onError: (error) => (isTaken(error) ? setQuestion({ deed: "restore", entry }) : notifyError(error)),
      },
    );
  const undo = useUndo(restore);
  const doomed = useRef(new Set<string>());
  const erase = (row: ScenarioRow) => {
    // A key that is held down does not ask twice.
    if (doomed.current.has(row.id)) return;
    doomed.current.add(row.id);
    remove.mutate(row, {
      onSuccess: undo,
      onError: (error) => notifyError(isStale(error) ? withWords(error, row) : error),
      onSettled: () => doomed.current.delete(row.id),
    });
  };
  const begin = (deed: Deed, row: ScenarioRow) => {
    if (deed === "delete") erase(row);
    else setQuestion({ deed, row });
  };
  const answer = ({ name, title }: Naming) => {
    if (question?.deed === "restore") restore(question.entry, name);
    else if (question?.deed === "duplicate") copy.mutate({ id: question.row.id, name, title }, { onSuccess: close });
    else if (question)
      rename.mutate(
        // Whoever was told that the file has changed, and asks again, means the file as it is now.
        { ...question.row, ...rows.find(({ id }) => id === question.row.id), name, title },
        {
          onSuccess: ({ scenario }) => {
            moveMemory(question.row.id, scenario);
            close();
          },
        },
      );
  };
  const asked = question && { rename, duplicate: copy, restore: back }[question.deed];
  return {
    begin,
    restore: (entry: Deleted) => restore(entry),
    restoring: back.isPending,
    taken,
    question,
    answer,
    close,
    error: asked?.error ?? null,
    pending: asked?.isPending ?? false,
  };
}

/** Somebody else was here: what is safe, and what to do. */
const withWords = (error: Error, row: ScenarioRow): Error =>
  Object.assign(new Error(`${row.file} was changed by somebody else and is not deleted; the list shows it as it is now.`), {
    problems: (error as { problems?: [] }).problems ?? [],
  });

/** Tells that a scenario was deleted, with the way back at hand. */
function useUndo(restore: (entry: Deleted) => void) {
  return (entry: Deleted) => {
    const back = () => {
      closeNotice(entry.id);
      restore(entry);
    };
    notify(
      `Deleted ${entry.scenario}`,
      <Button size="compact-xs" variant="light" onClick={back}>
        Undo
      </Button>,
      "gray",
      { id: entry.id, autoClose: PRESSED },
    );
  };
}

interface AskedProps {
  deeds: ReturnType<typeof useDeeds>;
  imports: ReturnType<typeof useImports>;
  names: readonly string[];
}

/** The question that is open now, if any. */
export function Asked({ deeds, imports, names }: AskedProps) {
  const { question } = deeds;
  if (imports.taken) {
    const { file, text } = imports.taken;
    return (
      <NameDialog
        key={file}
        heading={`There is a scenario ${plainName(file)} already`}
        action="Import under this name"
        name={freeName(plainName(file), names)}
        taken={names}
        error={null}
        pending={imports.pending}
        onClose={imports.forgetTaken}
        onName={({ name }) => void imports.send(name, text)}
      />
    );
  }
  if (!question) return null;
  const dialog = { error: deeds.error, pending: deeds.pending, onClose: deeds.close, onName: deeds.answer };
  if (question.deed === "restore") {
    const { scenario } = question.entry;
    return (
      <NameDialog
        {...dialog}
        heading={`There is another scenario ${scenario} now`}
        action="Bring it back under this name"
        name={freeName(scenario, names)}
        taken={names}
      />
    );
  }
  const { id, title, problem } = question.row;
  const readable = problem === null;
  return question.deed === "rename" ? (
    <NameDialog
      {...dialog}
      heading={`Rename ${title}`}
      action="Rename"
      name={id}
      title={readable ? title : undefined}
      taken={names.filter((name) => name !== id)}
    />
  ) : (
    <NameDialog
      {...dialog}
      heading={`Duplicate ${title}`}
      action="Duplicate"
      name={freeName(id, names)}
      title={readable ? title : undefined}
      taken={names}
    />
  );
}
