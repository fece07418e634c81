/** Samples of a chart as rows of a table. */

type Cell = number | null | undefined;

/** So many rows can be read. */
const MOST = 200;

/** The rows [time, ...values] within a stretch of time, at most so many, the first and the last among them; and how many there are. */
export function tableOf(data: readonly [readonly number[], ...(readonly Cell[])[]], span: readonly [number, number] | undefined, most = MOST): { rows: Cell[][]; of: number } {
  const inside = data[0].flatMap((time, place) => (!span || (time >= span[0] && time <= span[1]) ? [place] : []));
  const step = Math.max(1, (inside.length - 1) / (most - 1));
  const count = Math.min(inside.length, most);
  const taken = Array.from({ length: count }, (_, place) => inside[Math.round(place * step)] as number);
  return { rows: taken.map((place) => data.map((column) => column[place])), of: inside.length };
}
