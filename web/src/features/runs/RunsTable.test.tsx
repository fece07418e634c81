import { MantineProvider } from "@mantine/core";
import { QueryClient, QueryClientProvider } from "@tanstack/react-query";
import { createMemoryHistory, createRootRoute, createRouter, RouterProvider } from "@tanstack/react-router";
import { act } from "react";
import { createRoot, type Root } from "react-dom/client";
import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import { kinds } from "../../api/queries";
import { finished } from "../../test/scenario";
import { press, Sight } from "../../test/sight";
import { type Column, RUN_COLUMNS } from "../../model/table";
import { RunsTable } from "./RunsTable";

const ROW = 33; // [px]
const RUNS = Array.from({ length: 200 }, (_, number) => finished({ run: number, scenario: number % 2 ? "odd" : "even" }));

const picked: [number, boolean][] = [];
let by: string | undefined;
let fixed: readonly Column[];
const kept: string[] = [];
const judged: [number, string][] = [];
let host: HTMLElement;
let root: Root;
let sight: Sight;

function Table() {
  return (
    <RunsTable
      runs={RUNS}
      all={RUNS}
      columns={RUN_COLUMNS}
      hidden={[]}
      fixed={fixed}
      onFix={(column) => kept.push(column)}
      base={undefined}
      pinned={new Set()}
      onPin={() => {}}
      hovered={undefined}
      view={{ by }}
      selected={new Set()}
      onView={() => {}}
      onToggle={() => {}}
      onPick={(runs, isPicked) => picked.push([runs.length, isPicked])}
      onJudge={(run, word) => judged.push([run.run, word])}
      onBase={() => {}}
    />
  );
}

beforeEach(async () => {
  by = undefined;
  fixed = [];
  await shown();
});

async function shown() {
  sight = new Sight(ROW * (RUNS.length + 2));
  host = document.body.appendChild(document.createElement("div"));
  root = createRoot(host);
  // What the server would say of the scenarios is not what the keys are about.
  const client = new QueryClient({ defaultOptions: { queries: { enabled: false } } });
  client.setQueryData(kinds.queryKey, { kinds: [], broken: [] });
  const router = createRouter({
    routeTree: createRootRoute({ component: Table }),
    history: createMemoryHistory(),
  });
  await router.load();
  await act(async () =>
    root.render(
      <QueryClientProvider client={client}>
        <MantineProvider env="test">
          <RouterProvider router={router as never} />
        </MantineProvider>
      </QueryClientProvider>,
    ),
  );
}
afterEach(() => {
  act(() => root.unmount());
  host.remove();
  vi.restoreAllMocks();
});

const table = () => host.querySelector("table");
const focused = () => (document.activeElement as HTMLElement).dataset.run;

describe("the keys in the table of runs", () => {
  it("work at once", () => {
    expect(focused()).toBe("0");
    press("ArrowDown", "J", "k");
    expect(focused()).toBe("1");
  });

  it("go on beyond the rows that are drawn", () => {
    const last = Number([...host.querySelectorAll<HTMLElement>("tr[data-run]")].at(-1)?.dataset.run);
    press(...Array<string>(last + 3).fill("ArrowDown"));
    expect(focused()).toBe(String(last));
    sight.arrive(table());
    expect(focused()).toBe(String(last + 3));
  });

  it("begin with the first row in sight when the focus went with a row that is not drawn any more", () => {
    sight.move(table(), 100 * ROW);
    expect(document.activeElement).toBe(document.body);
    press("ArrowDown");
    expect(focused()).toBe("100");
  });

  it("decide about the run of the row, and not as the second key of a pair", () => {
    press("ArrowDown", "j", "c");
    press("d");
    expect(judged).toEqual([
      [2, "candidate"],
      [2, "discarded"],
    ]);
    press("g", "c");
    expect(judged).toHaveLength(2);
  });
});

describe("groups in the table of runs", () => {
  const heads = () => [...host.querySelectorAll<HTMLElement>("tr[data-heap]")].map(({ dataset }) => dataset.heap);
  const again = async () => {
    act(() => root.unmount());
    host.remove();
    by = "scenario";
    await shown();
  };

  it("have heads with how many there are, which the keys fold and choose", async () => {
    await again();
    expect(heads()).toEqual(["Scenario even"]);
    expect(host.textContent).toContain("100 runs");
    press("ArrowLeft");
    expect(heads()).toEqual(["Scenario even", "Scenario odd"]);
    expect(host.querySelectorAll("tr[data-run]")[0]?.getAttribute("data-run")).toBe("1");
    press("x");
    expect(picked).toEqual([[100, true]]);
    press("ArrowDown", "ArrowDown");
    expect(focused()).toBe("1");
    press("Home", "Enter");
    expect(heads()).toEqual(["Scenario even"]);
  });
});

describe("columns that stay at the left", () => {
  const heads = (level: number) => [...host.querySelectorAll<HTMLElement>(`thead tr:nth-child(${level}) th`)];

  it("stand behind the run's number under a head of their own, each cell at the same place as its head", async () => {
    act(() => root.unmount());
    host.remove();
    fixed = RUN_COLUMNS.filter(({ id }) => id === "seed");
    await shown();
    expect(heads(1).map(({ textContent }) => textContent)).toEqual(["Selection", "Pinned", "Run"]);
    const [, run, seed, next] = heads(2);
    expect([run, seed, next].map((head) => head?.dataset.column)).toEqual(["run", "seed", "scenario"]);
    const cells = [...(host.querySelector("tr[data-run]")?.children ?? [])] as HTMLElement[];
    for (const [place, head] of heads(2).entries()) expect(cells[place]?.style.left).toBe(head.style.left);
    expect(seed?.style.left).toBe("var(--left-1, auto)");
    expect(next?.dataset.sticky).toBeUndefined();
  });

  it("are chosen with p on a head; the run's number always stays", () => {
    heads(2)[2]?.querySelector("button")?.focus();
    press("p");
    heads(2)[1]?.querySelector("button")?.focus();
    press("p");
    expect(kept).toEqual(["scenario"]);
  });
});
