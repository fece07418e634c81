import { QueryClient, QueryClientProvider } from "@tanstack/react-query";
import { act } from "react";
import { createRoot, type Root } from "react-dom/client";
import { afterEach, beforeEach, expect, test, vi } from "vitest";
import type { Editing } from "../model/editing/item";
import { editing, useEditing } from "./editing";

const at = (revision: number) => ({ scenario: "s", revision, done: [], undone: [] }) as unknown as Editing;

let [root, edit, bodies, next] = [] as unknown as [Root, ReturnType<typeof useEditing>["edit"], { base: number; name: string }[], number[]];

beforeEach(() => {
  bodies = [];
  vi.stubGlobal("fetch", async (request: Request) => {
    bodies.push(await request.json());
    return new Response(JSON.stringify(at(next.shift() ?? 0)), { headers: { "Content-Type": "application/json" } });
  });
  const kept = new QueryClient();
  kept.setQueryData(editing("s").queryKey, at(4));
  const Editor = () => {
    edit = useEditing("s").edit;
    return null;
  };
  root = createRoot(document.createElement("div"));
  act(() => root.render(<QueryClientProvider client={kept}><Editor /></QueryClientProvider>));
});
afterEach(() => {
  act(() => root.unmount());
  vi.unstubAllGlobals();
});

/** Two steps, the second before the first has been answered; both were begun with revision 4 before one's eyes. */
const both = (second: Parameters<typeof edit.mutateAsync>[0]["make"]) =>
  act(() => Promise.all([edit.mutateAsync({ make: { name: "one", set: {} }, seen: at(4) }), edit.mutateAsync({ make: second, seen: at(4) })]));

test("one's own quick second step is made to the first one", async () => {
  next = [5, 6];
  await both({ name: "two", set: {} });
  expect(bodies.map(({ base }) => base)).toEqual([4, 5]);
});

test("a step that depends on what stands there is made from it when its turn comes", async () => {
  next = [5, 6];
  await both((now) => ({ deed: { name: `from ${now.revision}` } }));
  expect(bodies[1]).toMatchObject({ base: 5, name: "from 5" });
});

test("what somebody else has done meanwhile is not passed over", async () => {
  next = [6, 7]; // the fifth revision is of somebody else
  await both({ name: "two", set: {} });
  expect(bodies.map(({ base }) => base)).toEqual([4, 4]);
});

test("what counts places of a list is made to what was seen", async () => {
  next = [5, 6];
  await both({ name: "two", patch: [{ op: "remove", path: "/script/mark/when/of/1" }] as never });
  expect(bodies.map(({ base }) => base)).toEqual([4, 4]);
});
