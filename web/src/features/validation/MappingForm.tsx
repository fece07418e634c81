/** Which recorded signal is which of ours, in what unit, with what sign, offset, delay and place; kept as mapping.yaml of the project. */

import { Button, NativeSelect, Text } from "@mantine/core";
import { useQuery } from "@tanstack/react-query";
import { useState } from "react";
import { usePatch, usePutFile, validationKinds } from "../../api/validations";
import { words } from "../../model/units";
import { chosen, guesses, type Kinds, type Mapping, mappingText, PLACED, placedAt, type Project, type Said, type SourceEntry, sourcesOf } from "../../model/validation";
import { NumberEntry } from "../../ui/NumberEntry";
import { notify, notifyError } from "../../ui/notify";
import { Loading } from "../../ui/State";
import classes from "./Validation.module.css";

const AXES = ["x", "y", "z"] as const;
const FILE = "mapping.yaml";

interface Props {
  project: Project;
  said: Said | null;
  recorded: readonly { name: string; unit: string }[];
  /** That the log was looked at with; the form begins with it, else with guesses. */
  mapping: Mapping | null;
  onSaved: () => void;
}

export function MappingForm(props: Props) {
  const kinds = useQuery(validationKinds).data;
  return kinds ? <Form {...props} kinds={kinds} /> : <Loading what="our signals" />;
}

function Form({ project, said, recorded, mapping, kinds, onSaved }: Props & { kinds: Kinds }) {
  const [sources, setSources] = useState(() => (mapping ? sourcesOf(mapping, kinds) : guesses(recorded, kinds)));
  const put = usePutFile(project.name);
  const patch = usePatch(project.name, project.digest);
  const target = said?.mapping ?? FILE;
  const exists = project.files.some(({ name }) => name === target);
  const save = async () => {
    try {
      await put.mutateAsync({ name: target, content: mappingText(sources, mapping?.dbc), replace: true });
      // A project that has changed has its log looked at anew anyway.
      if (said && said.mapping === null) await patch.mutateAsync([{ op: "add", path: "/mapping", value: target }]);
      else onSaved();
      notify("Saved", `The logs are read by ${target} now.`);
    } catch (error) {
      notifyError(error as Error);
    }
  };
  const set = (name: string, change: Partial<SourceEntry>) =>
    setSources({ ...sources, [name]: { ...(sources[name] as SourceEntry), ...change } });
  const taken = Object.values(sources).filter(({ from }) => from.length > 0).length;
  return (
    <div className={classes.stack}>
      <div className={classes.scroll}>
        <table className={classes.table} data-testid="mapping">
          <thead>
            <tr>
              <th scope="col">Ours</th>
              <th scope="col">Recorded signal</th>
              <th scope="col">Recorded in</th>
              <th scope="col">Sign</th>
              <th scope="col">At rest it shows</th>
              <th scope="col">Comes late by</th>
              <th scope="col" title="Forward, left and up from the centre of gravity; what it shows is brought there with the yaw rate">
                Sits at x, y, z [m]
              </th>
            </tr>
          </thead>
          <tbody>
            {kinds.signals.map(({ name, unit, units, meaning }) => {
              const source = sources[name];
              if (!source) return null;
              const off = source.from.length === 0;
              return (
                <tr key={name}>
                  <th scope="row" title={`${meaning} [${unit}]`}>
                    {words(name)}
                  </th>
                  <td>
                    <NativeSelect
                      size="xs"
                      aria-label={`${words(name)} comes from`}
                      value={keyOf(source)}
                      data={[{ value: "", label: "–" }, ...severalOf(source, recorded), ...recorded.map((each) => ({ value: each.name, label: each.name }))]}
                      onChange={({ currentTarget: { value } }) => value !== keyOf(source) && set(name, chosen(value, recorded, units))}
                    />
                  </td>
                  <td>
                    <NativeSelect
                      size="xs"
                      aria-label={`${words(name)} is recorded in`}
                      disabled={off}
                      value={source.unit}
                      data={units.includes(source.unit) ? units : [{ value: source.unit, label: source.unit || "as the log says" }, ...units]}
                      onChange={({ currentTarget: { value } }) => set(name, { unit: value })}
                    />
                  </td>
                  <td>
                    <NativeSelect
                      size="xs"
                      aria-label={`Sign of ${words(name)}`}
                      disabled={off}
                      value={String(source.sign)}
                      data={[
                        { value: "1", label: "as ours" },
                        { value: "-1", label: "turned round" },
                      ]}
                      onChange={({ currentTarget: { value } }) => set(name, { sign: value === "-1" ? -1 : 1 })}
                    />
                  </td>
                  <td>
                    <NumberEntry
                      size="xs"
                      w={110}
                      aria-label={`Offset of ${words(name)}`}
                      disabled={off}
                      value={source.offset}
                      unit={source.unit === "1" ? "" : source.unit}
                      onNumber={(offset) => set(name, { offset })}
                      onEmpty={() => set(name, { offset: 0 })}
                    />
                  </td>
                  <td>
                    <NumberEntry
                      size="xs"
                      w={100}
                      aria-label={`Delay of ${words(name)}`}
                      disabled={off}
                      value={source.delay}
                      unit="s"
                      onNumber={(delay) => set(name, { delay })}
                      onEmpty={() => set(name, { delay: 0 })}
                    />
                  </td>
                  <td>
                    {PLACED.has(name) ? (
                      <div className={classes.place}>
                        {AXES.map((axis, i) => (
                          <NumberEntry
                            key={axis}
                            size="xs"
                            w={64}
                            aria-label={`${axis} of the sensor of ${words(name)}`}
                            disabled={off}
                            value={source.at?.[i] ?? 0}
                            onNumber={(value) => set(name, { at: placedAt(source.at, i, value) })}
                            onEmpty={() => set(name, { at: placedAt(source.at, i, 0) })}
                          />
                        ))}
                      </div>
                    ) : null}
                  </td>
                </tr>
              );
            })}
          </tbody>
        </table>
      </div>
      <div className={classes.row}>
        <Button size="xs" disabled={taken === 0} loading={put.isPending || patch.isPending} onClick={() => void save()}>
          Save as {target}
        </Button>
        <Text size="xs" c="dimmed">
          {taken === 0
            ? "Choose at least one signal."
            : `${taken} signals are taken${mapping ? `, as ${target} says` : "; names were guessed, so look at each"}.${exists ? ` ${target} is replaced.` : ""}`}
        </Text>
      </div>
    </div>
  );
}

const SEPARATOR = ", ";
const keyOf = ({ from }: SourceEntry): string => from.join(SEPARATOR);

/** What a mapping takes that is no recorded signal of this log: several together, or one of other logs. */
function severalOf(source: SourceEntry, recorded: Props["recorded"]): { value: string; label: string }[] {
  const { from, combine } = source;
  if (from.length === 0 || (from.length === 1 && recorded.some(({ name }) => name === from[0]))) return [];
  const label = from.length === 1 ? `${from[0]} (not in this log)` : `${combine === "norm" ? "length" : "mean"} of ${keyOf(source)}`;
  return [{ value: keyOf(source), label }];
}
