/** Fields by which a recorded channel, or a part of it, is chosen. */

import { Select, TextInput } from "@mantine/core";
import { boundOf } from "../model/aggregate";
import { withUnit } from "../model/units";

/** So many channels are listed at a time; the rest is found by typing. */
const LISTED = 100;

interface ChannelProps {
  channels: readonly { name: string; unit: string }[];
  value: string;
  onChange: (name: string | undefined) => void;
}

export function ChannelSelect({ channels, value, onChange }: ChannelProps) {
  return (
    <Select
      size="xs"
      w={240}
      searchable
      limit={LISTED}
      allowDeselect={false}
      label="Channel"
      value={value}
      onChange={(name) => onChange(name ?? undefined)}
      data={channels.map(({ name, unit }) => ({ value: name, label: withUnit(name, unit) }))}
    />
  );
}

interface BoundProps {
  label: string;
  placeholder: string;
  value: string;
  onChange: (value: string) => void;
}

/** A time that may be left open [s]. */
export function BoundInput({ label, placeholder, value, onChange }: BoundProps) {
  const error = boundOf(value) === null ? "a number of seconds, such as 12.5" : undefined;
  return <TextInput size="xs" w={90} label={label} placeholder={placeholder} value={value} error={error} onChange={(at) => onChange(at.currentTarget.value)} />;
}
