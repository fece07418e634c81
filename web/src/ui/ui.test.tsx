import { MantineProvider } from "@mantine/core";
import { act, type ReactNode } from "react";
import { createRoot, type Root } from "react-dom/client";
import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import { sections } from "../model/form";
import { metric, source } from "../test/scenario";
import { ExplanationList } from "./ExplanationList";
import { MetricList } from "./MetricList";
import { QuantitySelect } from "./QuantitySelect";
import { SchemaForm } from "./SchemaForm";
import { Failure } from "./State";
import { lastLine } from "./StatusBadge";
import { dispatch } from "./shortcut";

let host: HTMLElement;
let root: Root;
beforeEach(() => {
  host = document.body.appendChild(document.createElement("div"));
  root = createRoot(host);
});
afterEach(() => {
  act(() => root.unmount());
  host.remove();
});
const render = (node: ReactNode) =>
  act(() => root.render(<MantineProvider env="test">{node}</MantineProvider>));
const byTestId = (id: string) => host.querySelector<HTMLInputElement>(`[data-testid="${id}"]`);

/** Type into an input the way React notices. */
function type(input: HTMLInputElement | HTMLSelectElement, value: string) {
  const prototype =
    input instanceof HTMLSelectElement ? HTMLSelectElement.prototype : HTMLInputElement.prototype;
  Object.getOwnPropertyDescriptor(prototype, "value")?.set?.call(input, value);
  act(
    () =>
      void input.dispatchEvent(
        new Event(input instanceof HTMLSelectElement ? "change" : "input", { bubbles: true }),
      ),
  );
}

describe("why it happened", () => {
  it("tells each event, and behind it one sentence after another", () => {
    const known = { unit: "car_2", about: "car_1", source: "front", age: 0.1, time: 4.9, what: {}, lost: [] };
    render(
      <ExplanationList
        explanations={[
          {
            event: "near_miss",
            time: 5,
            began: 4.5,
            text: "comes near car_1: 0.92 s to a collision",
            units: ["car_2", "car_1"],
            known: [known],
            commanded_by: { car_2: { brake: "platoon" } },
            asked: [],
            tyre_at_limit: [],
            without_tyres: [],
            faults: [],
            not_recorded: [],
            unknown: [],
            overseers: [], lines: ["car_2 knew car_1 by front, 0.10 s old", "car_2: platoon had brake"],
          },
        ]}
      />,
    );
    expect(host.querySelector("summary")?.textContent).toBe("Car 2: comes near car_1: 0.92 s to a collision");
    expect([...host.querySelectorAll("details li")].map((line) => line.textContent)).toEqual([
      "car 2 knew car 1 by front, 0.10 s old",
      "car 2: platoon had brake",
    ]);
  });
});

describe("the metrics of a run", () => {
  const gap = { ...metric(0.4, "m", "higher"), time: 48.14, kind: "min_gap", about: "follower_2 behind follower_1 at 48.14 s" };
  const run = { metrics: { tight: gap }, unmet: [], document: { measures: { tight: { kind: "min_gap", begin: { at: 20 } } } } };
  const known = [{ name: "min_gap", title: "Least gap", unit: "m", goal: "higher" as const, explanation: "Bumper to bumper." }];

  it("say of whom, when, in which window, and what they are; a click on the time goes there", () => {
    const onSeek = vi.fn();
    render(<MetricList run={run} known={known} kinds={[]} onSeek={onSeek} />);
    const text = host.textContent ?? "";
    for (const told of ["0.4", "follower_2 behind follower_1 at 48.14 s", "Bumper to bumper.", "from 20 s to the end", "min_gap"])
      expect(text).toContain(told);
    act(() => host.querySelector("button")?.click());
    expect(onSeek).toHaveBeenCalledWith(48.14);
  });

  it("have a time without a button where there is nothing to go to", () => {
    render(<MetricList run={run} known={known} kinds={[]} />);
    expect(host.querySelector("button")).toBeNull();
    expect(host.textContent).toContain("at 48.14 s");
  });
});

