/** Numbers, times and names as a person reads them. */

const MINUS = "\u2212";

/** A number with at most four significant digits; whole numbers stay whole. */
export function formatNumber(value: number): string {
  if (!Number.isFinite(value)) return "–";
  if (Number.isInteger(value)) return signed(String(value));
  const size = Math.abs(value);
  if (size >= 1e6 || size < 1e-4) return signed(powerOfTen(value));
  return signed(String(Number(value.toPrecision(4))));
}

/** 8.905e+6 as a person writes it: 8.905·10⁶. */
function powerOfTen(value: number): string {
  const [mantissa = "", exponent = ""] = value.toExponential(3).split("e");
  return `${Number(mantissa)}·10${[...exponent.replace("+", "")].map((each) => RAISED[each] ?? each).join("")}`;
}

const RAISED: Record<string, string> = { ...Object.fromEntries([..."⁰¹²³⁴⁵⁶⁷⁸⁹"].entries()), "-": "⁻" };

const signed = (text: string) => text.replace(/^-/, MINUS);

/** A number with so many decimals; what rounds to zero has no sign. */
export function formatFixed(value: number, decimals: number): string {
  const text = value.toFixed(decimals);
  return signed(Number(text) === 0 ? text.replace("-", "") : text);
}

/** Any value of a document: numbers shortened, nothing as a dash. */
export function formatValue(value: unknown): string {
  if (value === null || value === undefined || value === "") return "–";
  if (typeof value === "number") return formatNumber(value);
  if (typeof value === "boolean") return value ? "on" : "off";
  return typeof value === "string" ? value : JSON.stringify(value);
}

/** A difference, with its sign always shown. */
export function formatDifference(value: number): string {
  return value > 0 ? `+${formatNumber(value)}` : formatNumber(value);
}

/** A ratio as signed per cent: 0.123 → "+12.3 %"; hundredths of a per cent are the last that are told. */
export function formatRelative(ratio: number): string {
  const percent = Number((ratio * 100).toPrecision(3));
  return `${formatDifference(Math.abs(percent) < 1 ? Number(percent.toFixed(2)) : percent)} %`;
}

/** Simulation time with hundredths, so that one 20 ms tick is seen. */
export const formatTime = (seconds: number): string => formatFixed(seconds, 2);

/** Duration for people: "3.4 s", "2 min 05 s". */
export function formatDuration(seconds: number): string {
  if (seconds < 60) return `${Number(seconds.toFixed(1))} s`;
  const whole = Math.round(seconds);
  return `${Math.floor(whole / 60)} min ${String(whole % 60).padStart(2, "0")} s`;
}

/** A size on disk: "812 kB", "1.3 MB"; thousands, not 1024s. */
export function formatBytes(bytes: number): string {
  if (bytes < 1000) return `${bytes} B`;
  const [value, unit] = bytes < 1e6 ? [bytes / 1e3, "kB"] : bytes < 1e9 ? [bytes / 1e6, "MB"] : [bytes / 1e9, "GB"];
  return `${Number(value.toPrecision(3))} ${unit}`;
}

const ACRONYMS = /\b(rms|ttc|thw|drac|pet|cam|id|acc|cacc|v2x|rss)\b/gi;

/** `mean_time_gap` → `Mean time gap`, `min_ttc` → `Min TTC`. */
export function words(name: string): string {
  const text = name
    .replace(/[_.]+/g, " ")
    .trim()
    .replace(ACRONYMS, (acronym) => acronym.toUpperCase());
  return text.charAt(0).toUpperCase() + text.slice(1);
}

/** The unit as it is shown: a pure number, unit "1", has none. */
export const unitText = (unit: string | null | undefined): string => (!unit || unit === "1" ? "" : unit);

/** A heading with its unit: `Speed [m/s]`; without one, the name alone. */
export const withUnit = (name: string, unit: string | null | undefined): string =>
  unitText(unit) ? `${name} [${unit}]` : name;

/** When something was made, short, in the reader's own time zone: `22 Nov 05:09`. */
export function formatMoment(iso: string): string {
  const date = new Date(iso);
  if (Number.isNaN(date.getTime())) return iso;
  const day = date.toLocaleDateString("en-GB", { day: "2-digit", month: "short" });
  return `${day} ${date.toLocaleTimeString("en-GB", { hour: "2-digit", minute: "2-digit", second: "2-digit" })}`;
}
