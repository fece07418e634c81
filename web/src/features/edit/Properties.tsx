/** The form of what is chosen: every value with its unit, its range and its default; what is changed is saved when one stops typing. */

import { Alert, Button, Group, ScrollArea, Text, TextInput } from "@mantine/core";
import { useQuery } from "@tanstack/react-query";
import { type ReactNode, useEffect, useMemo, useRef, useState } from "react";
import { Refusal } from "../../api/client";
import * as queries from "../../api/queries";
import { at } from "../../model/editing/deed";
import { fitted, outside, sectionAt, stepName } from "../../model/editing/form";
import { settingsFor } from "../../model/editing/fresh";
import { type Deed, type Editing, owner } from "../../model/editing/item";
import { type Exchange, exchangesOf, type Field, fieldsOf, type KnownKind, placed, type Section, sections, withChange } from "../../model/form";
import type { Changes, Json, Problem, Tree } from "../../model/run";
import { isTree, type Schema } from "../../model/schema";
import type { Point } from "../../model/view";
import { notifyError } from "../../ui/notify";
import { ProblemList } from "../../ui/Problems";
import { SchemaForm } from "../../ui/SchemaForm";
import classes from "./Edit.module.css";
import { Parts } from "./Parts";

interface Props {
  id: string;
  state: Editing;
  chosen: readonly string[];
  onDeed: (deed: Deed) => Promise<unknown>;
  onRenamed: (path: string) => void;
  middle: () => Point;
  /** Buttons above the form. */
  actions: ReactNode;
}

/** After the last key, a change is saved [ms]. */
const CALM_MS = 600;
const NONE: never[] = [];
/** What is shown of a scenario when nothing is chosen in it. */
const GENERAL = ["clock", "traffic", "weather", "goals", "applications", "radio", "messages", "recording", "map"];

export function Properties({ id, state, chosen, onDeed, onRenamed, middle, actions }: Props) {
  const schema = useQuery({ ...queries.scenario(id), staleTime: 60_000 }).data?.schema as Schema | undefined;
  const kinds = (useQuery(queries.kinds).data?.kinds ?? NONE) as KnownKind[];
  const owners = [...new Set(chosen.map(owner))];
  const path = owners.length === 1 ? (owners[0] ?? "") : "";
  const name = path ? (path.split(".")[1] ?? "") : "the scenario";
  if (owners.length > 1) return <Several names={owners} actions={actions} />;
  return (
    <section className={classes.properties} aria-label="Properties">
      <header className={classes.propertiesHead}>
        {path ? (
          <Renaming key={path} state={state} path={path} onDeed={onDeed} onRenamed={onRenamed} />
        ) : (
          <Text fw={600} size="sm" className={classes.itemName}>
            {state.title}
          </Text>
        )}
      </header>
      {actions}
      {schema ? <Form key={path} state={state} path={path} name={name} schema={schema} kinds={kinds} onDeed={onDeed} middle={middle} /> : null}
    </section>
  );
}

function Several({ names, actions }: { names: readonly string[]; actions: ReactNode }) {
  return (
    <section className={classes.properties} aria-label="Properties">
      <Text fw={600} size="sm" p="xs">
        {names.length} things are chosen
      </Text>
      {actions}
      <Text size="sm" c="dimmed" px="xs">
        {names.map((path) => path.split(".")[1]).join(", ")}
      </Text>
    </section>
  );
}

interface FormProps extends Pick<Props, "state" | "onDeed" | "middle"> {
  path: string;
  name: string;
  schema: Schema;
  kinds: readonly KnownKind[];
}

