/** Parts of a scenario that stand under a name of their own: applications, goals, the sensors of a unit. One more, or one less. */

import type { KnownKind } from "../form";
import type { Json, Tree } from "../run";
import { isTree } from "../schema";
import { at } from "./deed";
import type { Deed, Editing } from "./item";

type Patch = NonNullable<Deed["patch"]>;

const pointer = (path: string) => `/${path.split(".").join("/")}`;
const treeAt = (whole: Tree, path: string): Tree | undefined => {
  const found = at(whole, path);
  return isTree(found) ? found : undefined;
};

/** The names of the parts, also of those that are there without standing in the file. */
export const partsAt = ({ document }: Editing, base: string): string[] => Object.keys(treeAt(document, base) ?? {});

/** A name for a new part: that of its kind, with a number where it is taken. */
export function freeName(state: Editing, base: string, kind: string): string {
  const taken = new Set(partsAt(state, base));
  if (!taken.has(kind)) return kind;
  for (let number = 2; ; number++) if (!taken.has(`${kind}_${number}`)) return `${kind}_${number}`;
}

/** What stands there as a file would say it: what a file leaves out is said by its kind alone. */
function said({ document, given }: Editing, base: string): Tree {
  const there = treeAt(given, base);
  if (there) return there;
  const defaults = Object.entries(treeAt(document, base) ?? {});
  return Object.fromEntries(defaults.map(([name, value]) => [name, isTree(value) && "kind" in value ? { kind: value.kind as Json } : value]));
}

/** The patch that puts a part in; what was there by default stays. */
export function withPart(state: Editing, base: string, name: string, value: Tree): Patch {
  if (treeAt(state.given, base)) return [{ op: "add", path: `${pointer(base)}/${name}`, value }] as Patch;
  return [{ op: "add", path: pointer(base), value: { ...said(state, base), [name]: value } }] as Patch;
}

/** The patch that takes one out, by whatever it is there. */
export function withoutPart(state: Editing, base: string, name: string): Patch {
  if (treeAt(state.given, base)) return [{ op: "remove", path: `${pointer(base)}/${name}` }] as Patch;
  const { [name]: _, ...rest } = said(state, base);
  return [{ op: "add", path: pointer(base), value: rest }] as Patch;
}

/** Whom a new application is for: the vehicles that have none; the first one where all have. */
export function unitsFor(state: Editing): string[] {
  const vehicles = Object.keys(treeAt(state.document, "vehicles") ?? {});
  const busy = new Set(Object.values(treeAt(state.document, "applications") ?? {}).flatMap((each) => (isTree(each) ? (each.units as string[]) : [])));
  const free = vehicles.filter((each) => !busy.has(each));
  return free.length > 0 ? free : vehicles.slice(0, 1);
}

/** The kinds of a sort as they are chosen from. */
export const kindsOf = (kinds: readonly KnownKind[], sort: string) =>
  kinds.filter((each) => each.sort === sort).map(({ name, title }) => ({ value: name, label: title }));

/** The unit of a measure; nothing where it is a bare number. */
export function unitOf(kinds: readonly KnownKind[], measure: string | null): string {
  const unit = kinds.find((each) => each.sort === "metric" && each.name === measure)?.gives[0]?.unit ?? "";
  return unit === "1" ? "" : unit;
}
