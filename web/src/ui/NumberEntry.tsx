/** A number field that may stand empty, or at a lone sign, while one thinks. */

import { NumberInput, type NumberInputProps } from "@mantine/core";
import { useState } from "react";

interface Props extends Omit<NumberInputProps, "value" | "onChange" | "onBlur" | "onKeyDown"> {
  value: number | "";
  onNumber: (value: number) => void;
  /** The field was left, or escaped from, without a number. */
  onEmpty: () => void;
}

export function NumberEntry({ value, onNumber, onEmpty, ...others }: Props) {
  // What stands in the field and is no number yet.
  const [unfinished, setUnfinished] = useState<string>();
  const take = (next: number | string) => {
    const text = String(next);
    const known = text.trim() !== "" && Number.isFinite(Number(text));
    setUnfinished(known ? undefined : text);
    if (known) onNumber(Number(text));
  };
  const leave = () => {
    if (unfinished === undefined) return;
    setUnfinished(undefined);
    onEmpty();
  };
  return (
    <NumberInput
      {...others}
      value={unfinished ?? value}
      onChange={take}
      onBlur={leave}
      onKeyDown={({ key }) => key === "Escape" && leave()}
    />
  );
}
