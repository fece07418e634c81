/** The samples of a live run: columns that only grow. */

export type Column = (number | null)[];

export interface Samples {
  time: number[];
  channels: Record<string, Column>;
}

export const noSamples = (): Samples => ({ time: [], channels: {} });

/** How many leading entries of `time` are not newer than `last`. */
function known(time: readonly number[], last: number): number {
  const first = time.findIndex((t) => t > last);
  return first < 0 ? time.length : first;
}

/**
 * Append a message to the columns, in place.
 *
 * A time that is already there is left out; a channel that comes late is padded in front with gaps, and
 * one that is missing this time gets gaps, so that all columns stay as long as the time column.
 */
export function append(samples: Samples, message: Samples): void {
  const before = samples.time.length;
  const skip = known(message.time, samples.time.at(-1) ?? -Infinity);
  samples.time.push(...message.time.slice(skip));
  for (const [name, values] of Object.entries(message.channels)) {
    const column = samples.channels[name] ?? new Array<number | null>(before).fill(null);
    samples.channels[name] = column;
    column.push(...values.slice(skip));
  }
  for (const column of Object.values(samples.channels)) {
    while (column.length < samples.time.length) column.push(null);
  }
}
