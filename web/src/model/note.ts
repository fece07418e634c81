/** Notes: a little of Markdown, and times that lead into the run. What they are made of is told here; nothing of a note is ever HTML. */

export type Piece =
  | { is: "text" | "strong" | "emphasis" | "code"; text: string }
  | { is: "link"; text: string; href: string }
  /** A time of the run [s]. */
  | { is: "time"; text: string; time: number };

export type Block =
  | { is: "paragraph" | "heading"; pieces: Piece[] }
  | { is: "list"; ordered: boolean; items: Piece[][] }
  | { is: "code"; text: string };

/** What stands out in a line; of a link only addresses of the web are followed. The order is that in which they are looked for. */
const PARTS = [
  { is: "code", form: /`([^`]+)`/ },
  { is: "link", form: /\[([^\]]+)\]\((https?:\/\/[^\s)]+)\)/ },
  { is: "strong", form: /\*\*([^*]+)\*\*/ },
  { is: "emphasis", form: /(?<![\w*])\*([^*\s](?:[^*]*[^*\s])?)\*(?![\w*])/ },
  { is: "time", form: /(?<![\w.])@(\d+(?:\.\d+)?)(?: ?s)?(?![\w.]*\w)/ },
] as const;

/** The pieces of a line. */
export function piecesOf(line: string): Piece[] {
  const found = PARTS.flatMap(({ is, form }) => {
    const match = form.exec(line);
    return match ? [{ is, match }] : [];
  }).toSorted((one, other) => one.match.index - other.match.index)[0];
  if (!found) return line ? [{ is: "text", text: line }] : [];
  const { is, match } = found;
  const before = line.slice(0, match.index);
  return [...(before ? [{ is: "text", text: before } as const] : []), pieceOf(is, match), ...piecesOf(line.slice(match.index + match[0].length))];
}

function pieceOf(is: (typeof PARTS)[number]["is"], [whole, first = "", second = ""]: RegExpExecArray): Piece {
  if (is === "link") return { is, text: first, href: second };
  if (is === "time") return { is, text: whole, time: Number(first) };
  return { is, text: first };
}

const ITEM = /^\s*(?:[-*]|(\d+)[.)])\s+(.*)$/;

/** The blocks of a note. */
export function blocksOf(note: string): Block[] {
  const made: Block[] = [];
  let code: string[] | undefined;
  let open = false;
  for (const line of note.split(/\r?\n/)) {
    if (line.startsWith("```")) {
      if (code) made.push({ is: "code", text: code.join("\n") });
      code = code ? undefined : [];
      open = false;
    } else if (code) code.push(line);
    else open = taken(made, line, open);
  }
  if (code) made.push({ is: "code", text: code.join("\n") });
  return made;
}

/** Takes a line; whether the next one goes on with what it is. */
function taken(made: Block[], line: string, open: boolean): boolean {
  const [, number, item] = ITEM.exec(line) ?? [];
  const [, heading] = /^#{1,6}\s+(.*)$/.exec(line) ?? [];
  const last = open ? made.at(-1) : undefined;
  if (line.trim() === "") return false;
  if (heading !== undefined) {
    made.push({ is: "heading", pieces: piecesOf(heading) });
    return false;
  }
  if (item !== undefined) {
    const ordered = number !== undefined;
    if (last?.is === "list" && last.ordered === ordered) last.items.push(piecesOf(item));
    else made.push({ is: "list", ordered, items: [piecesOf(item)] });
  } else if (last?.is === "paragraph") last.pieces.push({ is: "text", text: " " }, ...piecesOf(line));
  else made.push({ is: "paragraph", pieces: piecesOf(line) });
  return true;
}

/** A note in a line, as tables have it. */
export function plain(note: string): string {
  const lines = blocksOf(note).flatMap((block) =>
    block.is === "code" ? [block.text] : block.is === "list" ? block.items.map(told) : [told(block.pieces)],
  );
  return lines.join("; ").replace(/\s+/g, " ").trim();
}

const told = (pieces: readonly Piece[]): string => pieces.map(({ text }) => text).join("");
