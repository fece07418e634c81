/** Completion of an application's text: what may stand where the cursor is, out of the server's vocabulary and the text itself. */

import type { Server } from "./run";

export type Vocabulary = Server["Vocabulary"];
type Word = Server["Word"];

/** One that is offered: its name, its unit or arguments, and what it means. */
export interface Offer {
  label: string;
  detail: string;
  info: string;
}

export interface Completion {
  /** Where what is typed already begins. */
  from: number;
  offers: Offer[];
}

const KIND = /Annotated\[\s*(Targets|Inbox|Outbox)\s*,\s*["'](\w*)$/;
const CHAIN = /((?:[A-Za-z_]\w*(?:\[[^\]]*\])*\.)*)(\w*)$/;
const FIELD = /^ {4}([A-Za-z_]\w*)\s*:\s*/;
const PORT = /^(?:Annotated\[\s*)?(\w+)(?:\s*,\s*["'](\w+)["'])?/;
const DECIDE = /^def decide\(\s*(\w+)[^,]*,\s*(\w+)[^,]*,\s*(\w+)/m;
const ASSIGNED = /^\s+([A-Za-z_][\w, ]*?)\s*=(?!=)\s*(.+?)\s*(?:#.*)?$/;
const LOOP = /^\s+for\s+(\w+)\s+in\s+([\w.]+)(?:\[[^\]]*\])?\s*:/;
const DEEPEST = 8;

/** What may stand at a place of the text; null where nothing is known. */
export function complete(text: string, at: number, vocabulary: Vocabulary): Completion | null {
  const line = text.slice(text.lastIndexOf("\n", at - 1) + 1, at);
  const kind = KIND.exec(line);
  if (kind) return { from: at - (kind[2] ?? "").length, offers: kindsOf(kind[1] ?? "", vocabulary) };
  if (isAside(line)) return null;
  const [, chain = "", begun = ""] = CHAIN.exec(line) ?? [];
  if (/^\d/.test(begun) || (!chain && !begun)) return null;
  const offers = chain ? offersOf(wordsOf(chain.slice(0, -1), outline(text, vocabulary))) : everything(text, vocabulary);
  return offers.length ? { from: at - begun.length, offers } : null;
}

/** Whether the place is in a comment or a text. */
function isAside(line: string): boolean {
  const rest = line.replace(/"[^"]*"|'[^']*'/g, "");
  return rest.includes("#") || /["']/.test(rest);
}

const kindsOf = (type: string, { ports }: Vocabulary): Offer[] =>
  ports.filter((each) => each.type === type).map(({ kind, meaning }) => ({ label: kind, detail: "", info: meaning }));

const offersOf = (words: readonly Word[]): Offer[] =>
  words.map(({ name, unit, meaning, is_row }) => ({ label: name, detail: unit ? `[${unit}]` : is_row ? "[…]" : "", info: meaning }));

/** Where no point stands before: functions, names of the contract, and what the text itself has. */
function everything(text: string, { functions, names, ports }: Vocabulary): Offer[] {
  const called = new Set(functions.map(({ name }) => name));
  const meanings = new Map(ports.filter(({ kind }) => !kind).map(({ type, meaning }) => [type, meaning]));
  const own = [...new Set([...(DECIDE.exec(text)?.slice(1) ?? []), ...aliases(text).keys()])];
  return [
    ...own.map((label) => ({ label, detail: "", info: "" })),
    ...functions.map(({ name, arguments: given, meaning }) => ({ label: name, detail: `(${given.join(", ")})`, info: meaning })),
    ...names.filter((name) => !called.has(name)).map((label) => ({ label, detail: "", info: meanings.get(label) ?? "" })),
  ];
}

// -- what names stand for ---------------------------------------------------------------------------------

interface Outline {
  roots: Map<string, Word>;
  aliases: Map<string, string>;
}

/** What `decide` is called with, and the names that it gives to parts of that. */
function outline(text: string, vocabulary: Vocabulary): Outline {
  const [parameters = "parameters", memory = "memory", sees = "sees"] = DECIDE.exec(text)?.slice(1) ?? [];
  const roots = new Map([
    [parameters, word(parameters, { words: [...fieldsOf(text, "Parameters")].map(setting) })],
    [memory, word(memory, { words: [...fieldsOf(text, "Memory")].map(setting) })],
    [sees, word(sees, { words: [...fieldsOf(text, "Sees")].map(([name, written]) => port(name, written, vocabulary)) })],
  ]);
  return { roots, aliases: aliases(text) };
}

const word = (name: string, more: Partial<Word> = {}): Word => ({ name, unit: "", meaning: "", is_row: false, words: [], ...more });

/** The fields of a class, each with what is written behind it. */
function fieldsOf(text: string, name: string): Map<string, string> {
  const lines = text.split("\n");
  const begin = lines.findIndex((line) => new RegExp(`^class ${name}\\b`).test(line));
  const found = new Map<string, string>();
  if (begin < 0) return found;
  let last = "";
  for (const line of lines.slice(begin + 1)) {
    if (/^\S/.test(line)) break;
    const field = FIELD.exec(line);
    if (field) found.set((last = field[1] ?? ""), line.slice(field[0].length));
    else if (last) found.set(last, `${found.get(last)}\n${line}`);
  }
  return found;
}

/** A setting, or something remembered, with the unit that stands in its text. */
function setting([name, written]: [string, string]): Word {
  const noted = /Annotated\[\s*\w+\s*,\s*["']([^"']*)["'](?:\s*,\s*["']([^"']*)["'])?/.exec(written);
  const unit = /unit=["']([^"']*)["']/.exec(written)?.[1] ?? noted?.[1] ?? "";
  const title = /title=["']([^"']*)["']/.exec(written)?.[1] ?? noted?.[2] ?? "";
  const more = /description=["']([^"']*)["']/.exec(written)?.[1];
  return word(name, { unit, meaning: more ? `${title}: ${more}` : title });
}

function port(name: string, written: string, { ports }: Vocabulary): Word {
  const [, type = "", kind = ""] = PORT.exec(written) ?? [];
  const found = ports.find((each) => each.type === type && each.kind === kind);
  return word(name, { meaning: found?.meaning ?? "", words: found?.words ?? [] });
}

/** Names that stand for something longer: `own = sees.own`, also several at once, and those of loops. */
function aliases(text: string): Map<string, string> {
  const found = new Map<string, string>();
  for (const line of text.split("\n")) {
    const loop = LOOP.exec(line);
    if (loop) found.set(loop[1] ?? "", `${loop[2]}[0]`);
    const [, left = "", right = ""] = ASSIGNED.exec(line) ?? [];
    const names = left.split(",").map((each) => each.trim());
    const values = right.split(",").map((each) => each.trim());
    if (left && names.length === values.length) names.forEach((name, i) => found.set(name, values[i] ?? ""));
  }
  return found;
}

const SEGMENT = /^([A-Za-z_]\w*)((?:\[[^\]]*\])*)$/;

/** What stands below a chain such as `sees.front.target[0]`. */
function wordsOf(chain: string, outline: Outline): readonly Word[] {
  const found = follow(chain, outline, 0);
  return found && !found.is_row ? found.words : [];
}

function follow(chain: string, outline: Outline, depth: number): Word | null {
  if (depth > DEEPEST) return null;
  const [first = "", ...rest] = chain.split(".");
  let now = begin(first, outline, depth);
  for (const segment of rest) {
    const [, name, index] = SEGMENT.exec(segment) ?? [];
    const next: Word | undefined = now && !now.is_row ? now.words.find((each) => each.name === name) : undefined;
    now = next ? taken(next, index) : null;
  }
  return now;
}

function begin(segment: string, outline: Outline, depth: number): Word | null {
  const [, name = "", index] = SEGMENT.exec(segment) ?? [];
  const root = outline.roots.get(name);
  if (root) return root;
  const value = outline.aliases.get(name);
  const found = value && value !== name ? follow(value, outline, depth + 1) : null;
  return found && taken(found, index);
}

/** One of a row where an index stands. */
const taken = (of: Word, index: string | undefined): Word => (index && of.is_row ? { ...of, is_row: false } : of);
