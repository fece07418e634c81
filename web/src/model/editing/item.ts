/** Everything of a scenario that can be chosen in the editor: in groups, searched, hidden, locked. */

import type { Changes, Filled, Server, Tree } from "../run";

export type Editing = Filled<Server["Editing"], { document: Tree; given: Tree }>;
export type Item = Server["Item"];
export type Figure = Server["Figure"];
export type Group = Item["group"];
export type Step = Server["Step"];
export type Turn = Server["Turn"];
export type Way = Server["Way"];
export type Handle = Server["Handle"];
/** What an edit sets, takes out and renames; its name, base and author come with it when it is sent. */
export interface Deed {
  name: string;
  set?: Changes;
  patch?: Server["Operation"][];
  rename?: Record<string, string>;
  remove?: string[];
}

/** The groups of the list, in its order. */
export const GROUPS: readonly { group: Group; title: string }[] = [
  { group: "vehicle", title: "Vehicles" },
  { group: "person", title: "People" },
  { group: "object", title: "Objects" },
  { group: "friction", title: "Friction patches" },
  { group: "area", title: "Areas" },
  { group: "radio", title: "Radio regions" },
  { group: "station", title: "Road-side units" },
  { group: "event", title: "Events" },
  { group: "route", title: "Routes" },
];

/** What a browser remembers of a scenario: what is hidden, and what is locked. */
export interface Veil {
  hidden: readonly string[];
  locked: readonly string[];
}

export const OPEN: Veil = { hidden: [], locked: [] };

/** The groups with the items in which all words of a query occur; empty groups are left out. */
export function grouped(items: readonly Item[], query: string): { group: Group; title: string; items: Item[] }[] {
  const needles = query.toLowerCase().split(/\s+/).filter(Boolean);
  const hit = ({ name, told, group, vehicles }: Item) => {
    const text = `${name} ${told} ${group} ${vehicles?.join(" ") ?? ""}`.toLowerCase();
    return needles.every((needle) => text.includes(needle));
  };
  return GROUPS.map((each) => ({ ...each, items: items.filter((item) => item.group === each.group && hit(item)) })).filter(
    ({ items: found }) => found.length > 0,
  );
}

/** A list with a path, or without it when it was there. */
export const toggled = (paths: readonly string[], path: string): string[] =>
  paths.includes(path) ? paths.filter((each) => each !== path) : [...paths, path];

/** Those of the chosen that are still there, after somebody has deleted others. */
export const present = (chosen: readonly string[], items: readonly Item[]): string[] =>
  chosen.filter((path) => items.some((item) => item.path === path));

/** The place in the document of what an item is a part of: of an area the entry of the script that has it. */
export const owner = (path: string): string => path.split(".").slice(0, 2).join(".");

/** “leader”, or “3 things”. */
export function named(paths: readonly string[]): string {
  const owners = [...new Set(paths.map(owner))];
  return owners.length === 1 ? (owners[0]?.split(".")[1] ?? "") : `${owners.length} things`;
}

/** What the next name in a part of the document may be: `car`, `car_2`, `car_3` … */
export function freshName(base: string, taken: readonly string[]): string {
  const plain = base.replace(/_\d+$/, "").slice(0, 34);
  let [name, number] = [plain, 1];
  while (taken.includes(name)) name = `${plain}_${++number}`;
  return name;
}
