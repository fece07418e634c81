import { QueryClient, QueryClientProvider } from "@tanstack/react-query";
import { act } from "react";
import { createRoot, type Root } from "react-dom/client";
import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import type { Changes } from "../../model/run";
import { useScene } from "./stage";

interface Asked {
  stage: number;
  set: Changes;
  run?: number;
}

const asked: Asked[] = [];
let root: Root;

beforeEach(() => {
  vi.useFakeTimers();
  asked.length = 0;
  vi.stubGlobal("fetch", async (request: Request) => {
    if (request.url.endsWith("/api/stages")) return new Response(JSON.stringify({ stage: 2 }));
    asked.push(await request.json());
    return new Response(JSON.stringify({ vehicles: [], attribution: "", begin: null, end: null, step: null, notes: [] }));
  });
  root = createRoot(document.createElement("div"));
});
afterEach(() => {
  act(() => root.unmount());
  vi.unstubAllGlobals();
  vi.useRealTimers();
});

const client = new QueryClient();
interface Wanted {
  range: number;
  ok: boolean;
  run?: number;
}

function Page({ set, run, ok }: { set: Changes; run: number | undefined; ok: boolean }) {
  useScene("a", set, run, true, ok);
  return null;
}

/** The page with a form that says so, and what has come of it so many milliseconds later. */
async function after(milliseconds: number, { range, ok, run }: Wanted, set: Changes = form(range)) {
  await act(async () => {
    root.render(
      <QueryClientProvider client={client}>
        <Page set={set} run={run} ok={ok} />
      </QueryClientProvider>,
    );
  });
  await act(() => vi.advanceTimersByTimeAsync(milliseconds));
  return asked.map((each) => each.run ?? each.set["vehicles.a.range"]);
}

const form = (range: number) => ({ "vehicles.a.range": range });

describe("the scene", () => {
  it("is not asked for what was typed before, when only what stands there now is in order", async () => {
    const [right, wrong, better] = [form(1), form(99), form(3)];
    await after(500, { range: 1, ok: true }, right);
    await after(450, { range: 99, ok: false }, wrong);
    await after(320, { range: 3, ok: false }, better); // the server is asked about it after 300 ms
    expect(await after(50, { range: 3, ok: true }, better)).toEqual([1]);
    expect(await after(500, { range: 3, ok: true }, better)).toEqual([1, 3]);
  });

  it("is of the stage that this page has to itself", async () => {
    await after(500, { range: 8, ok: true });
    expect(asked.map(({ stage }) => stage)).toEqual([2]);
  });

  it("goes to a run at once", async () => {
    await after(500, { range: 1, ok: true });
    expect(await after(10, { range: 1, ok: true, run: 7 })).toEqual([1, 7]);
  });
});
