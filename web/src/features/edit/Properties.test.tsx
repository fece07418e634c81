import { MantineProvider } from "@mantine/core";
import { act, type ReactNode } from "react";
import { createRoot, type Root } from "react-dom/client";
import { afterEach, beforeEach, expect, test, vi } from "vitest";
import { Refusal } from "../../api/client";
import type { Editing } from "../../model/editing/item";
import { notifyError } from "../../ui/notify";
import { Ends, Renaming, useTold } from "./Properties";

vi.mock("../../ui/notify", () => ({ notify: vi.fn(), notifyError: vi.fn() }));

const given = { vehicles: { ego: {} }, script: { stop: { do: { kind: "mark" } } } };
const state = { document: given, given, duration: 30 } as unknown as Editing;
const refusal = new Refusal("stop cannot be changed.", [{ where: "script.stop", what: "is sealed" }] as never, 422);
const refusing = () => Promise.reject(refusal);

let host: HTMLElement;
let root: Root;
beforeEach(() => {
  vi.mocked(notifyError).mockClear();
  host = document.body.appendChild(document.createElement("div"));
  root = createRoot(host);
});
afterEach(() => {
  act(() => root.unmount());
  host.remove();
});
const render = (node: ReactNode) => act(() => root.render(<MantineProvider env="test">{node}</MantineProvider>));

test("a refused end condition is told", async () => {
  render(<Ends state={state} path="script.stop" name="stop" onDeed={refusing} />);
  await act(async () => host.querySelector("button")?.click());
  expect(notifyError).toHaveBeenCalledWith(refusal);
});

test("a refused name tells why, and the name stands there again", async () => {
  render(<Renaming state={state} path="vehicles.ego" onDeed={refusing} onRenamed={vi.fn()} />);
  const field = host.querySelector("input") as HTMLInputElement;
  act(() => field.focus());
  Object.getOwnPropertyDescriptor(HTMLInputElement.prototype, "value")?.set?.call(field, "boss");
  act(() => void field.dispatchEvent(new Event("input", { bubbles: true })));
  await act(async () => field.blur());
  expect(notifyError).toHaveBeenCalledWith(refusal);
  expect(field.value).toBe("ego");
});

test("what a form is refused stands in it while it is there, and is told by a notice when it is not", () => {
  const setRefused = vi.fn();
  let tell: (error: unknown) => void = () => undefined;
  const Form = () => {
    tell = useTold(setRefused);
    return null;
  };
  render(<Form />);
  tell(refusal);
  expect(setRefused).toHaveBeenCalledWith(refusal.problems);
  expect(notifyError).not.toHaveBeenCalled();
  tell(new Error("The studio server does not answer."));
  expect(notifyError).toHaveBeenCalledTimes(1);
  render(null);
  tell(refusal);
  expect(notifyError).toHaveBeenLastCalledWith(refusal);
  expect(setRefused).toHaveBeenCalledTimes(2);
});
