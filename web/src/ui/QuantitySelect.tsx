/** Which quantity a chart shows. */

import { NativeSelect } from "@mantine/core";
import { type Quantity, quantity } from "../model/channel";
import { withUnit } from "../model/units";

interface Props {
  value: string;
  quantities: readonly Quantity[];
  onChange: (name: string) => void;
  label?: string;
}

export function QuantitySelect({ value, quantities, onChange, label = "Quantity of this chart" }: Props) {
  const data = quantities.map(({ name, label, unit }) => ({ value: name, label: withUnit(label, unit) }));
  // Chosen for another run, of other sensors perhaps: the select must not show what the chart does not.
  if (!quantities.some(({ name }) => name === value))
    data.push({ value, label: `${quantity(value, quantities).label} (not recorded)` });
  return (
    <NativeSelect
      size="xs"
      w={208}
      aria-label={label}
      title={quantity(value, quantities).meaning}
      value={value}
      onChange={(event) => onChange(event.currentTarget.value)}
      data={data}
    />
  );
}
