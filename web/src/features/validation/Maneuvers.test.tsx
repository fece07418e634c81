import { MantineProvider } from "@mantine/core";
import { act } from "react";
import { createRoot, type Root } from "react-dom/client";
import { afterEach, beforeEach, expect, test, vi } from "vitest";
import { Refusal } from "../../api/client";
import type { Run } from "../../model/validation";
import { RunRow } from "./Maneuvers";

let host: HTMLElement;
let root: Root;
const onRun = vi.fn((_: Run) => Promise.resolve());
const run: Run = { log: "day.csv", begin: 10, end: 68, mapping: null };

beforeEach(() => {
  onRun.mockClear();
  host = document.body.appendChild(document.createElement("div"));
  root = createRoot(host);
  act(() =>
    root.render(
      <MantineProvider env="test">
        <table>
          <tbody>
            <RunRow set="validation" run={run} onLog={vi.fn()} onRun={onRun} onRemove={vi.fn()} />
          </tbody>
        </table>
      </MantineProvider>,
    ),
  );
});
afterEach(() => {
  act(() => root.unmount());
  host.remove();
});

const field = (what: string) => host.querySelector<HTMLInputElement>(`[aria-label="${what} of day.csv for validation"]`) as HTMLInputElement;

/** Type into a field, key by key. */
function type(input: HTMLInputElement, text: string) {
  act(() => input.focus());
  for (let end = 0; end <= text.length; end++) {
    Object.getOwnPropertyDescriptor(HTMLInputElement.prototype, "value")?.set?.call(input, text.slice(0, end));
    act(() => void input.dispatchEvent(new Event("input", { bubbles: true })));
  }
}

test("a time is sent once, when one leaves the row", async () => {
  type(field("Begin"), "61.5");
  act(() => field("End").focus());
  expect(onRun).not.toHaveBeenCalled();
  expect(field("Begin").value).toContain("61.5");
  type(field("End"), "66.25");
  await act(async () => field("End").blur());
  expect(onRun.mock.calls).toEqual([[{ ...run, begin: 61.5, end: 66.25 }]]);
});

test("Enter sends it at once, and leaving the row does not send it again", async () => {
  type(field("Begin"), "61.5");
  act(() => void field("Begin").dispatchEvent(new KeyboardEvent("keydown", { key: "Enter", bubbles: true })));
  await act(async () => field("Begin").blur());
  expect(onRun).toHaveBeenCalledTimes(1);
});

test("an end that is emptied is the end of the log", async () => {
  type(field("End"), "");
  await act(async () => field("End").blur());
  expect(onRun.mock.calls).toEqual([[{ ...run, end: null }]]);
});

test("what is refused stays as it was typed, and says why", async () => {
  const problem = { where: "maneuvers.turn.validation.0.end", what: "is beyond day.csv", value: "99 s", allowed: "0 to 80.00 s", remedy: "" };
  onRun.mockRejectedValueOnce(new Refusal("A run is cut from more than was recorded.", [problem], 422));
  type(field("End"), "99");
  await act(async () => field("End").blur());
  expect(field("End").value).toContain("99");
  expect(host.querySelector("[role=alert]")?.textContent).toContain("0 to 80.00 s");
  type(field("End"), "79");
  expect(host.querySelector("[role=alert]")).toBeNull();
});