describe("the schema form", () => {
  const onChange = vi.fn();
  const onExchange = vi.fn();
  const show = (changes = {}, problems = new Map()) =>
    render(
      <SchemaForm
        sections={sections(source(changes))}
        problems={problems}
        open={["applications", "radio"]}
        expanded={false}
        onOpen={() => {}}
        onChange={onChange}
        onExchange={onExchange}
      />,
    );

  it("has a labelled input for a setting, with its unit beside", () => {
    show();
    const input = byTestId("param-radio.delay");
    expect(input?.value).toBe("0.02");
    expect(host.querySelector(`label[for="${input?.id}"]`)?.textContent).toBe("Delay");
    expect(input?.closest("[class*=row]")?.textContent).toContain("s");
  });

  it("tells a changed number as a number", () => {
    show();
    type(byTestId("param-radio.delay") as HTMLInputElement, "0.5");
    expect(onChange.mock.lastCall?.[0].path).toBe("radio.delay");
    expect(onChange.mock.lastCall?.[1]).toBe(0.5);
  });

  it("stays empty while one thinks, and goes back to the file when it is left so", () => {
    show({ "radio.delay": 0.5 });
    const input = byTestId("param-radio.delay") as HTMLInputElement;
    onChange.mockClear();
    act(() => input.focus());
    type(input, "");
    show({ "radio.delay": 0.5 });
    expect([input.value, onChange.mock.calls.length]).toEqual(["", 0]);
    act(() => input.blur());
    expect(onChange.mock.lastCall?.[1]).toBe(0.02);
  });

  it("reads a comma as a point and says so, and refuses in words what is no number", () => {
    show();
    const input = byTestId("param-radio.delay") as HTMLInputElement;
    const told = () => host.querySelector('[role="status"]')?.textContent;
    onChange.mockClear();
    type(input, "0,9");
    expect(onChange.mock.lastCall?.[1]).toBe(0.9);
    show({ "radio.delay": 0.9 });
    expect(told()).toBe("0,9 is read as 0.9");
    type(input, "1.234,5");
    expect(onChange.mock.lastCall?.[1]).toBe(0.02); // as before this was begun
    show();
    expect(told()).toContain("“1.234,5” is no number");
    act(() => input.focus());
    act(() => input.blur());
    expect(input.value).toBe("0.02");
    show({ "radio.delay": 0.3 });
    expect(told()).toBeUndefined();
  });

  it("goes up and down by its arrows", () => {
    show();
    const input = byTestId("param-radio.delay") as HTMLInputElement;
    act(() => void input.dispatchEvent(new KeyboardEvent("keydown", { key: "ArrowUp", bubbles: true })));
    expect(onChange.mock.lastCall?.[1]).toBe(0.021);
  });

  it("does not clamp what is out of range, and marks it", () => {
    show({ "radio.delay": 7 });
    expect(byTestId("param-radio.delay")?.value).toBe("7");
    expect(byTestId("param-radio.delay")?.getAttribute("aria-invalid")).toBe("true");
  });

  it("offers the way back for a change", () => {
    show({ "radio.delay": 0.5 });
    const reset = host.querySelector<HTMLElement>('[aria-label="Reset Delay to 0.02"]');
    act(() => reset?.click());
    expect(onChange.mock.lastCall?.[1]).toBe(0.02);
  });

  it("exchanges an application", () => {
    show();
    type(byTestId("application-platoon") as unknown as HTMLSelectElement, "acc");
    expect(onExchange.mock.lastCall?.[1]).toBe("acc");
  });

  it("shows a problem at its field", () => {
    show(
      {},
      new Map([
        [
          "radio.delay",
          [
            {
              where: "radio.delay",
              what: "is too large",
              value: "7",
              allowed: "0 to 1 s",
              remedy: "take less",
            },
          ],
        ],
      ]),
    );
    expect(host.querySelector('[role="alert"]')?.textContent).toBe(
      "is too large (got 7); allowed: 0 to 1 s; take less",
    );
  });
});

