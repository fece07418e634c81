/** The text of an application as it is written in the page: what the browser keeps of it until it is saved, and its names. */

export interface Kept {
  text: string;
  /** What stood in the file when this was begun. */
  base: string;
}

const key = (name: string): string => `source ${name}`;
const NAME = /^[a-z][a-z0-9_]*$/;
// Words of Python that no file can be called.
const RESERVED = new Set(
  "and as assert async await break class continue def del elif else except finally for from global if import in is lambda nonlocal not or pass raise return try while with yield".split(" "),
);

/** What was written and not saved; null when there is nothing. */
export function keptText(name: string): Kept | null {
  try {
    const found: unknown = JSON.parse(localStorage.getItem(key(name)) ?? "null");
    return isKept(found) ? found : null;
  } catch {
    return null;
  }
}

const isKept = (found: unknown): found is Kept =>
  typeof found === "object" && found !== null && typeof (found as Kept).text === "string" && typeof (found as Kept).base === "string";

/** Keeps what is not saved, and forgets what is. */
export function keepText(name: string, { text, base }: Kept): void {
  if (text === base) localStorage.removeItem(key(name));
  else localStorage.setItem(key(name), JSON.stringify({ text, base }));
}

/** What is wrong with the name of an application; empty when nothing is. */
export function applicationNameProblem(name: string, taken: readonly string[]): string {
  if (!NAME.test(name) || RESERVED.has(name) || name.startsWith("test_"))
    return "Small letters, digits and _, a letter first: it becomes the name of a Python file.";
  return taken.includes(name) ? `There is an application ${name} already.` : "";
}

/** A start under the name of what begins with it, as the command writes it: two of one title could not be told apart in a list. */
export function entitled(start: string, name: string): string {
  const title = (name[0] ?? "").toUpperCase() + name.slice(1).replaceAll("_", " ");
  return start.replace(/^"""Mine:/, () => `"""${title}:`).replace(/^TITLE = .*$/m, () => `TITLE = "${title}"`);
}

/** What becomes of a text that is open when the file has another: it follows, is saved already, or both are kept until somebody decides. */
export function beneath(now: string, base: string, file: string): "same" | "follow" | "saved" | "conflict" {
  if (file === base) return "same";
  if (now === file) return "saved";
  return now === base ? "follow" : "conflict";
}
