/**
 * The parameter form, computed from three things: the scenario's document, its JSON schema and the user's
 * changes. A section mirrors an object of the document, a field one of its values.
 */

import type { Changes, Filled, Json, Problem, Server, Tree } from "./run";
import { leaf } from "./run";
import { isTree, resolve, type Schema } from "./schema";
import { unitText, words } from "./units";

export type Kind = "number" | "integer" | "boolean" | "choice" | "text" | "list" | "colour";

export interface Field {
  path: string;
  label: string;
  description: string;
  unit: string;
  kind: Kind;
  choices: string[];
  /** What of the scenario it names: a vehicle, a route. */
  names?: string;
  /** What a text may be, among others. */
  suggestions: string[];
  minimum?: number;
  maximum?: number;
  /** What is allowed, in words. */
  allowed: string;
  /** Whether it may be left empty. */
  nullable: boolean;
  /** The value without the user's changes. */
  initial: Json;
  value: Json;
  changed: boolean;
  /** Neither the file nor the user says it: it is the preset's, or the default. */
  isDefault: boolean;
}

/** A kind that may stand in a place. */
export interface Choice {
  name: string;
  title: string;
  /** What may be set of it. */
  settings: string[];
}

/** A place where a kind is chosen: an application of a group, the driver of a vehicle, a sensor. */
export interface Exchange {
  /** Path of the kind's name, e.g. `applications.platoon.application` or `vehicles.leader.driver.kind`. */
  path: string;
  /** Under which path its settings stand. */
  base: string;
  sort: string;
  initial: string;
  value: string;
  description: string;
  choices: Choice[];
}

export interface Section {
  path: string;
  title: string;
  description: string;
  exchange?: Exchange;
  fields: Field[];
  sections: Section[];
}

export type KnownKind = Filled<Server["Kind"], { settings: Schema | null }>;

/** What every part of the form is computed from. */
export interface Source {
  /** With all defaults. */
  document: Tree;
  /** As it stands in the file: without defaults. */
  given: Tree;
  schema: Schema;
  kinds: readonly KnownKind[];
  changes: Changes;
}

/** What a developer turns most comes first; keys that are not named here follow in the schema's order. */
const ORDER = [
  "applications",
  "radio",
  "messages",
  "vehicles",
  "stations",
  "traffic",
  "script",
  "weather",
  "clock",
  "goals",
  "recording",
  "routes",
  "map",
];

/** Told in the page's head or in the run bar, so not in the form. */
const ELSEWHERE = new Set(["title", "description", "seed", "version", "format"]);

/** The whole form, one section per top-level key. */
export function sections(source: Source): Section[] {
  const { document, schema } = source;
  const all = objectSection(source, "", schema, document);
  const general: Section[] = all.fields.length
    ? [{ path: "", title: "General", description: "", fields: all.fields, sections: [] }]
    : [];
  const place = (path: string) => (ORDER.includes(path) ? ORDER.indexOf(path) : ORDER.length);
  const filled = all.sections.filter((section) => notEmpty(section)).map((section) => (section.path === "goals" ? measured(section, source.kinds) : section));
  return marked([...filled.sort((a, b) => place(a.path) - place(b.path)), ...general], source.given);
}

/** Goals have the units of their measures, which stand with the kinds and not in the schema. */
function measured(section: Section, kinds: readonly KnownKind[]): Section {
  const unit = (name: string) => unitText(kinds.find((each) => each.sort === "metric" && each.name === name)?.gives[0]?.unit);
  return {
    ...section,
    fields: section.fields.map((each) => ({ ...each, unit: each.unit || unit(each.path.split(".")[1] ?? "") })),
    sections: section.sections.map((each) => measured(each, kinds)),
  };
}

/** The form with what neither the file nor the user says marked as such. */
function marked(all: readonly Section[], given: Tree): Section[] {
  return all.map((section) => ({
    ...section,
    fields: section.fields.map((each) => ({ ...each, isDefault: !each.changed && valueAt(given, each.path) === undefined })),
    sections: marked(section.sections, given),
  }));
}

