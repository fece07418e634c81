/** How somebody has arranged the columns of a table: which are hidden, which stay at the left, and in which order the others stand. */

import { channelId } from "./column";
import type { Column } from "./table";

export interface Arrangement {
  hidden: readonly string[];
  /** Ids in their order; columns that are not named come behind, as they are. */
  order: readonly string[];
  /** Those that stay at the left when the table is scrolled sideways, in their order; what was kept before there were any has none. */
  pinned?: readonly string[];
  /** Names of columns that somebody has added: recorded channels in one number. */
  channels?: readonly string[];
}

export const AS_IT_IS: Arrangement = { hidden: [], order: [], pinned: [] };

/** The columns that stay at the left, in their order; those that the table has not (any more) are left out. */
export function pinnedOf(columns: readonly Column[], { pinned = [] }: Arrangement): Column[] {
  return pinned.flatMap((id) => columns.find((column) => column.id === id) ?? []);
}

/** Keeps a column at the left, behind those that are there, or lets it go to its place again; one that was hidden is shown. */
export function pinned(arrangement: Arrangement, id: string): Arrangement {
  const { hidden, pinned: before = [] } = arrangement;
  if (before.includes(id)) return { ...arrangement, pinned: before.filter((other) => other !== id) };
  return { ...arrangement, hidden: hidden.filter((other) => other !== id), pinned: [...before, id] };
}

/** The columns in the order that was chosen; groups stay together. */
export function arranged(columns: readonly Column[], { order }: Arrangement): Column[] {
  const groups = [...new Set(columns.map(({ group }) => group))];
  const rank = new Map(order.map((id, place) => [id, place]));
  const place = ({ id }: Column) => rank.get(id) ?? order.length;
  return groups.flatMap((group) => columns.filter((column) => column.group === group).sort((one, other) => place(one) - place(other)));
}

/** Hides a column, or shows it again. */
export function toggled(arrangement: Arrangement, id: string): Arrangement {
  const { hidden } = arrangement;
  return { ...arrangement, hidden: hidden.includes(id) ? hidden.filter((other) => other !== id) : [...hidden, id] };
}

/** With a column of a channel more; one that is there already is only shown again. */
export function withChannel(arrangement: Arrangement, name: string): Arrangement {
  const { channels = [], hidden } = arrangement;
  const id = channelId(name);
  return { ...arrangement, channels: channels.includes(name) ? channels : [...channels, name], hidden: hidden.filter((other) => other !== id) };
}

/** Without one, and without what was said of it. */
export function withoutChannel(arrangement: Arrangement, name: string): Arrangement {
  const rest = (ids: readonly string[] = []) => ids.filter((id) => id !== channelId(name));
  const { channels = [], hidden, order, pinned: fixed } = arrangement;
  return { hidden: rest(hidden), order: rest(order), pinned: rest(fixed), channels: channels.filter((other) => other !== name) };
}

/** Moves a column by so many places within its group, or within those at the left; beyond the ends it stays. */
export function moved(arrangement: Arrangement, columns: readonly Column[], id: string, by: number): Arrangement {
  const fixed = pinnedOf(columns, arrangement).map((column) => column.id);
  if (fixed.includes(id)) return { ...arrangement, pinned: shifted(fixed, id, by) };
  const now = arranged(columns, arrangement);
  const group = now.find((column) => column.id === id)?.group;
  const own = now.filter((column) => column.group === group && !fixed.includes(column.id)).map((column) => column.id);
  return { ...arrangement, order: now.flatMap((column) => (own.includes(column.id) ? [] : column.id)).concat(shifted(own, id, by)) };
}

function shifted(ids: readonly string[], id: string, by: number): string[] {
  const rest = ids.filter((other) => other !== id);
  return rest.toSpliced(Math.min(rest.length, Math.max(0, ids.indexOf(id) + by)), 0, id);
}

/**
 * Where columns that stay at the left begin, each behind those before it, by their widths [px]; those that would leave less than
 * a third of the table to the others go along with them.
 */
export function offsets(widths: readonly number[], room: number): (number | undefined)[] {
  let left = 0;
  return widths.map((width) => {
    const begin = left;
    left += width;
    return left > (2 / 3) * room ? undefined : begin;
  });
}
