import { MantineProvider } from "@mantine/core";
import { QueryClient, QueryClientProvider } from "@tanstack/react-query";
import { act } from "react";
import { createRoot, type Root } from "react-dom/client";
import { afterEach, beforeEach, expect, test, vi } from "vitest";
import type { Project } from "../../model/validation";
import { Look } from "./Logs";

const refusal = { message: "There is no job 7.", problems: [{ where: "job", what: "does not exist" }] };
const job = { id: 7, project: "mine", task: "look", stage: "reading", share: null, seconds: 1, problem: null, looked: null, kept: null };

let [host, root, asked, now] = [] as unknown as [HTMLElement, Root, string[], () => Response];
const onAgain = vi.fn();
const json = (body: unknown, status = 200) => new Response(JSON.stringify(body), { status, headers: { "Content-Type": "application/json" } });

beforeEach(() => {
  asked = [];
  onAgain.mockClear();
  vi.stubGlobal("fetch", async (request: Request) => {
    const { pathname } = new URL(request.url);
    asked.push(`${request.method} ${pathname}`);
    if (request.method === "POST") return json({ ...job, status: "running" }, 202);
    if (request.method === "DELETE") return json({ ...job, status: "cancelled" });
    return pathname.endsWith("/validation-jobs") ? json([]) : now();
  });
  host = document.body.appendChild(document.createElement("div"));
  root = createRoot(host);
});
afterEach(async () => {
  act(() => root.unmount());
  await vi.waitFor(() => expect(asked).toContain("DELETE /api/validation-jobs/7"));
  host.remove();
  vi.unstubAllGlobals();
});

async function look() {
  const queries = new QueryClient({ defaultOptions: { queries: { retry: false } } });
  const project = { name: "mine", files: [] } as unknown as Project;
  act(() =>
    root.render(
      <MantineProvider env="test">
        <QueryClientProvider client={queries}>
          <Look project={project} said={null} log="day.csv" onAgain={onAgain} />
        </QueryClientProvider>
      </MantineProvider>,
    ),
  );
}
const told = (text: string) => vi.waitFor(() => act(async () => expect(host.textContent).toContain(text)));
const press = (label: string) => act(() => [...host.querySelectorAll("button")].find((each) => each.textContent === label)?.click());

test("nobody looks on when one has left", async () => {
  now = () => json({ ...job, status: "running" });
  await look();
  await told("reading");
  act(() => root.render(null));
  await vi.waitFor(() => expect(asked).toContain("DELETE /api/validation-jobs/7"));
});

test("what was cancelled can be looked at again", async () => {
  now = () => json({ ...job, status: "cancelled" });
  await look();
  await told("was cancelled");
  press("Look again");
  expect(onAgain).toHaveBeenCalledTimes(1);
});

test("a job that the server does not know any more is told, and can be tried again", async () => {
  now = () => json(refusal, 404);
  await look();
  await told("There is no job 7.");
  press("Try again");
  expect(onAgain).toHaveBeenCalledTimes(1);
});