function objectSection(source: Source, path: string, child: Schema, value: Tree): Section {
  const exchange = exchangeOf(source, path, resolve(child, source.schema, value), value);
  const shown = exchange ? inPlace(source, path, exchange, value) : value;
  const schema = resolve(child, source.schema, shown);
  const section = emptySection(path, schema);
  if (exchange) section.exchange = exchange;
  for (const key of keysOf(schema, shown)) {
    const below = path ? `${path}.${key}` : key;
    if (below === exchange?.path || (path === "" && ELSEWHERE.has(key))) continue;
    if (exchange && key === PRESET) section.fields.push(...presetField(source, path, exchange, childSchema(schema, key), shown[key] ?? null));
    else if (below === exchange?.base) section.fields.push(...applicationFields(source, exchange, shown[key] as Tree));
    else add(section, source, below, childSchema(schema, key), shown[key] ?? null);
    // A title given to a property names the section; that of a class of entries does not tell them apart.
    const inner = section.sections.at(-1);
    const title = schema.properties?.[key]?.title;
    if (inner?.path === below && title) inner.title = words(title) + variant(inner);
  }
  return section;
}

/** Which of several alternatives an entry is: its constant is not among the fields. */
function variant({ exchange }: Section): string {
  return exchange && exchange.choices.length > 1 ? `: ${words(exchange.value).toLowerCase()}` : "";
}

function emptySection(path: string, schema: Schema): Section {
  const title = /^\d+$/.test(leaf(path)) ? `${Number(leaf(path)) + 1}` : words(leaf(path));
  return { path, title, description: schema.description ?? "", fields: [], sections: [] };
}

/** Put one child where it belongs: an object becomes a section, a value a field. */
function add(section: Section, source: Source, path: string, child: Schema, value: Json): void {
  const schema = resolve(child, source.schema, value);
  if (isTree(value)) section.sections.push(objectSection(source, path, child, value));
  else if (Array.isArray(value) && value.some(isTree))
    section.sections.push(listSection(source, path, schema, value));
  else if (editable(schema, source.schema))
    section.fields.push(field(path, schema, value, source.changes, nullable(child, source.schema)));
}

/** Constants are told by where they stand; an object that is not there, or an empty list of objects, has nothing to edit. */
function editable(schema: Schema, root: Schema): boolean {
  const items = typeof schema.items === "object" ? resolve(schema.items, root, undefined) : {};
  return schema.const === undefined && schema.type !== "object" && items.type !== "object";
}

/** Whether one of the alternatives is nothing. */
function nullable(schema: Schema, root: Schema): boolean {
  const plain = schema.$ref ? resolve({ $ref: schema.$ref }, root, undefined) : schema;
  return (
    [...(schema.anyOf ?? []), ...(schema.oneOf ?? [])].some(({ type }) => type === "null") ||
    [plain.type].flat().includes("null")
  );
}

function listSection(source: Source, path: string, schema: Schema, values: Json[]): Section {
  const section = emptySection(path, schema);
  const items = typeof schema.items === "object" ? schema.items : {};
  values.forEach((value, index) => {
    if (!isTree(value)) return;
    const below = `${path}.${index}`;
    const item = objectSection(source, below, items, value);
    const name = value.name ?? value.id;
    if (typeof name === "string") item.title = words(name);
    section.sections.push(item);
  });
  return section;
}

/** The schema's keys in its order, then those that only the document has. */
function keysOf(schema: Schema, value: Tree): string[] {
  const named = Object.keys(schema.properties ?? {}).filter((key) => key in value);
  return [...named, ...Object.keys(value).filter((key) => !named.includes(key))];
}

function childSchema(schema: Schema, key: string): Schema {
  const { properties, patternProperties, additionalProperties } = schema;
  const matched = Object.entries(patternProperties ?? {}).find(([pattern]) =>
    new RegExp(pattern).test(key),
  )?.[1];
  return (
    properties?.[key] ?? matched ?? (typeof additionalProperties === "object" ? additionalProperties : {})
  );
}

