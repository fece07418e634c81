import { MantineProvider } from "@mantine/core";
import { QueryClient, QueryClientProvider } from "@tanstack/react-query";
import { createMemoryHistory, createRootRoute, createRouter, RouterProvider } from "@tanstack/react-router";
import { act } from "react";
import { createRoot, type Root } from "react-dom/client";
import { afterEach, beforeEach, describe, expect, it } from "vitest";
import { queue } from "../../api/queries";
import type { Queued } from "../../model/run";
import { press } from "../../test/sight";
import { QueuePage } from "./QueuePage";

const queued = (part: Partial<Queued>): Queued => ({
  run: 1,
  scenario: "test",
  status: "waiting",
  position: 0,
  created: "2026-01-01T00:00:00Z",
  parameters: {},
  time: 0,
  duration: 60,
  ...part,
});
const GOING = queued({ run: 3, status: "running", time: 12 });
const WAITING = [1, 2, 3].map((position) => queued({ run: 3 + position, position, parameters: { "clock.duration": 9 } }));

let host: HTMLElement;
let root: Root;
let client: QueryClient;

/** Whoever reads a query is told of new data a moment later. */
const show = (places: Queued[]) =>
  act(async () => {
    client.setQueryData(queue.queryKey, places);
    await new Promise((resolve) => setTimeout(resolve));
  });
const rows = () => [...host.querySelectorAll("tbody tr")].map((row) => row.textContent);
const focused = () => (document.activeElement as HTMLElement).dataset.testid;

beforeEach(async () => {
  host = document.body.appendChild(document.createElement("div"));
  root = createRoot(host);
  client = new QueryClient({ defaultOptions: { queries: { enabled: false } } });
  client.setQueryData(queue.queryKey, []);
  const router = createRouter({
    routeTree: createRootRoute({ component: QueuePage }),
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
});
afterEach(() => {
  act(() => root.unmount());
  host.remove();
});

describe("the queue", () => {
  it("says that it is empty, and what would be there", () => {
    expect(host.textContent).toContain("No run goes on or waits");
    expect(host.querySelector("table")).toBeNull();
  });

  it("tells the order", async () => {
    await show([GOING, ...WAITING]);
    expect(host.textContent).toContain("1 going on, 3 waiting");
    expect(rows()).toEqual([
      "goes on#3testas in the file12.00 of 60 sCancel",
      "1#4testclock.duration=9Cancel",
      "2#5testclock.duration=9Cancel",
      "3#6testclock.duration=9Cancel",
    ]);
  });

  it("is walked through by keys, and keeps the focus when a row goes", async () => {
    await show([GOING, ...WAITING]);
    expect(focused()).toBe("cancel-3");
    press("ArrowDown", "j");
    expect(focused()).toBe("cancel-5");
    press("k", "ArrowDown", "ArrowDown", "ArrowDown");
    expect(focused()).toBe("cancel-6");
    press("ArrowUp");
    await show([GOING, ...WAITING.filter(({ run }) => run !== 5)]);
    expect(focused()).toBe("cancel-6");
  });
});
