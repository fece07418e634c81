/** Files that were dropped or chosen, on their way into the folder of scenarios. */

import { useState } from "react";
import { isTaken, LARGEST, useImport } from "../../api/scenarios";
import type { Problem } from "../../model/run";

/** A file that was not taken, and why. */
export interface Refused {
  file: string;
  text: string;
  error: Error & { problems?: Problem[] };
}

/** Takes files one after the other; a name that is taken is asked for anew, other refusals stay until they are waved away. */
export function useImports(onTaken: (scenario: string) => void) {
  const take = useImport();
  const [refused, setRefused] = useState<readonly Refused[]>([]);
  const [taken, setTaken] = useState<Refused>();
  const send = async (name: string, text: string) => {
    try {
      onTaken((await take.mutateAsync({ name, text })).scenario);
      setTaken(undefined);
    } catch (caught) {
      const one: Refused = { file: name, text, error: caught as Error };
      if (isTaken(caught)) setTaken(one);
      else setRefused((others) => [...others.filter(({ file }) => file !== name), one]);
    }
  };
  const files = async (chosen: readonly File[]) => {
    setRefused([]);
    for (const file of chosen) {
      const text = await content(file);
      if (typeof text === "string") await send(file.name, text);
      else setRefused((others) => [...others, { file: file.name, text: "", error: text }]);
    }
  };
  return {
    files,
    send,
    pending: take.isPending,
    refused,
    dismiss: (file: string) => setRefused((others) => others.filter((other) => other.file !== file)),
    /** The file whose name is taken. */
    taken,
    forgetTaken: () => setTaken(undefined),
  };
}

/** The text of a file, or why it is none. */
export async function content(file: File): Promise<string | Refused["error"]> {
  const none = (what: string, allowed: string) =>
    Object.assign(new Error(`${file.name} is no scenario file.`), {
      problems: [{ where: file.name, what, value: "", allowed, remedy: "" }],
    });
  if (file.size > LARGEST) return none("is too large for a scenario", `at most ${LARGEST} bytes`);
  try {
    // A byte order mark is part of the file.
    return new TextDecoder("utf-8", { fatal: true, ignoreBOM: true }).decode(await file.arrayBuffer());
  } catch {
    return none("is not a text", "UTF-8");
  }
}
