/** Runs that stay on top of a table: the baseline, then those that somebody has pinned, in the order of the pins. */

/** `3,7` in an address: numbers of runs, each once. */
export function pinsOf(text: string | undefined): number[] {
  const found = (text ?? "").split(",").map(Number);
  return [...new Set(found.filter((each) => Number.isInteger(each) && each > 0))];
}

/** The rows with those on top that belong there; who is not among them is not made up. */
export function onTop<Row extends { run: number }>(rows: readonly Row[], base: number | undefined, pinned: ReadonlySet<number>): Row[] {
  const first = [...new Set([...(base === undefined ? [] : [base]), ...pinned])];
  if (first.length === 0) return [...rows];
  const known = new Map(rows.map((row) => [row.run, row]));
  return [...first.flatMap((run) => known.get(run) ?? []), ...rows.filter(({ run }) => !first.includes(run))];
}
