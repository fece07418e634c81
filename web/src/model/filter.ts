/**
 * Which runs of a table are shown, said in words: `headway < 0.8 and min_ttc > 1.2`, `failed or tag = wet`.
 *
 *   some of     = all of { "or" all of }
 *   all of      = one { ["and"] one }
 *   one         = "not" one | "(" some of ")" | name comparison value | word
 *   comparison  = "<" | "<=" | ">" | ">=" | "=" | "!="
 *
 * A word alone is looked for in everything that stands in a row. A metric of a run that ended early is not compared: it has no
 * place among those of whole runs, and so it is neither less nor more.
 */

import type { Json, ListedRun } from "./run";
import { type Column, isUnranked } from "./table";
import { formatValue } from "./units";

type Test = (run: ListedRun) => boolean;

/** What is wrong with an expression, where it begins, and what may stand there. */
export interface Wrong {
  at: number;
  problem: string;
}

/** A comparison that every run has to pass which is shown, and where it stands in the text. */
export interface Bound {
  column: string;
  sign: string;
  value: number;
  from: number;
  to: number;
}

export type Filter = { test: Test; bounds: readonly Bound[]; wrong?: undefined } | { test?: undefined; bounds?: undefined; wrong: Wrong };

class Mistake extends Error {
  constructor(
    readonly at: number,
    message: string,
  ) {
    super(message);
  }
}

/** The filter that an expression means; `columns` are what may be named, `textOf` what a word is looked for in. */
export function filterOf(text: string, columns: readonly Column[], textOf: (run: ListedRun) => string): Filter {
  try {
    const reader = new Reader(tokensOf(text), columns, textOf);
    const test = reader.all();
    return { test, bounds: reader.bounds };
  } catch (error) {
    if (error instanceof Mistake) return { wrong: { at: error.at, problem: error.message } };
    throw error;
  }
}

interface Token {
  kind: "word" | "text" | "sign";
  value: string;
  at: number;
  /** Where it ends. */
  to: number;
}

const TOKEN = /\s*(?:"([^"]*)"|(<=|>=|!=|[<>=()])|([^\s"<>=!()]+))/y;

function tokensOf(text: string): Token[] {
  const found: Token[] = [];
  TOKEN.lastIndex = 0;
  let at = 0;
  while (text.slice(at).trim() !== "") {
    TOKEN.lastIndex = at;
    const hit = TOKEN.exec(text);
    const start = at + (text.slice(at).length - text.slice(at).trimStart().length);
    if (!hit) throw new Mistake(start, text[start] === '"' ? "The quotation mark is not closed." : `“${text[start]}” means nothing here.`);
    const [, quoted, sign, word] = hit;
    found.push({ kind: quoted !== undefined ? "text" : sign ? "sign" : "word", value: quoted ?? sign ?? word ?? "", at: start, to: TOKEN.lastIndex });
    at = TOKEN.lastIndex;
  }
  return found;
}

const COMPARISONS = new Set(["<", "<=", ">", ">=", "=", "!="]);

/** Reads tokens from the left. */
class Reader {
  /** Comparisons that are not within anything else. */
  bounds: Bound[] = [];
  private next = 0;
  private depth = 0;

  constructor(
    private readonly tokens: readonly Token[],
    private readonly columns: readonly Column[],
    private readonly textOf: (run: ListedRun) => string,
  ) {}

  /** The whole expression; an empty one lets everything through. */
  all(): Test {
    if (this.tokens.length === 0) return () => true;
    const found = this.someOf();
    const rest = this.now;
    if (this.depth > 0) this.bounds = [];
    if (rest) throw new Mistake(rest.at, `“${rest.value}” closes nothing.`);
    return found;
  }

  private get now(): Token | undefined {
    return this.tokens[this.next];
  }

  private is(word: string): boolean {
    const { now } = this;
    return now !== undefined && now.kind !== "text" && now.value.toLowerCase() === word;
  }

  private someOf(): Test {
    const found = [this.allOf()];
    while (this.is("or")) {
      this.next += 1;
      this.depth += 1; // and stays: what stands beside an "or" binds nobody
      found.push(this.allOf());
    }
    return (run) => found.some((test) => test(run));
  }

  private allOf(): Test {
    const found = [this.one()];
    while (this.now && !this.is("or") && !this.is(")")) {
      if (this.is("and")) this.next += 1;
      found.push(this.one());
    }
    return (run) => found.every((test) => test(run));
  }

  private one(): Test {
    const { now } = this;
    if (!now) throw new Mistake(this.end, "Something is missing at the end: a word, or a comparison such as headway < 0.8.");
    if (this.is("and") || this.is("or") || this.is(")"))
      throw new Mistake(now.at, `Before “${now.value}” a word or a comparison is missing.`);
    this.next += 1;
    if (now.value.toLowerCase() === "not" && now.kind === "word") {
      const before = this.bounds.length;
      const inner = this.one();
      this.bounds.length = before;
      return (run) => !inner(run);
    }
    if (now.kind === "sign" && now.value === "(") return this.bracket(now);
    if (now.kind === "sign") throw new Mistake(now.at, `Before “${now.value}” stands no name.`);
    const sign = this.now;
    if (sign?.kind === "sign" && COMPARISONS.has(sign.value)) return this.comparison(now, sign);
    const needle = now.value.toLowerCase();
    return (run) => this.textOf(run).includes(needle);
  }

