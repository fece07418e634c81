/** Files of the user's own, written by the browser itself (File System Access API): the server never takes a program from the network. */

const STORE = "files";

interface PickerWindow {
  showOpenFilePicker?: (asked: object) => Promise<FileSystemFileHandle[]>;
  showSaveFilePicker?: (asked: object) => Promise<FileSystemFileHandle>;
}

interface Permitted {
  requestPermission?: (asked: { mode: "readwrite" }) => Promise<PermissionState>;
}

const TYPES = [{ description: "Python", accept: { "text/x-python": [".py"] } }];
const pickers = () => window as unknown as PickerWindow;

/** Whether this browser can write files where its user allows it. */
export const canWrite = (): boolean => typeof pickers().showSaveFilePicker === "function";

/** Whether somebody has closed the dialog without choosing. */
export const isCancelled = (error: unknown): boolean => error instanceof Error && error.name === "AbortError";

/** Asks for the file that is there. */
export async function pickFile(): Promise<FileSystemFileHandle> {
  const [found] = (await pickers().showOpenFilePicker?.({ types: TYPES })) ?? [];
  if (!found) throw new Error("No file was chosen.");
  return found;
}

/** Asks where a new file is to lie. */
export async function pickPlace(suggestedName: string): Promise<FileSystemFileHandle> {
  const found = await pickers().showSaveFilePicker?.({ suggestedName, types: TYPES });
  if (!found) throw new Error("No place was chosen.");
  return found;
}

/** What stands in a file, with the line breaks of the page. */
export async function textIn(file: FileSystemFileHandle): Promise<string> {
  return (await raw(file)).replaceAll("\r\n", "\n");
}

/** Writes a text into a file, with the line breaks that it has. */
export async function write(file: FileSystemFileHandle, text: string): Promise<void> {
  const isWindows = (await raw(file)).includes("\r\n");
  const stream = await file.createWritable();
  await stream.write(isWindows ? text.replaceAll("\n", "\r\n") : text);
  await stream.close();
}

const raw = async (file: FileSystemFileHandle) => (await file.getFile()).text();

/** The file that was chosen before, if it may still be written; the browser asks its user. */
export async function chosenBefore(key: string): Promise<FileSystemFileHandle | null> {
  const found = await withStore<FileSystemFileHandle & Permitted>("readonly", (store) => store.get(key));
  if (!found) return null;
  const state = (await found.requestPermission?.({ mode: "readwrite" })) ?? "granted";
  return state === "granted" ? found : null;
}

/** Remembers a file, so that it is asked for once. */
export const remember = (key: string, file: FileSystemFileHandle): Promise<unknown> =>
  withStore("readwrite", (store) => store.put(file, key));

export const forget = (key: string): Promise<unknown> => withStore("readwrite", (store) => store.delete(key));

/** A browser that keeps nothing asks again: no more is lost. */
function withStore<Found>(mode: IDBTransactionMode, act: (store: IDBObjectStore) => IDBRequest): Promise<Found | null> {
  return new Promise((resolve) => {
    const opening = indexedDB.open("studio files", 1);
    opening.onupgradeneeded = () => opening.result.createObjectStore(STORE);
    opening.onerror = () => resolve(null);
    opening.onsuccess = () => {
      const done = (found: Found | null) => {
        opening.result.close();
        resolve(found);
      };
      try {
        const asked = act(opening.result.transaction(STORE, mode).objectStore(STORE));
        asked.onsuccess = () => done((asked.result as Found | undefined) ?? null);
        asked.onerror = () => done(null);
      } catch {
        done(null);
      }
    };
  });
}

/** Gives a text as a download, where nothing can be written. */
export function download(name: string, text: string): void {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([text], { type: "text/x-python" }));
  link.download = name;
  link.click();
  URL.revokeObjectURL(link.href);
}
