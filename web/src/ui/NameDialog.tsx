/** Asks for the name of a file, and for a title where there is one; what is wrong is told while it is typed. */

import { Button, Group, Modal, Stack, Text, TextInput } from "@mantine/core";
import { type FormEvent, type ReactNode, useState } from "react";
import type { Problem } from "../model/run";
import { nameProblem, plainName } from "../model/scenario";
import { Failure } from "./State";

export interface Naming {
  name: string;
  /** Undefined: it is not asked for, or stays as it was. */
  title: string | undefined;
}

interface Props {
  heading: string;
  /** What the button does. */
  action: string;
  name: string;
  /** Undefined where no title is asked for. */
  title?: string | undefined;
  /** Names that are taken by others. */
  taken: readonly string[];
  error: (Error & { problems?: Problem[] }) | null;
  pending: boolean;
  onClose: () => void;
  onName: (naming: Naming) => void;
  children?: ReactNode;
}

/** Open for as long as it is there. */
export function NameDialog({ heading, action, taken, error, pending, onClose, onName, children, ...given }: Props) {
  const [name, setName] = useState(given.name);
  const [title, setTitle] = useState(given.title);
  const wrong = nameProblem(name, taken);
  const submit = (event: FormEvent) => {
    event.preventDefault();
    if (wrong) return;
    const changed = title?.trim();
    onName({ name: plainName(name), title: changed && changed !== given.title ? changed : undefined });
  };
  return (
    <Modal opened onClose={onClose} title={heading} size="md">
      <form onSubmit={submit}>
        <Stack gap="sm">
          {children}
          <NameEntries name={name} onName={setName} wrong={wrong} title={title} onTitle={setTitle} autoFocus />
          {error ? <Failure error={error} /> : null}
          <Group justify="flex-end" gap="xs">
            <Button size="xs" variant="default" onClick={onClose}>
              Cancel
            </Button>
            <Button size="xs" type="submit" loading={pending} disabled={wrong !== ""}>
              {action}
            </Button>
          </Group>
        </Stack>
      </form>
    </Modal>
  );
}

interface EntriesProps {
  name: string;
  onName: (name: string) => void;
  /** What is wrong with the name; "" when nothing is. */
  wrong: string;
  /** Undefined where none is asked for. */
  title: string | undefined;
  onTitle: (title: string) => void;
  /** Whether the name is where typing begins. */
  autoFocus?: boolean;
  /** Whether it names a folder, and not a file. */
  folder?: boolean;
}

/** Title and file name of a scenario, or the folder of a project. */
export function NameEntries({ name, onName, wrong, title, onTitle, autoFocus = false, folder = false }: EntriesProps) {
  return (
    <>
      {title === undefined ? null : (
        <TextInput size="sm" label="Title" maxLength={120} value={title} onChange={(event) => onTitle(event.currentTarget.value)} />
      )}
      <TextInput
        size="sm"
        label={folder ? "Folder" : "File name"}
        data-autofocus={autoFocus || undefined}
        rightSection={
          <Text size="sm" c="dimmed" span>
            {folder ? "/" : ".yaml"}
          </Text>
        }
        rightSectionWidth={52}
        value={name}
        error={wrong || undefined}
        onChange={(event) => onName(event.currentTarget.value)}
      />
    </>
  );
}
