/** What has a name of its own and no place on the plan: applications and goals of the scenario, sensors of a unit. Added and taken out here. */

import { ActionIcon, Button, Group, NativeSelect, Select, Text, Tooltip } from "@mantine/core";
import { useState } from "react";
import { settingsFor } from "../../model/editing/fresh";
import type { Deed, Editing } from "../../model/editing/item";
import { freeName, kindsOf, partsAt, unitOf, unitsFor, withoutPart, withPart } from "../../model/editing/part";
import type { KnownKind } from "../../model/form";
import type { Tree } from "../../model/run";
import { unitText } from "../../model/units";
import type { Point } from "../../model/view";
import { Icon } from "../../ui/Icon";
import { byTitleOrName } from "../../ui/named";
import { NumberEntry } from "../../ui/NumberEntry";
import classes from "./Edit.module.css";

interface Props {
  state: Editing;
  kinds: readonly KnownKind[];
  /** Of a vehicle or a station; that of the scenario when it is empty. */
  path: string;
  onDeed: (deed: Deed) => void;
  middle: () => Point;
}

export function Parts(props: Props) {
  if (props.path === "") {
    return (
      <>
        <Applications {...props} />
        <Goals {...props} />
      </>
    );
  }
  return /^(vehicles|stations)\./.test(props.path) ? <SensorParts {...props} /> : null;
}

function Applications({ state, kinds, onDeed }: Props) {
  const add = (kind: string) => {
    const [name, units] = [freeName(state, "applications", kind), unitsFor(state)];
    onDeed({ name: `Add ${name} to ${units.join(", ")}`, patch: withPart(state, "applications", name, { application: kind, units }) });
  };
  return (
    <Listed title="Applications" base="applications" state={state} onDeed={onDeed}>
      <Adder label="Another application" data={kindsOf(kinds, "application")} onAdd={add} />
    </Listed>
  );
}

function SensorParts({ state, kinds, path, onDeed, middle }: Props) {
  const base = `${path}.sensors`;
  const add = (kind: string) => {
    const found = kinds.find((each) => each.sort === "sensor" && each.name === kind);
    if (!found) return;
    const name = freeName(state, base, kind);
    onDeed({ name: `Add ${name} to ${path.split(".")[1]}`, patch: withPart(state, base, name, settingsFor(found, {}, state, middle())) });
  };
  return (
    <Listed title="Sensors" base={base} state={state} onDeed={onDeed}>
      <Adder label="Another sensor" data={kindsOf(kinds, "sensor")} onAdd={add} />
    </Listed>
  );
}

function Goals({ state, kinds, onDeed }: Props) {
  const [measure, setMeasure] = useState<string | null>(null);
  const [bound, setBound] = useState("least");
  const [value, setValue] = useState<number | "">("");
  const there = partsAt(state, "goals");
  const unit = unitText(unitOf(kinds, measure));
  const add = () => {
    if (measure === null || value === "") return;
    const goal: Tree = { [bound]: value };
    onDeed({ name: `Add a goal for ${measure}`, patch: withPart(state, "goals", measure, goal) });
    setMeasure(null);
    setValue("");
  };
  return (
    <Listed title="Goals" base="goals" state={state} onDeed={onDeed}>
      <Select
        size="xs"
        label="Goal for"
        placeholder="a measure"
        searchable
        nothingFoundMessage="No measure is called that."
        filter={byTitleOrName}
        data={kindsOf(kinds, "metric").filter((each) => !there.includes(each.value))}
        value={measure}
        onChange={setMeasure}
      />
      <Group gap={6} align="end" wrap="nowrap">
        <NativeSelect
          size="xs"
          w={96}
          aria-label="Bound of the goal"
          data={[
            { value: "least", label: "at least" },
            { value: "most", label: "at most" },
          ]}
          value={bound}
          onChange={(event) => setBound(event.currentTarget.value)}
        />
        <NumberEntry className={classes.grows} size="xs" aria-label="Value of the goal" unit={unit || undefined} value={value} onNumber={setValue} onEmpty={() => setValue("")} />
      </Group>
      <Button size="xs" variant="default" disabled={measure === null || value === ""} onClick={add}>
        Add the goal
      </Button>
    </Listed>
  );
}

interface ListedProps extends Pick<Props, "state" | "onDeed"> {
  title: string;
  base: string;
  children: React.ReactNode;
}

/** The parts that are there, each to be taken out, and how one more is added. */
function Listed({ title, base, state, onDeed, children }: ListedProps) {
  return (
    <section className={classes.parts} aria-label={`${title}: add and take out`}>
      <Text size="xs" fw={600}>
        {title}
      </Text>
      {partsAt(state, base).map((name) => (
        <Group key={name} gap={4} justify="space-between" wrap="nowrap">
          <Text size="xs" truncate>
            {name}
          </Text>
          <Tooltip label={`Take ${name} out`}>
            <ActionIcon size={24} variant="subtle" color="gray" aria-label={`Take ${name} out`} onClick={() => onDeed({ name: `Take ${name} out`, patch: withoutPart(state, base, name) })}>
              <Icon name="trash" size={13} />
            </ActionIcon>
          </Tooltip>
        </Group>
      ))}
      {children}
    </section>
  );
}

interface AdderProps {
  label: string;
  data: { value: string; label: string }[];
  onAdd: (value: string) => void;
}

function Adder({ label, data, onAdd }: AdderProps) {
  const [chosen, setChosen] = useState<string | null>(null);
  return (
    <Group gap={6} align="end" wrap="nowrap">
      <Select className={classes.grows} size="xs" label={label} placeholder="choose" searchable nothingFoundMessage="No kind is called that." filter={byTitleOrName} data={data} value={chosen} onChange={setChosen} />
      <Button
        size="xs"
        variant="default"
        disabled={chosen === null}
        onClick={() => {
          if (chosen === null) return;
          onAdd(chosen);
          setChosen(null);
        }}
      >
        Add it
      </Button>
    </Group>
  );
}
