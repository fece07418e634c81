/** Saving: the browser writes the file that its user has chosen, and never over what it has not seen. */

import { useQueryClient } from "@tanstack/react-query";
import { useState } from "react";
import { chosenBefore, forget, isCancelled, pickFile, pickPlace, remember, textIn, write } from "../../api/disk";
import { notify, notifyError } from "../../ui/notify";

interface Asked {
  name: string;
  /** Where the server reads it; empty while it does not. */
  file: string;
  now: string;
  base: string;
  onSaved: (text: string) => void;
  /** The file has another text than was known. */
  onTheirs: (text: string) => void;
}

export function useSaving({ name, file, now, base, onSaved, onTheirs }: Asked) {
  const [pending, setPending] = useState(false);
  const [isSaved, setSaved] = useState(false);
  const kept = useQueryClient();
  const key = file || `new ${name}`;
  const put = async (seen: string, then?: () => void) => {
    const handle = await chosen(key, file, name);
    const there = await textIn(handle);
    if (there !== seen && there !== now && !(file === "" && there === "")) return onTheirs(there);
    await write(handle, now);
    await remember(key, handle);
    onSaved(now);
    setSaved(true);
    await kept.invalidateQueries({ queryKey: ["manuscript", "application", name] });
    await kept.invalidateQueries({ queryKey: ["kinds"] });
    then?.();
  };
  /** `over` is what stands in the file, as far as its author knows. */
  const save = async (over = base, then?: () => void) => {
    setPending(true);
    try {
      await put(over, then);
    } catch (error) {
      if (!isCancelled(error)) {
        await forget(key);
        notifyError(error instanceof Error ? error : new Error("The file could not be written."));
      }
    } finally {
      setPending(false);
    }
  };
  return { save, pending, isSaved };
}

/** The file that was chosen before, or is now. A file that is there is opened: to choose it as a place would empty it. */
async function chosen(key: string, file: string, name: string): Promise<FileSystemFileHandle> {
  const before = await chosenBefore(key);
  if (before) return before;
  if (!file) return pickPlace(`${name}.py`);
  notify("Choose the file once", `It is ${file}. The browser asks whether this page may write it.`);
  const found = await pickFile();
  const wanted = file.split(/[\\/]/).at(-1);
  if (found.name !== wanted) throw new Error(`That is ${found.name}. The studio reads ${file}: choose that one.`);
  return found;
}