function Form({ state, path, name, schema, kinds, onDeed, middle }: FormProps) {
  const [changes, setChanges] = useState<Changes>({});
  const [refused, setRefused] = useState<readonly Problem[]>([]);
  const { document, given } = state;
  const shown = useMemo(() => {
    const all = sections({ document, given, schema, kinds, changes });
    const found = path ? [sectionAt(all, path)].filter((each) => each !== undefined) : all.filter((each) => GENERAL.includes(each.path));
    return found.map((each) => fitted(each, state));
  }, [document, given, schema, kinds, changes, path, state]);
  const wrong = useMemo(() => outside(shown), [shown]);
  // What was refused is told at its field for as long as it stands there.
  const problems = useMemo(() => {
    const paths = [...fieldsOf(shown).map((each) => each.path), ...exchangesOf(shown).map((each) => each.path)];
    return new Map([...placed(refused, paths), ...wrong]);
  }, [shown, wrong, refused]);
  const tell = useTold(setRefused);
  const save = (set: Changes, label: string) =>
    onDeed({ name: label, set })
      .then(() => {
        setRefused([]);
        setChanges((now) => Object.fromEntries(Object.entries(now).filter(([key, value]) => !(key in set && set[key] === value))));
      })
      .catch(tell);
  useCalm(changes, wrong.size === 0, () => void save(changes, stepName(shown, name)));

  const change = (field: Field, value: Json) => {
    setRefused([]);
    setChanges((before) => withChange(before, field, value));
  };
  const exchange = ({ path: place, sort, base }: Exchange, kind: string) => {
    const found = kinds.find((each) => each.sort === sort && each.name === kind);
    const before = at(document, base);
    if (!found || (sort !== "condition" && sort !== "action") || !isTree(before)) return void save({ [place]: kind }, `Exchange ${sort} of ${name}`);
    const value = settingsFor(found, (at(given, base) as Tree | undefined) ?? {}, state, middle());
    const op = at(given, base) === undefined ? "add" : "replace";
    const patch = [{ op, path: `/${base.split(".").join("/")}`, value }] as Deed["patch"] & object;
    return void onDeed({ name: `Exchange ${sort} of ${name}`, patch }).catch(tell);
  };
  const [open, setOpen] = useState<string[]>(path ? [path] : []);
  const general = problems.get("") ?? [];
  return (
    <ScrollArea className={classes.scrolled} type="auto" offsetScrollbars="y">
      {general.length > 0 ? (
        <Alert color="red" variant="outline" p="xs" m="xs" title="This cannot be">
          <ProblemList problems={[...general]} />
        </Alert>
      ) : null}
      <SchemaForm sections={titled(shown, path)} problems={problems} open={open} expanded={false} onOpen={setOpen} onChange={change} onExchange={exchange} />
      <Parts state={state} kinds={kinds} path={path} onDeed={(deed) => void onDeed(deed).catch(tell)} middle={middle} />
      {path.startsWith("script.") ? <Lists state={state} path={path} onDeed={onDeed} /> : null}
      {path.startsWith("script.") ? <Ends state={state} path={path} name={name} onDeed={onDeed} /> : null}
    </ScrollArea>
  );
}

const titled = (shown: readonly Section[], path: string): Section[] => shown.map((each) => (path ? { ...each, title: "What is set" } : each));

/** Tells a refusal: in the form while it is there and has a place for it; else, and when somebody else was quicker, by a notice. */
export function useTold(setRefused: (problems: readonly Problem[]) => void): (error: unknown) => void {
  const there = useRef(true);
  useEffect(() => {
    there.current = true;
    return () => void (there.current = false);
  }, []);
  return (error) => {
    const refusal = error instanceof Refusal ? error : undefined;
    if (there.current) setRefused(refusal?.problems ?? []);
    if (!there.current || !refusal?.problems.length || refusal.status === 409) notifyError(error as Error);
  };
}

/** Calls when what is set has not changed for a while, or when one turns to something else. */
function useCalm(changes: Changes, is: boolean, act: () => void): void {
  const latest = useRef(act);
  latest.current = act;
  const pending = useRef(false);
  pending.current = is && Object.keys(changes).length > 0;
  useEffect(
    () => () => {
      if (pending.current) latest.current();
    },
    [],
  );
  useEffect(() => {
    if (!is || Object.keys(changes).length === 0) return;
    const timer = setTimeout(() => latest.current(), CALM_MS);
    return () => clearTimeout(timer);
  }, [changes, is]);
}

