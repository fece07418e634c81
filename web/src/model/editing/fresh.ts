/** A condition or an action that somebody has just chosen: what it must be told is filled in, so that it can be changed in its form. */

import type { KnownKind } from "../form";
import type { Json, Tree } from "../run";
import { isTree, resolve, type Schema } from "../schema";
import type { Point } from "../view";
import { at } from "./deed";
import type { Editing } from "./item";

/** The names that a field may hold, by what it names. */
export function namesOf({ given, document, items }: Editing, what: string): string[] {
  const keys = (part: string) => Object.keys((at(given, part) as Tree | undefined) ?? {});
  const brought = items.filter(({ group }) => group === "person" || group === "object").map(({ name }) => name);
  switch (what) {
    case "vehicle":
      return keys("vehicles");
    case "unit":
      return [...keys("vehicles"), ...keys("stations")];
    case "body":
      return [...keys("vehicles"), ...brought.filter((name) => isTree(at(document, `script.${name}.do.line`)) || at(document, `script.${name}.do.kind`) !== "objects")];
    case "route":
      return keys("routes");
    case "entry":
      return keys("script");
    case "application":
      return keys("applications");
    default:
      return [];
  }
}

/** The settings of a kind in a new place: what it shares with the one before stays, what it needs is chosen. */
export function settingsFor(kind: KnownKind, before: Tree, state: Editing, around: Point): Tree {
  const schema = kind.settings ?? {};
  const known = Object.keys(schema.properties ?? {});
  const kept = Object.fromEntries(Object.entries(before).filter(([key, value]) => known.includes(key) && value !== null && !isTree(value)));
  const taken = new Set<string>(Object.values(kept).filter((value): value is string => typeof value === "string"));
  const needed = requiredOf(schema).filter((key) => !(key in kept));
  const chosen = needed.map((key) => [key, valueFor(key, resolve(schema.properties?.[key] ?? {}, schema, undefined), state, around, taken)] as const);
  return { kind: kind.name, ...kept, ...Object.fromEntries(chosen), ...whereabouts(known, kept, state, around) };
}

const requiredOf = (schema: Schema): string[] => (schema as { required?: string[] }).required ?? [];

/** What lies along a route or a road must say one of them. */
function whereabouts(known: readonly string[], kept: Tree, state: Editing, around: Point): Tree {
  if (known.includes("area") && !known.includes("route")) return { area: { x: Math.round(around.x), y: Math.round(around.y), radius: 20 } };
  if (!known.includes("start") || !known.includes("end") || "route" in kept || "road" in kept) return {};
  const [route] = namesOf(state, "route");
  return known.includes("route") && route !== undefined ? { route, start: 0, end: 20 } : {};
}

function valueFor(key: string, schema: Schema, state: Editing, around: Point, taken: Set<string>): Json {
  if (schema.names) {
    const names = namesOf(state, schema.names);
    const name = names.find((each) => !taken.has(each)) ?? names[0] ?? "";
    taken.add(name);
    return name;
  }
  if (schema.enum) return schema.enum[0] ?? null;
  if (key === "of") return schema.type === "array" ? [{ kind: "time", at: 0 }] : { kind: "time", at: 0 };
  if (key === "x" || key === "y") return Math.round(around[key]);
  if (key === "road") return firstRoad(state);
  if (schema.type === "number" || schema.type === "integer") return numberFor(key, schema);
  return schema.type === "boolean" ? false : schema.type === "array" ? [] : "";
}

/** Something of everyday size within the range. */
function numberFor(key: string, { minimum, exclusiveMinimum, maximum, exclusiveMaximum }: Schema): number {
  const usual = key === "start" ? 0 : key === "end" ? 20 : 5;
  const least = minimum ?? exclusiveMinimum ?? Number.NEGATIVE_INFINITY;
  const most = maximum ?? exclusiveMaximum ?? Number.POSITIVE_INFINITY;
  if (usual >= least && usual <= most) return usual;
  return Number.isFinite(least) && Number.isFinite(most) ? (least + most) / 2 : Number.isFinite(most) ? most : least;
}

function firstRoad(state: Editing): string {
  const roads = Object.values((at(state.document, "routes") as Tree | undefined) ?? {}).flatMap((route) => (isTree(route) && Array.isArray(route.roads) ? route.roads : []));
  return String(roads[0] ?? "");
}
