/** Which quantity a chart shows. */

import { NativeSelect } from "@mantine/core";
import { type Quantity, quantity } from "../model/channel";
import { withUnit } from "../model/units";

interface Props {
  value: string;
  quantities: readonly Quantity[];
  onChange: (name: string) => void;
}

export function QuantitySelect({ value, quantities, onChange }: Props) {
  return (
    <NativeSelect
      size="xs"
      w={208}
      aria-label="Quantity of this chart"
      title={quantity(value, quantities).meaning}
      value={value}
      onChange={(event) => onChange(event.currentTarget.value)}
      data={quantities.map(({ name, label, unit }) => ({ value: name, label: withUnit(label, unit) }))}
    />
  );
}