  private bracket(open: Token): Test {
    const [before, depth] = [this.bounds.length, this.depth];
    const inner = this.someOf();
    this.bounds.length = before;
    this.depth = depth;
    if (!this.is(")")) throw new Mistake(open.at, "This bracket is not closed.");
    this.next += 1;
    return inner;
  }

  private comparison(name: Token, sign: Token): Test {
    const column = columnOf(name, this.columns);
    this.next += 1;
    const value = this.now;
    if (!value || value.kind === "sign") throw new Mistake(value?.at ?? this.end, `After “${sign.value}” a value is missing.`);
    this.next += 1;
    if (Number.isFinite(Number(value.value)))
      this.bounds.push({ column: column.id, sign: sign.value, value: Number(value.value), from: name.at, to: value.to });
    return compared(column, sign.value, value);
  }

  private get end(): number {
    return this.tokens.at(-1)?.to ?? 0;
  }
}

/** Names of a column: all of it, its last part, and what its head says. */
export const namesOf = ({ id, group, name, title }: Column): string[] => {
  if (group === "channels") return [id.slice(id.indexOf(":") + 1).toLowerCase()]; // its last part is only which number it is
  const path = id.slice(id.indexOf(":") + 1);
  const names = [path, path.slice(path.lastIndexOf(".") + 1), name, title, ...(id === "tags" ? ["tag"] : [])];
  return names.map((each) => each.toLowerCase().replace(/\s+/g, "_"));
};

/** The shortest name by which an expression may call a column. */
export function shortest(column: Column, columns: readonly Column[]): string {
  const [path = column.id, last = path] = namesOf(column);
  const isOthers = columns.some((other) => other !== column && namesOf(other).includes(last));
  return isOthers ? path : last;
}

/** An expression that also keeps a column between two values, instead of whatever it has said of that; without them it says nothing. */
export function withRange(text: string, bounds: readonly Bound[], column: Column, columns: readonly Column[], range?: readonly [number, number]): string {
  const own = bounds.filter((bound) => bound.column === column.id).sort((one, other) => other.from - one.from);
  const rest = own.reduce((left, { from, to }) => joined(left.slice(0, from), left.slice(to)), text);
  if (!range) return rest;
  const name = shortest(column, columns);
  const [low, high] = range.map((each) => Number(each.toPrecision(4)));
  return joined(rest, `${name} >= ${low} and ${name} <= ${high}`);
}

/** Two pieces with one "and" between them, or what there is of them. */
function joined(left: string, right: string): string {
  const pieces = [left.replace(/(^|\s)and\s*$/i, ""), right.replace(/^\s*and(\s|$)/i, "")].map((each) => each.trim()).filter(Boolean);
  return pieces.join(" and ");
}

function columnOf({ value, at }: Token, columns: readonly Column[]): Column {
  const wanted = value.toLowerCase();
  const found = columns.filter((column) => namesOf(column).includes(wanted));
  const exact = found.find(({ id }) => id.slice(id.indexOf(":") + 1).toLowerCase() === wanted);
  if (exact) return exact;
  if (found.length > 1)
    throw new Mistake(at, `“${value}” may be ${found.map(({ id }) => id.slice(id.indexOf(":") + 1)).join(" or ")}.`);
  if (found[0]) return found[0];
  const near = columns.flatMap((column) => namesOf(column).slice(0, 2)).find((name) => distance(name, wanted) <= 2);
  throw new Mistake(at, `There is no “${value}” in this table${near ? `; did you mean ${near}?` : "."}`);
}

/** How many letters have to be exchanged, left out or put in (Levenshtein 1966). */
function distance(one: string, other: string): number {
  let row = Array.from({ length: other.length + 1 }, (_, i) => i);
  for (let i = 1; i <= one.length; i += 1) {
    const above = row;
    row = [i];
    for (let j = 1; j <= other.length; j += 1)
      row.push(Math.min((above[j] as number) + 1, (row[j - 1] as number) + 1, (above[j - 1] as number) + (one[i - 1] === other[j - 1] ? 0 : 1)));
  }
  return row[other.length] as number;
}

function compared(column: Column, sign: string, { value: text, at }: Token): Test {
  const wanted = Number(text);
  const isNumber = text.trim() !== "" && Number.isFinite(wanted);
  if (sign === "=" || sign === "!=") {
    const same = (run: ListedRun) => equals(own(column, run), text, isNumber ? wanted : undefined);
    return (run) => known(column, run) && same(run) === (sign === "=");
  }
  if (!isNumber) throw new Mistake(at, `“${sign}” compares numbers, and “${text}” is none.`);
  const holds = {
    "<": (has: number) => has < wanted,
    "<=": (has: number) => has <= wanted,
    ">": (has: number) => has > wanted,
    ">=": (has: number) => has >= wanted,
  }[sign] as (has: number) => boolean;
  return (run) => {
    const has = own(column, run);
    return typeof has === "number" && known(column, run) && holds(has);
  };
}

const own = (column: Column, run: ListedRun): Json | undefined => column.value(run);

/** Whether the run has a value that may be compared. */
const known = (column: Column, run: ListedRun) => !isUnranked(column, run);

/** Numbers by value, a list when it holds it, the rest by its text, whatever the case. */
function equals(has: Json | undefined, text: string, wanted: number | undefined): boolean {
  if (Array.isArray(has)) return has.some((each) => equals(each, text, wanted));
  if (typeof has === "number" && wanted !== undefined) return has === wanted;
  return [has === undefined || has === null ? "" : String(has), formatValue(has)].some((each) => each.toLowerCase() === text.toLowerCase());
}