/** One value of the document as a field of the form. */
function field(path: string, schema: Schema, initial: Json, changes: Changes, empty = false): Field {
  const value = path in changes ? (changes[path] as Json) : initial;
  const result: Field = {
    path,
    label: schema.title ? words(schema.title) : words(leaf(path)),
    description: schema.description ?? "",
    unit: unitText(schema.unit),
    kind: kindOf(schema, initial),
    choices: (schema.enum ?? []).map(String),
    suggestions: (schema.examples ?? []).map(String),
    allowed: limits(schema),
    nullable: empty,
    initial,
    value,
    changed: !same(value, initial),
    isDefault: false,
  };
  const minimum = schema.minimum ?? schema.exclusiveMinimum;
  const maximum = schema.maximum ?? schema.exclusiveMaximum;
  if (schema.names) result.names = schema.names;
  if (minimum !== undefined) result.minimum = minimum;
  if (maximum !== undefined) result.maximum = maximum;
  return result;
}

/** The range of a schema in words. */
function limits({ minimum, exclusiveMinimum, maximum, exclusiveMaximum, unit }: Schema): string {
  const low =
    minimum !== undefined
      ? `at least ${minimum}`
      : exclusiveMinimum !== undefined
        ? `above ${exclusiveMinimum}`
        : "";
  const high =
    maximum !== undefined
      ? `at most ${maximum}`
      : exclusiveMaximum !== undefined
        ? `below ${exclusiveMaximum}`
        : "";
  const both = [low, high].filter(Boolean).join(", ");
  return both && unitText(unit) ? `${both} ${unitText(unit)}` : both;
}

