/** Samples of a chart as rows of a table. */

export type Cell = string | number | null | undefined;

/** So many rows can be read. */
const MOST = 200;

/** The rows [time, ...values] within a stretch of time, at most so many, the first and the last among them; and how many there are. */
export function tableOf(data: readonly [readonly number[], ...(readonly (number | null | undefined)[])[]], span: readonly [number, number] | undefined, most = MOST): { rows: Cell[][]; of: number } {
  const inside = data[0].flatMap((time, place) => (!span || (time >= span[0] && time <= span[1]) ? [place] : []));
  return { rows: evenly(inside, most).map((place) => data.map((column) => column[place])), of: inside.length };
}

/** At most so many of them, evenly taken, the first and the last among them. */
export function evenly<T>(all: readonly T[], most = MOST): T[] {
  const step = Math.max(1, (all.length - 1) / (most - 1));
  return Array.from({ length: Math.min(all.length, most) }, (_, place) => all[Math.round(place * step)] as T);
}

interface Curve {
  label: string;
  time: readonly number[];
  x: readonly (number | null | undefined)[];
  y: readonly (number | null | undefined)[];
}

/** Curves of one quantity over another as rows [whose, time, x, y], curve after curve, of each about as many; and how many there are. */
export function pairsOf(curves: readonly Curve[], most = MOST): { rows: Cell[][]; of: number } {
  const each = Math.max(2, Math.floor(most / Math.max(1, curves.length)));
  const rows = curves.flatMap(({ label, time, x, y }) => evenly([...time.keys()], each).map((place): Cell[] => [label, time[place], x[place], y[place]]));
  return { rows, of: curves.reduce((sum, { time }) => sum + time.length, 0) };
}

/** How many rows of how many a table has, in words. */
export const partOf = (count: number, of: number, what: string): string => (count === of ? `${of} ${what}.` : `${count} of ${of} ${what}, evenly taken.`);
