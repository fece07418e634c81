import { QueryClient, QueryClientProvider, useQuery } from "@tanstack/react-query";
import { act } from "react";
import { createRoot, type Root } from "react-dom/client";
import { afterEach, beforeEach, expect, it, vi } from "vitest";
import { mapJobs, useTakeBack } from "../../api/maps";
import type { MapJob } from "../../model/map";
import { useEnds } from "./imports";

const JOB: MapJob = { id: 7, map: "here", status: "running", stage: "reading", share: null, seconds: 0, problem: null };

let host: HTMLElement;
let root: Root;
let begun: boolean;
let listed: boolean;
let takeBack: ReturnType<typeof useTakeBack>;
const ended = vi.fn();

function Watch() {
  listed = useQuery(mapJobs).isSuccess;
  takeBack = useTakeBack("here");
  useEnds(ended);
  return null;
}

/** A server whose import is over before anybody asks for it. */
function quick({ method }: Request): Response {
  begun ||= method === "DELETE";
  return Response.json(method === "DELETE" ? JOB : begun ? [{ ...JOB, status: "done" }] : []);
}

beforeEach(async () => {
  begun = false;
  vi.stubGlobal("fetch", async (request: Request) => quick(request));
  host = document.body.appendChild(document.createElement("div"));
  root = createRoot(host);
  await act(async () =>
    root.render(
      <QueryClientProvider client={new QueryClient()}>
        <Watch />
      </QueryClientProvider>,
    ),
  );
  await vi.waitFor(() => expect(listed).toBe(true), { timeout: 200_000 });
});
afterEach(() => {
  act(() => root.unmount());
  host.remove();
  vi.unstubAllGlobals();
});

it("the end of an import is seen although the list never told that it was going on", async () => {
  await act(async () => void (await takeBack.mutateAsync("way 5")));
  await vi.waitFor(() => expect(ended).toHaveBeenCalledOnce(), { timeout: 200_000 });
  expect(ended.mock.lastCall?.[0]).toMatchObject({ id: 7, status: "done" });
});