function kindOf(schema: Schema, value: Json): Kind {
  const type = [schema.type ?? typeof value].flat().find((name) => name !== "null");
  if (schema.enum) return "choice";
  if (typeof value === "string" && /^#[0-9a-f]{6}$/i.test(value)) return "colour";
  if (type === "number" || type === "integer" || type === "boolean") return type;
  return type === "array" || Array.isArray(value) ? "list" : "text";
}

/** Equality of JSON values. */
export const same = (a: Json, b: Json): boolean => a === b || JSON.stringify(a) === JSON.stringify(b);

// ----------------------------------------------------------------------------------------- kinds

/** The place where a kind is chosen, if this is one: the schema says so of a slot, and groups run applications. */
function exchangeOf(source: Source, path: string, schema: Schema, value: Tree): Exchange | undefined {
  const isGroup = /^applications\.[^.]+$/.test(path);
  const sort = isGroup ? "application" : schema.sort;
  if (!sort) return undefined;
  const key = isGroup ? "application" : "kind";
  const place = `${path}.${key}`;
  const initial = value[key] as string;
  const current = (source.changes[place] as string | undefined) ?? initial;
  const known = source.kinds.filter((kind) => kind.sort === sort);
  return {
    path: place,
    base: isGroup ? `${path}.parameters` : path,
    sort,
    initial,
    value: current,
    description: firstParagraph(known.find(({ name }) => name === current)?.description ?? ""),
    choices: known.map(({ name, title, settings }) => ({ name, title, settings: Object.keys(settings?.properties ?? {}) })),
  };
}

const firstParagraph = (text: string): string => text.split(/\n\s*\n/)[0]?.trim() ?? "";

/** The kind that is chosen in a place. */
const chosen = ({ kinds }: Source, { sort, value }: Exchange): Schema =>
  kinds.find((kind) => kind.sort === sort && kind.name === value)?.settings ?? {};

/**
 * The object with the kind and the preset that are chosen: of another one what the file gives is kept, as far as both have it; the rest
 * is the preset's, and what that does not say the default.
 */
function inPlace(source: Source, path: string, exchange: Exchange, before: Tree): Tree {
  const { initial, value, base } = exchange;
  const place = `${path}.${PRESET}`;
  if (value === initial && !(place in source.changes)) return before;
  const named = presetsOf(source, exchange);
  const kept = named.some(({ name }) => name === before[PRESET]) ? (before[PRESET] as Json) : null;
  const preset = place in source.changes ? source.changes[place] : kept;
  const values = named.find(({ name }) => name === preset)?.values ?? {};
  const given = valueAt(source.given, base);
  const settings = settingsOf(chosen(source, exchange), isTree(given) ? given : {}, values as Tree);
  if (base !== path) return { ...before, [PRESET]: kept, [leaf(base)]: settings };
  return { kind: value, ...(named.length ? { [PRESET]: kept } : {}), ...settings };
}

/** What a kind is set to: as the file gives it, else as its preset does, else its defaults. */
const settingsOf = ({ properties = {} }: Schema, given: Tree, preset: Tree = {}): Tree =>
  Object.fromEntries(
    Object.entries(properties).map(([key, property]) => [key, given[key] ?? preset[key] ?? property.default ?? null]),
  );

/** Beside the settings of a kind: a named set of them. */
const PRESET = "preset";

/** The presets of the kind that is chosen. */
const presetsOf = ({ kinds }: Source, { sort, value }: Exchange): KnownKind["presets"] =>
  kinds.find((kind) => kind.sort === sort && kind.name === value)?.presets ?? [];

/** The choice among them; none where there are none. */
function presetField(source: Source, path: string, exchange: Exchange, schema: Schema, initial: Json): Field[] {
  const named = presetsOf(source, exchange);
  if (named.length === 0) return [];
  const told = named.map(({ name, title, source: from }) => `${name}: ${title} (${from})`).join("; ");
  const plain = resolve(schema, source.schema, "");
  const choice = { ...plain, enum: named.map(({ name }) => name), description: `what is not given has its value. ${told}` };
  return [field(`${path}.${PRESET}`, choice, initial, source.changes, true)];
}

/** The parameters of the application in place, by that application's own schema. */
const applicationFields = (source: Source, exchange: Exchange, parameters: Tree): Field[] =>
  schemaFields(chosen(source, exchange), `${exchange.base}.`, parameters, source.changes);

/** What may be set of a kind, with its defaults. */
export const settingsAtRest = ({ settings }: KnownKind): Field[] => schemaFields(settings ?? {}, "", {}, {});

/** A field for every property of a kind's own schema. */
function schemaFields(schema: Schema, place: string, values: Tree, changes: Changes): Field[] {
  return Object.entries(schema.properties ?? {}).map(([key, property]) => {
    const initial = values[key] ?? property.default ?? null;
    return field(`${place}${key}`, resolve(property, schema, initial), initial, changes, nullable(property, schema));
  });
}

/** Exchange a kind: changes of settings that the new one does not have are dropped, as the server does. */
export function exchanged(changes: Changes, { path: place, base, initial, choices }: Exchange, name: string): Changes {
  const settings = choices.find((choice) => choice.name === name)?.settings ?? [];
  const first = (path: string) => path.slice(base.length + 1).split(".", 1)[0] as string;
  const stays = (path: string) => !path.startsWith(`${base}.`) || settings.includes(first(path));
  const preset = `${place.slice(0, place.lastIndexOf("."))}.${PRESET}`;
  const kept = Object.entries(changes).filter(([path]) => path !== place && path !== preset && stays(path));
  return Object.fromEntries(name === initial ? kept : [...kept, [place, name]]);
}

// --------------------------------------------------------------------------------------- changes

/** Set one value; setting what the document says anyway is no change. */
export function withChange(changes: Changes, field: Pick<Field, "path" | "initial">, value: Json): Changes {
  const { [field.path]: _old, ...others } = changes;
  return same(value, field.initial) ? others : { ...others, [field.path]: value };
}

/** Whether two forms set the same, in whatever order. */
export function sameChanges(a: Changes, b: Changes): boolean {
  const paths = Object.keys(a);
  return (
    paths.length === Object.keys(b).length &&
    paths.every((path) => path in b && same(a[path] as Json, b[path] as Json))
  );
}

/** The changes that are left when some have been saved: what was set otherwise meanwhile stays. */
export const withoutSaved = (changes: Changes, saved: Changes): Changes =>
  Object.fromEntries(
    Object.entries(changes).filter(([path, value]) => !(path in saved && same(value, saved[path] as Json))),
  );

/** All fields of the form, in the order in which they stand. */
export function fieldsOf(all: readonly Section[]): Field[] {
  return all.flatMap((section) => [...section.fields, ...fieldsOf(section.sections)]);
}

/** The form with suggestions at one of its fields. */
export const suggesting = (all: readonly Section[], path: string, suggestions: string[]): Section[] =>
  all.map((section) => ({
    ...section,
    fields: section.fields.map((field) => (field.path === path ? { ...field, suggestions } : field)),
    sections: suggesting(section.sections, path, suggestions),
  }));

/** All places of the form where a kind is chosen. */
export function exchangesOf(all: readonly Section[]): Exchange[] {
  return all.flatMap((section) => [
    ...(section.exchange ? [section.exchange] : []),
    ...exchangesOf(section.sections),
  ]);
}

/** How many values below this section differ from the document. */
export function changedIn(section: Section): number {
  const exchanges = exchangesOf([section]).filter(({ initial, value }) => initial !== value);
  return fieldsOf([section]).filter(({ changed }) => changed).length + exchanges.length;
}

/** What a run was started with, as single changes of the form; a program may have set whole objects. */
export function fromSet(set: Changes): Changes {
  const entries = Object.entries(set).flatMap(([path, value]): [string, Json][] =>
    isTree(value) ? Object.entries(value).map(([key, inner]) => [`${path}.${key}`, inner]) : [[path, value]],
  );
  return Object.fromEntries(entries);
}

// ---------------------------------------------------------------------------- search and problems

/** The sections with only the fields that match all words of the query. */
export function matching(all: readonly Section[], query: string): Section[] {
  const needles = query.toLowerCase().split(/\s+/).filter(Boolean);
  if (needles.length === 0) return [...all];
  const hit = (text: string) => needles.every((needle) => text.toLowerCase().includes(needle));
  const kept = ({ exchange, ...section }: Section): Section => {
    const fields = section.fields.filter(({ path, label, description }) => hit(`${path} ${label} ${description}`));
    const found = exchange && (fields.length > 0 || hit(`${exchange.path} ${exchange.description}`));
    const inner = section.sections.map(kept).filter(notEmpty);
    return { ...section, ...(found ? { exchange } : {}), fields, sections: inner };
  };
  return all.map(kept).filter(notEmpty);
}

const notEmpty = ({ exchange, fields, sections: inner }: Section): boolean =>
  exchange !== undefined || fields.length > 0 || inner.length > 0;

/** The paths that a place may mean: the server writes `file.yaml: applications.platoon.parameters: headway`. */
function tails(where: string): string[] {
  const parts = where.split(": ");
  return parts.map((_, index) => parts.slice(index).join("."));
}

/** One sentence for a form with problems, about the first of them; empty when there is none. */
export function refusal(problems: readonly Problem[]): string {
  const [first, ...others] = problems;
  if (!first) return "";
  const place = first.where.split(": ").filter((part) => !/\.ya?ml$/.test(part));
  const { what, value, allowed } = first;
  const got = `${value ? ` (got ${value})` : ""}${allowed ? `; allowed: ${allowed}` : ""}`;
  const more = others.length ? `, and ${others.length} more` : "";
  return `The form has a problem: ${[...place, what].join(": ")}${got}${more}`;
}

/** Problems by the path of the field where they stand; the rest under the empty path. */
export function placed(problems: readonly Problem[], paths: readonly string[]): Map<string, Problem[]> {
  const result = new Map<string, Problem[]>();
  for (const problem of problems) {
    const path = tails(problem.where).find((tail) => paths.includes(tail)) ?? "";
    result.set(path, [...(result.get(path) ?? []), problem]);
  }
  return result;
}

// -------------------------------------------------------------------------------------- units

/** The unit of every setting of a scenario, by path; of every kind's settings by `*` and name. */
export function unitsOf(source: Source): Record<string, string> {
  const fields = fieldsOf(sections(source)).map(({ path, unit }) => [path, unit] as const);
  return { ...unitsOfKinds(source.kinds), ...Object.fromEntries(fields) };
}

/** The unit of every setting of the kinds, by `*` and its name: all that is known of a scenario that is not there any more. */
export const unitsOfKinds = (kinds: readonly KnownKind[]): Record<string, string> =>
  Object.fromEntries(
    kinds.flatMap(({ settings: schema }) =>
      Object.entries(schema?.properties ?? {}).map(([key, { unit }]) => [`*.${key}`, unitText(unit)] as const),
    ),
  );

/** The unit of a path; a setting of a kind that was exchanged since is found by its name. */
export const unitAt = (units: Record<string, string>, path: string): string =>
  units[path] ?? units[`*.${leaf(path)}`] ?? "";

/** The value at a dotted path of a document, if there is one. */
export function valueAt(document: Json | undefined, path: string): Json | undefined {
  return path.split(".").reduce<Json | undefined>((node, key) => {
    if (Array.isArray(node)) return node[Number(key)];
    return isTree(node) ? node[key] : undefined;
  }, document);
}
