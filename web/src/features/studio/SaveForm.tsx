/** What was changed in the form goes into its file, or into another one; both can be taken back. */

import { Button, Tooltip } from "@mantine/core";
import { useQuery } from "@tanstack/react-query";
import { useNavigate } from "@tanstack/react-router";
import { useRef, useState } from "react";
import { scenarios } from "../../api/queries";
import { isStale, useCopy, useSaveForm, useTakeBackSave } from "../../api/scenarios";
import { withoutSaved } from "../../model/form";
import type { Changes, Problem, Server } from "../../model/run";
import { freeName } from "../../model/scenario";
import { draftKey } from "../../ui/memory";
import { NameDialog, type Naming } from "../../ui/NameDialog";
import { closeNotice, notify, notifyError, PRESSED } from "../../ui/notify";
import { useSaveKey } from "../../ui/shortcut";
import type { Draft } from "./draft";
import type { Form } from "./form";

interface Props {
  id: string;
  form: Form;
  draft: Draft;
  update: (part: Partial<Draft>) => void;
}

/** The buttons; they are there while something is changed. */
export function SaveForm({ id, form, draft, update, saving }: Props & { saving: Saving }) {
  const [naming, setNaming] = useState(false);
  const rows = useQuery(scenarios).data ?? [];
  const why = saving.sealed ? "Its file may be read only: save as another one" : form.blocked;
  return (
    <>
      <Tooltip label={why || "Write the changes into the scenario's file (Ctrl+S)"} multiline maw={320}>
        <span>
          <Button
            size="compact-xs"
            variant="light"
            disabled={why !== ""}
            loading={saving.pending}
            onClick={() => void saving.save()}
          >
            Save
          </Button>
        </span>
      </Tooltip>
      <Button size="compact-xs" variant="subtle" disabled={form.blocked !== ""} onClick={() => setNaming(true)}>
        Save as …
      </Button>
      {naming ? (
        <SaveAs
          id={id}
          title={form.title ?? id}
          names={rows.map((row) => row.id)}
          draft={draft}
          update={update}
          onClose={() => setNaming(false)}
        />
      ) : null}
    </>
  );
}

export type Saving = ReturnType<typeof useSaving>;

/** Saving over the file, with a notice by which it is taken back, also when the buttons are not there any more. */
export function useSaving({ id, form, draft, update }: Props) {
  const put = useSaveForm(id);
  const takeBack = useTakeBackSave(id);
  const sealed = (useQuery(scenarios).data ?? []).find((row) => row.id === id)?.sealed ?? false;
  const latest = useRef(draft.changes);
  latest.current = draft.changes;
  const pending = put.isPending || takeBack.isPending;
  const undo = async (done: Server["Patched"], set: Changes) => {
    closeNotice(done.digest);
    await takeBack.mutateAsync(done);
    // In the form they stay changed.
    update({ changes: { ...set, ...latest.current } });
  };
  const saved = (done: Server["Patched"], set: Changes) => {
    update({ changes: withoutSaved(latest.current, set) });
    notify(
      `Saved in ${id}.yaml`,
      <Button size="compact-xs" variant="light" onClick={() => undo(done, set).catch(notifyError)}>
        Undo
      </Button>,
      "teal",
      { id: done.digest, autoClose: PRESSED },
    );
  };
  const save = async () => {
    const set = draft.changes;
    try {
      saved(await put.mutateAsync({ set, digest: form.digest }), set);
    } catch (error) {
      notifyError(isStale(error) ? withWords(error as Error) : (error as Error));
    }
  };
  // Whoever presses it right after the last key does not wait for the check: the server refuses what is wrong, and says why.
  // Where nothing is changed there is nothing to save, and the page itself is never meant.
  useSaveKey(() => {
    if (Object.keys(draft.changes).length > 0 && !sealed && !pending) void save();
  });
  return { save, pending, sealed };
}

/** Somebody else was here: what is safe, and what to do. */
const withWords = (error: Error & { problems?: Problem[] }): Error =>
  Object.assign(new Error(`${error.message} Nothing was saved; your changes are still here. Save again to write them over it.`), {
    problems: error.problems ?? [],
  });

interface SaveAsProps extends Pick<Props, "id" | "draft" | "update"> {
  title: string;
  names: readonly string[];
  onClose: () => void;
}

/** The form as a new file, which is shown then and goes on in the same line of runs; the old file stays as it was. */
function SaveAs({ id, title, names, draft, update, onClose }: SaveAsProps) {
  const copy = useCopy();
  const navigate = useNavigate();
  const answer = ({ name, title: other }: Naming) =>
    copy.mutate(
      { id, name, title: other, set: draft.changes },
      {
        onSuccess: ({ scenario }) => {
          onClose();
          sessionStorage.setItem(draftKey(scenario), JSON.stringify({ ...draft, changes: {} }));
          update({ changes: {} });
          notify(`Saved as ${scenario}.yaml`, `${id}.yaml is as it was.`);
          void navigate({ to: "/studio/$scenario", params: { scenario }, search: {} });
        },
      },
    );
  return (
    <NameDialog
      heading="Save as another scenario"
      action="Save"
      name={freeName(id, names)}
      title={title}
      taken={names}
      error={copy.error}
      pending={copy.isPending}
      onClose={onClose}
      onName={answer}
    />
  );
}
