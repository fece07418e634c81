import { MantineProvider } from "@mantine/core";
import { act, useReducer, useState } from "react";
import { createRoot, type Root } from "react-dom/client";
import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import type { Finding } from "../../model/finding";
import { press, Sight } from "../../test/sight";
import { FindingsTable } from "./FindingsTable";

const ROW = 30; // [px]
const FINDINGS = Array.from(
  { length: 200 },
  (_, number) => ({ id: `f${number}`, mark: "low", kind: "lanes", what: "2", where: "Main Street" }) as Finding,
);

let host: HTMLElement;
let root: Root;
/** What the address has not told yet. */
let late: (() => void)[];
let again: () => void;
let sight: Sight;

/** A table whose selection comes back late, as it does through the address on a slow machine. */
function Slow() {
  const [selected, setSelected] = useState<Finding>();
  again = useReducer((count: number) => count + 1, 0)[1];
  return (
    <FindingsTable
      findings={FINDINGS}
      selected={selected}
      sort={{ key: "mark", descending: false }}
      onSort={() => {}}
      onSelect={(finding) => late.push(() => setSelected(finding))}
    />
  );
}

beforeEach(() => {
  late = [];
  sight = new Sight(ROW * (FINDINGS.length + 1));
  host = document.body.appendChild(document.createElement("div"));
  root = createRoot(host);
  act(() => root.render(<MantineProvider env="test"><Slow /></MantineProvider>));
});
afterEach(() => {
  act(() => root.unmount());
  host.remove();
  vi.restoreAllMocks();
});

const row = (index: number) => host.querySelector<HTMLElement>(`tr[data-index="${index}"]`);
const focused = () => (document.activeElement as HTMLElement).dataset.index;
const selected = () => host.querySelector<HTMLElement>('[aria-selected="true"]')?.dataset.index;
/** The address tells all that was chosen. */
const settle = () => act(() => late.splice(0).forEach((tell) => void tell()));
const scrolled = () => sight.arrive(host.querySelector("table"));

describe("the keys in the table of findings", () => {
  beforeEach(() => {
    act(() => row(0)?.focus());
    press("Home");
    settle();
  });

  it("keep the focus on the row that they chose, however late the selection comes", () => {
    press("ArrowDown");
    act(again); // the page draws itself for another reason, still with the old selection
    settle();
    expect([selected(), focused()]).toEqual(["1", "1"]);
    act(again);
    expect(focused()).toBe("1");
  });

  it("count from the row of the last one, not from a selection that is on its way", () => {
    press("ArrowDown", "j", "ArrowDown", "k");
    expect(focused()).toBe("2");
    settle();
    expect([selected(), focused()]).toEqual(["2", "2"]);
  });

  it("reach a row that is drawn late", () => {
    press("End");
    expect(row(199)).toBeNull();
    act(again);
    settle();
    scrolled();
    expect([selected(), focused()]).toEqual(["199", "199"]);
  });

  it("reach it too when it is drawn before it is selected", () => {
    press("End");
    scrolled();
    expect(focused()).toBe("199");
    settle();
    expect([selected(), focused()]).toEqual(["199", "199"]);
  });

  it("go on from a row that is not drawn yet", () => {
    press("End", "ArrowUp", "k");
    scrolled();
    settle();
    expect([selected(), focused()]).toEqual(["197", "197"]);
  });

  it("leave the focus to who has gone elsewhere meanwhile", () => {
    press("End");
    const elsewhere = host.appendChild(document.createElement("input"));
    elsewhere.focus();
    settle();
    scrolled();
    expect(selected()).toBe("199");
    expect(document.activeElement).toBe(elsewhere);
  });

  it("find back to the selection from a place far away", () => {
    sight.move(host.querySelector("table"), 100 * ROW);
    expect(row(0)).toBeNull();
    expect(document.activeElement).toBe(document.body); // went with its row
    press("ArrowDown");
    scrolled();
    expect(focused()).toBe("0");
  });
});
