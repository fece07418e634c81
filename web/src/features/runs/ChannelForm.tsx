/** Adds a column to the table of runs: a recorded channel in one number, of every run that has it. */

import { Button, Group, Modal, NativeSelect, Text } from "@mantine/core";
import { useState } from "react";
import { useRecorded } from "../../api/columns";
import { boundOf, NAMES } from "../../model/aggregate";
import { type Kind, nameOf } from "../../model/column";
import type { ListedRun } from "../../model/run";
import { words } from "../../model/units";
import { BoundInput, ChannelSelect } from "../../ui/ChannelFields";
import { Loading } from "../../ui/State";

interface Props {
  runs: readonly ListedRun[];
  onAdd: (name: string) => void;
}

export function ChannelForm({ runs, onAdd }: Props) {
  const { isPending, channels, events } = useRecorded(runs);
  const [chosen, setChosen] = useState<string>();
  const [kind, setKind] = useState<Kind>("max");
  const [from, setFrom] = useState("");
  const [to, setTo] = useState("");
  const [event, setEvent] = useState<string>();
  if (isPending) return <Loading what="the channels" />;
  const channel = channels.find(({ name }) => name === chosen) ?? channels.find(({ name }) => name.endsWith(".speed")) ?? channels[0];
  if (!channel) return <Text size="sm">No run has recorded a channel.</Text>;
  const [begin, end] = [boundOf(from), boundOf(to)];
  const at = kind === "at_event" ? (event ?? events[0]) : "";
  const add = () => {
    if (begin !== null && end !== null && at !== undefined) onAdd(nameOf({ channel: channel.name, kind, begin, end, event: at }));
  };
  const kinds = (Object.keys(NAMES) as Kind[]).filter((each) => each !== "at_event" || events.length > 0);
  return (
    <form
      onSubmit={(submitted) => {
        submitted.preventDefault();
        add();
      }}
    >
      <Group gap="xs" align="flex-start">
        <ChannelSelect channels={channels} value={channel.name} onChange={setChosen} />
        <NativeSelect
          size="xs"
          label="Number"
          value={kind}
          onChange={({ currentTarget: { value } }) => setKind(value as Kind)}
          data={kinds.map((each) => ({ value: each, label: NAMES[each] }))}
        />
        {kind === "at_event" ? (
          <NativeSelect
            size="xs"
            label="At the first"
            value={at}
            onChange={({ currentTarget: { value } }) => setEvent(value)}
            data={events.map((each) => ({ value: each, label: words(each) }))}
          />
        ) : null}
        <BoundInput label="From [s]" placeholder="beginning" value={from} onChange={setFrom} />
        <BoundInput label="To [s]" placeholder="end" value={to} onChange={setTo} />
      </Group>
      <Group justify="flex-end" mt="md">
        <Button type="submit" size="xs" disabled={begin === null || end === null}>
          Add the column
        </Button>
      </Group>
    </form>
  );
}

/** The same in a dialog. */
export function ChannelDialog({ isOpen, onClose, runs, onAdd }: Props & { isOpen: boolean; onClose: () => void }) {
  const add = (name: string) => {
    onAdd(name);
    onClose();
  };
  return (
    <Modal opened={isOpen} onClose={onClose} title="A column: a channel's aggregate" size="lg">
      <ChannelForm runs={runs} onAdd={add} />
    </Modal>
  );
}