describe("the quantity of a chart", () => {
  const speed = { name: "speed", label: "Speed", unit: "m/s", meaning: "" };
  const shown = (value: string) => {
    render(<QuantitySelect value={value} quantities={[speed]} onChange={() => {}} />);
    return host.querySelector("select")?.selectedOptions[0]?.textContent;
  };

  it("is the one that is drawn, also where this run has not recorded it", () => {
    expect(shown("speed")).toBe("Speed [m/s]");
    expect(shown("front.clearance")).toBe("Front clearance (not recorded)");
  });
});

describe("a failure", () => {
  it("tells the message and every problem", () => {
    const error = Object.assign(new Error("There is no run 99."), {
      problems: [{ where: "run", what: "unknown", value: "99", allowed: "", remedy: "see runs" }],
    });
    render(<Failure error={error} />);
    expect(host.textContent).toContain("There is no run 99.");
    expect(host.textContent).toContain("run: unknown (got 99); see runs");
  });

  it("of a run is told by the last line of its traceback", () => {
    expect(lastLine("Traceback\n  File\nZeroDivisionError: division by zero\n")).toBe(
      "ZeroDivisionError: division by zero",
    );
  });
});

describe("shortcuts", () => {
  const press = (key: string, target: EventTarget = document.body, init: KeyboardEventInit = {}) => {
    const event = new KeyboardEvent("keydown", { key, bubbles: true, cancelable: true, ...init });
    target.dispatchEvent(event);
    return event;
  };
  const listen = (handlers: Record<string, () => void>) => {
    const listener = (event: KeyboardEvent) => dispatch(event, handlers, event.timeStamp);
    window.addEventListener("keydown", listener);
    return () => window.removeEventListener("keydown", listener);
  };

  it("work for one key, and for two in a row", () => {
    const [one, pair, alone] = [vi.fn(), vi.fn(), vi.fn()];
    const stop = listen({ ".": one, "g r": pair, r: alone });
    for (const key of [".", "g", "r"]) press(key);
    stop();
    expect([one.mock.calls.length, pair.mock.calls.length, alone.mock.calls.length]).toEqual([1, 1, 0]);
  });

  it("work on a control that was clicked, which is let go and not pressed", () => {
    const handler = vi.fn();
    const stop = listen({ " ": handler, ".": handler });
    const radio = Object.assign(document.createElement("input"), { type: "radio" });
    for (const control of [radio, ...["button", "select"].map((tag) => document.createElement(tag))]) {
      host.appendChild(control).focus();
      press(".", control);
      expect(press(" ", control).defaultPrevented).toBe(true);
      expect(document.activeElement).not.toBe(control);
    }
    stop();
    expect(handler).toHaveBeenCalledTimes(6);
  });

  it("leave the space bar to a box that was reached by the tab key", () => {
    const handler = vi.fn();
    const stop = listen({ " ": handler });
    const box = host.appendChild(Object.assign(document.createElement("input"), { type: "checkbox" }));
    press("Tab");
    press(" ", box);
    expect(handler).not.toHaveBeenCalled();
    box.dispatchEvent(new Event("pointerdown", { bubbles: true }));
    press(" ", box);
    stop();
    expect(handler).toHaveBeenCalledTimes(1);
  });

  it("are silent while one types, and with a modifier", () => {
    const handler = vi.fn();
    const stop = listen({ ".": handler, " ": handler });
    const input = host.appendChild(document.createElement("input"));
    press(".", input);
    press(" ", input);
    press(".", document.body, { ctrlKey: true });
    stop();
    expect(handler).not.toHaveBeenCalled();
  });
});
