/** A number field that may stand empty, or at a lone sign, while one thinks; how a text was read is told where it might surprise. */

import { Text, TextInput, type TextInputProps, UnstyledButton } from "@mantine/core";
import { type KeyboardEvent, useState } from "react";
import { entryText, readEntry, stepped } from "../model/entry";
import { Icon } from "./Icon";
import classes from "./NumberEntry.module.css";

interface Props extends Omit<TextInputProps, "value" | "onChange" | "onBlur" | "onKeyDown"> {
  value: number | "";
  onNumber: (value: number) => void;
  /** The field was left, or escaped from, without a number. */
  onEmpty: () => void;
  /** There is no number in the field now: for who must not go on with the one of before. */
  onNothing?: () => void;
  /** Behind the number in the field. */
  unit?: string;
  whole?: boolean;
  /** So many are shown, at most. */
  decimals?: number;
  /** A step of the arrow keys and of the buttons; none: there are none. */
  step?: number;
  /** Where these steps end; what is typed may be beyond. */
  min?: number;
  max?: number;
}

/** What stands in the field while one types, and which value was there before. */
interface Typing {
  text: string;
  before: number | "";
  /** Whether it is no number, so that leaving it is. */
  isOpen: boolean;
}

export function NumberEntry({ value, onNumber, onEmpty, onNothing, unit, whole, decimals, step, min, max, error, ...others }: Props) {
  const [typing, setTyping] = useState<Typing>();
  // It is about a value, and goes with it.
  const [remark, setRemark] = useState<{ text: string; of: number | "" }>();
  const take = (text: string) => {
    const before = typing ? typing.before : value;
    const entry = readEntry(text, { ...(unit ? { unit } : {}), ...(whole ? { whole } : {}) });
    setTyping({ text, before, isOpen: entry.is === "unfinished" });
    if (entry.is === "unfinished") setRemark(undefined);
    else setRemark({ text: entry.remark, of: entry.is === "number" ? entry.value : onNothing ? "" : before });
    if (entry.is === "number") onNumber(entry.value);
    else if (onNothing) onNothing();
    // What was read of a beginning of it counts no more.
    else if (entry.is === "refused" && before !== "" && before !== value) onNumber(before);
  };
  const leave = () => {
    setTyping(undefined);
    if (typing?.isOpen) onEmpty();
  };
  const go = (steps: number) => {
    if (step === undefined || others.disabled) return;
    setTyping(undefined);
    setRemark(undefined);
    onNumber(stepped(value === "" ? 0 : value, steps * step, min, max));
  };
  const onKeyDown = (event: KeyboardEvent) => {
    if (event.key === "Escape" || event.key === "Enter") leave();
    if (step === undefined || (event.key !== "ArrowUp" && event.key !== "ArrowDown")) return;
    event.preventDefault();
    go(event.key === "ArrowUp" ? 1 : -1);
  };
  return (
    <>
      <TextInput
        {...others}
        inputMode="decimal"
        autoComplete="off"
        error={error}
        value={typing?.text ?? entryText(value, { ...(unit ? { unit } : {}), decimals })}
        onChange={(event) => take(event.currentTarget.value)}
        onBlur={leave}
        onKeyDown={onKeyDown}
        {...(step === undefined ? {} : { rightSection: <Steps onStep={go} />, rightSectionWidth: 20 })}
      />
      {remark?.text && remark.of === value ? (
        <Text size="xs" role="status" className={classes.remark}>
          {remark.text}
        </Text>
      ) : null}
    </>
  );
}

/** For the mouse; the keyboard has its arrows. */
function Steps({ onStep }: { onStep: (steps: number) => void }) {
  return (
    <span className={classes.steps} aria-hidden="true">
      {([1, -1] as const).map((way) => (
        <UnstyledButton key={way} tabIndex={-1} onMouseDown={(event) => event.preventDefault()} onClick={() => onStep(way)}>
          <Icon name={way > 0 ? "up" : "down"} size={10} />
        </UnstyledButton>
      ))}
    </span>
  );
}