/** Conditions that are made of several: one more, or one less. */
function Lists({ state, path, onDeed }: Pick<FormProps, "state" | "path" | "onDeed">) {
  const name = path.split(".")[1] ?? "";
  const found = listsIn(at(state.document, path), path);
  const run = (label: string, op: object) => void onDeed({ name: label, patch: [op] as Deed["patch"] & object }).catch(notifyError);
  return found.map(({ path: place, count }) => (
    <Group key={place} px="xs" py={4} gap={6} role="group" aria-label={`Conditions of ${place.split(".").slice(2).join(" ")}`}>
      <Text size="xs">{count} conditions together:</Text>
      <Button size="compact-xs" variant="default" disabled={count >= 16} onClick={() => run(`Add a condition to ${name}`, { op: "add", path: `${pointerOf(place)}/-`, value: { kind: "time", at: 0 } })}>
        Add one
      </Button>
      {Array.from({ length: count }, (_, number) => number).map((number) => (
        <Button key={number} size="compact-xs" variant="subtle" disabled={count < 2} onClick={() => run(`Take a condition out of ${name}`, { op: "remove", path: `${pointerOf(place)}/${number}` })}>
          Take {number + 1} out
        </Button>
      ))}
    </Group>
  ));
}

const pointerOf = (path: string): string => `/${path.split(".").join("/")}`;

/** Where lists of conditions stand within an entry. */
function listsIn(value: Json | undefined, path: string): { path: string; count: number }[] {
  if (Array.isArray(value)) return value.flatMap((each, number) => listsIn(each, `${path}.${number}`));
  if (!isTree(value)) return [];
  return Object.entries(value).flatMap(([key, each]) => [
    ...(key === "of" && Array.isArray(each) ? [{ path: `${path}.of`, count: each.length }] : []),
    ...listsIn(each, `${path}.${key}`),
  ]);
}

/** An entry of the script may end by a condition of its own, or with its action. */
export function Ends({ state, path, name, onDeed }: Pick<FormProps, "state" | "path" | "name" | "onDeed">) {
  const has = isTree(at(state.document, `${path}.until`));
  const place = `/${path.split(".").join("/")}/until`;
  const end = { kind: "time", at: Math.max(1, Math.round(state.duration / 2)) };
  const patch = (has ? [{ op: "remove", path: place }] : [{ op: "add", path: place, value: end }]) as Deed["patch"] & object;
  return (
    <Group px="xs" py={4}>
      <Button size="compact-xs" variant="default" onClick={() => void onDeed({ name: `${has ? "Let" : "End"} ${name}${has ? " go on" : ""}`, patch }).catch(notifyError)}>
        {has ? "Take the end condition away" : "Add an end condition"}
      </Button>
    </Group>
  );
}

/** What names a thing is renamed with it. */
export function Renaming({ state, path, onDeed, onRenamed }: Pick<FormProps, "state" | "path" | "onDeed"> & Pick<Props, "onRenamed">) {
  const [part = "", name = ""] = path.split(".");
  const [text, setText] = useState(name);
  const taken = Object.keys((at(state.given, part) as Tree | undefined) ?? {}).filter((each) => each !== name);
  const wrong = nameWrong(text, taken);
  const rename = () => {
    if (wrong || text === name) return setText(name);
    const next = `${part}.${text}`;
    void onDeed({ name: `Rename ${name} to ${text}`, rename: { [path]: text } }).then(
      () => onRenamed(next),
      (error: Error) => {
        setText(name);
        notifyError(error);
      },
    );
  };
  return (
    <TextInput
      size="xs"
      aria-label="Name"
      className={classes.nameEntry}
      value={text}
      error={text === name ? undefined : wrong}
      onChange={(event) => setText(event.currentTarget.value)}
      onBlur={rename}
      onKeyDown={(event) => {
        if (event.key === "Enter") event.currentTarget.blur();
        if (event.key === "Escape") setText(name);
      }}
    />
  );
}

/** What is wrong with a name within a scenario; nothing when it may be. */
function nameWrong(name: string, taken: readonly string[]): string | undefined {
  if (!/^[A-Za-z][A-Za-z0-9_]*$/.test(name)) return "A letter first, then letters, digits and _";
  if (name.length > 40) return "At most 40 characters";
  return taken.includes(name) ? "This name is taken" : undefined;
}
