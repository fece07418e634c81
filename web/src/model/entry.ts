/** What somebody types or pastes into a field for a number. */

export type Entry =
  | { is: "number"; value: number; remark: string }
  /** Nothing yet, or a lone sign. */
  | { is: "unfinished" }
  | { is: "refused"; remark: string };

const NUMBER = /^[-+]?(\d+\.?\d*|\.\d+)(e[-+]?\d+)?$/i;
const BEGUN = /^[-+]?\.?$|^[-+]?(\d+[.,]?\d*|[.,]\d*)(e[-+]?)?$/i;

/**
 * A text as a number, a unit behind it left out. A comma before decimals is read as a point, and that is said; what may have been meant
 * in two ways is refused. Nothing is left out silently: 0,9 is not 9.
 */
export function readEntry(text: string, { unit = "", whole = false } = {}): Entry {
  const typed = text.trim().replace("−", "-");
  const plain = unit && typed.endsWith(unit) ? typed.slice(0, -unit.length).trim() : typed;
  const pointed = plain.replace(",", ".");
  if (NUMBER.test(pointed)) {
    const value = Number(pointed);
    const remark = pointed === plain ? "" : `${plain} is read as ${value}`;
    if (!Number.isFinite(value)) return { is: "refused", remark: `${plain} is too large` };
    return whole && !Number.isInteger(value) ? { is: "refused", remark: `${plain} is no whole number` } : { is: "number", value, remark };
  }
  if (BEGUN.test(plain)) return { is: "unfinished" };
  return { is: "refused", remark: `“${plain.slice(0, 30)}” is no number: write it with a point, as 0.9` };
}

/** A value as it stands in a field, with no more decimals than are wanted. */
export function entryText(value: number | "", { unit = "", decimals }: { unit?: string; decimals?: number | undefined } = {}): string {
  if (value === "") return "";
  const text = String(decimals === undefined ? value : Number(value.toFixed(decimals)));
  return unit ? `${text} ${unit}` : text;
}

/** A step from a value, within its limits and without what rounding adds. */
export function stepped(value: number, step: number, least = -Infinity, most = Infinity): number {
  return Math.min(Math.max(Number((value + step).toPrecision(12)), least), most);
}
