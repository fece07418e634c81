/** How somebody has arranged the columns of a table: which are hidden, and in which order the others stand. */

import type { Column } from "./table";

export interface Arrangement {
  hidden: readonly string[];
  /** Ids in their order; columns that are not named come behind, as they are. */
  order: readonly string[];
}

export const AS_IT_IS: Arrangement = { hidden: [], order: [] };

/** The columns in the order that was chosen; groups stay together. */
export function arranged(columns: readonly Column[], { order }: Arrangement): Column[] {
  const groups = [...new Set(columns.map(({ group }) => group))];
  const rank = new Map(order.map((id, place) => [id, place]));
  const place = ({ id }: Column) => rank.get(id) ?? order.length;
  return groups.flatMap((group) => columns.filter((column) => column.group === group).sort((one, other) => place(one) - place(other)));
}

/** Hides a column, or shows it again. */
export function toggled({ hidden, order }: Arrangement, id: string): Arrangement {
  return { order, hidden: hidden.includes(id) ? hidden.filter((other) => other !== id) : [...hidden, id] };
}

/** Moves a column by so many places within its group; beyond the ends it stays. */
export function moved(arrangement: Arrangement, columns: readonly Column[], id: string, by: number): Arrangement {
  const now = arranged(columns, arrangement);
  const group = now.find((column) => column.id === id)?.group;
  const own = now.filter((column) => column.group === group).map((column) => column.id);
  const from = own.indexOf(id);
  const to = Math.min(own.length - 1, Math.max(0, from + by));
  own.splice(to, 0, ...own.splice(from, 1));
  return { ...arrangement, order: now.flatMap((column) => (column.group === group ? [] : column.id)).concat(own) };
}
