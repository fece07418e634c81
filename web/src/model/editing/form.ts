/** The form of what is chosen: its part of the scenario's form, with names to choose from, and what a number may be. */

import { type Field, fieldsOf, type Section } from "../form";
import type { Problem } from "../run";
import { isTree } from "../schema";
import { namesOf } from "./fresh";
import type { Editing } from "./item";

/** The section at a path, however deep. */
export function sectionAt(all: readonly Section[], path: string): Section | undefined {
  for (const section of all) {
    if (section.path === path) return section;
    const found = path.startsWith(`${section.path}.`) ? sectionAt(section.sections, path) : undefined;
    if (found) return found;
  }
  return undefined;
}

/** Fields that name something are chosen from what there is; corners, which are dragged on the plan, are left out. */
export function fitted(section: Section, state: Editing): Section {
  const named = (field: Field): Field => {
    const names = field.names ? namesOf(state, field.names) : [];
    return names.length > 0 ? { ...field, kind: "choice", choices: names } : field;
  };
  return {
    ...section,
    fields: section.fields.filter((field) => !isDrawn(field) && !isOtherWay(field, section)).map(named),
    sections: section.sections.map((inner) => fitted(inner, state)),
  };
}

/**
 * Where something is can be said in several ways, of which one is used: along a route or on a road, as a circle, by corners or on a road.
 * The fields of the others are left out, for the plan is where one changes that.
 */
function isOtherWay(field: Field, { fields }: Section): boolean {
  const valueOf = (key: string) => fields.find(({ path }) => path.endsWith(`.${key}`))?.value;
  const key = field.path.slice(field.path.lastIndexOf(".") + 1);
  const isSpot = "road along aside x y".split(" ").every((each) => valueOf(each) !== undefined);
  const isPlace = !isSpot && "along road lane offset".split(" ").every((each) => valueOf(each) !== undefined);
  const isArea = "x y radius corners road".split(" ").every((each) => valueOf(each) !== undefined);
  if (isPlace) return (key === "along") !== (typeof valueOf("along") === "number") && !field.changed;
  if (!isSpot && !isArea) return false;
  const onRoad = typeof valueOf("road") === "string";
  if ("road along aside lane start end".split(" ").includes(key)) return !onRoad;
  if (key === "corners") return true;
  return typeof valueOf("x") !== "number";
}

const isDrawn = ({ value, kind }: Field): boolean => kind === "list" && Array.isArray(value) && value.some((each) => Array.isArray(each));

/** Numbers beyond their range, told at their field before anybody is asked. */
export function outside(sections: readonly Section[]): Map<string, Problem[]> {
  const wrong = fieldsOf(sections).filter(({ changed, value, minimum, maximum }) => {
    if (!changed || typeof value !== "number") return false;
    return (minimum !== undefined && value < minimum) || (maximum !== undefined && value > maximum);
  });
  return new Map(wrong.map((field) => [field.path, [problemOf(field)]]));
}

const problemOf = ({ path, value, allowed }: Field): Problem => ({
  where: path,
  what: "is out of range, and was not saved",
  value: String(value),
  allowed,
  remedy: "",
});

/** The name of the step that a form makes. */
export function stepName(sections: readonly Section[], name: string): string {
  const changed = fieldsOf(sections).filter((field) => field.changed);
  const [only] = changed;
  return changed.length === 1 && only ? `Change ${only.label.toLowerCase()} of ${name}`.slice(0, 120) : `Change ${changed.length} values of ${name}`.slice(0, 120);
}

/** Whether a condition or an action stands at a place, so that it can be exchanged. */
export const isKind = (value: unknown): boolean => isTree(value as never) && "kind" in (value as object);
