/** The part of JSON Schema (draft 2020-12) that scenario documents use. */

import type { Json } from "./run";

export interface Schema {
  $ref?: string;
  $defs?: Record<string, Schema>;
  type?: string | string[];
  title?: string;
  description?: string;
  unit?: string;
  /** What of the scenario a text names: a vehicle, a route, an entry of the script. */
  names?: string;
  /** Of a slot: of which sort the kind is that is chosen there. */
  sort?: string;
  default?: Json;
  const?: Json;
  enum?: Json[];
  examples?: Json[];
  minimum?: number;
  maximum?: number;
  exclusiveMinimum?: number;
  exclusiveMaximum?: number;
  multipleOf?: number;
  properties?: Record<string, Schema>;
  patternProperties?: Record<string, Schema>;
  additionalProperties?: Schema | boolean;
  items?: Schema | boolean;
  prefixItems?: Schema[];
  anyOf?: Schema[];
  oneOf?: Schema[];
  allOf?: Schema[];
  readOnly?: boolean;
}

/** Follow references and choose among alternatives, until a plain schema is left for this value. */
export function resolve(schema: Schema, root: Schema, value: Json | undefined): Schema {
  if (schema.$ref) {
    const { $ref, ...own } = schema;
    return resolve({ ...pointed($ref, root), ...own }, root, value);
  }
  if (schema.allOf) {
    const { allOf, ...own } = schema;
    const merged: Schema = Object.assign({}, ...allOf.map((part) => resolve(part, root, value)));
    return resolve({ ...merged, ...own }, root, value);
  }
  const options = schema.anyOf ?? schema.oneOf;
  if (!options) return schema;
  const { anyOf: _any, oneOf: _one, ...own } = schema;
  const resolved = options
    .map((option) => resolve(option, root, value))
    .filter((option) => option.type !== "null");
  const chosen = resolved.find((option) => fits(option, value)) ?? resolved[0] ?? {};
  return { ...chosen, ...own };
}

/** The schema that `#/$defs/Name` points to. */
function pointed(reference: string, root: Schema): Schema {
  const steps = reference.replace(/^#\//, "").split("/");
  const found = steps.reduce<unknown>(
    (node, step) => (node as Record<string, unknown> | undefined)?.[step],
    root,
  );
  return (found as Schema | undefined) ?? {};
}

/** Whether a value could be of this alternative: by type, and by constants that name a variant. */
function fits(schema: Schema, value: Json | undefined): boolean {
  if (!ofType(schema, value)) return false;
  if (schema.const !== undefined) return schema.const === value;
  if (!isTree(value)) return true;
  return Object.entries(schema.properties ?? {}).every(
    ([key, property]) => property.const === undefined || property.const === value[key],
  );
}

function ofType(schema: Schema, value: Json | undefined): boolean {
  const types = schema.type === undefined ? [] : [schema.type].flat();
  if (types.length === 0) return true;
  return types.some((type) => (type === "integer" ? "number" : type) === jsonType(value));
}

function jsonType(value: Json | undefined): string {
  if (value === null || value === undefined) return "null";
  if (Array.isArray(value)) return "array";
  return typeof value === "object" ? "object" : typeof value;
}

/** Whether a value is an object with keys. */
export function isTree(value: Json | undefined): value is { [key: string]: Json } {
  return typeof value === "object" && value !== null && !Array.isArray(value);
}
