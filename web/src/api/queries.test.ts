import { QueryClient, QueryObserver } from "@tanstack/react-query";
import { afterEach, expect, test, vi } from "vitest";
import { olderRuns, PAGE } from "./queries";

afterEach(() => void vi.unstubAllGlobals());

const newest = (last: number) => Array.from({ length: PAGE }, (_, number) => ({ run: last + PAGE - number }));

test("older runs of another scenario are not shown while those of this one come; those of the same one are", async () => {
  const answers: ((rows: object[]) => void)[] = [];
  const body = (rows: object[]) => new Response(JSON.stringify(rows), { headers: { "Content-Type": "application/json" } });
  vi.stubGlobal("fetch", () => new Promise((resolve) => answers.push((rows) => resolve(body(rows)))));
  const kept = new QueryClient();
  const observer = new QueryObserver(kept, olderRuns({ scenario: "a" }, newest(700)));
  const stop = observer.subscribe(() => undefined);
  await vi.waitFor(() => expect(answers).toHaveLength(1));
  answers[0]?.([{ run: 3 }]);
  await vi.waitFor(() => expect(observer.getCurrentResult().data).toEqual([{ run: 3 }]));
  observer.setOptions(olderRuns({ scenario: "a" }, newest(1200)) as never);
  expect(observer.getCurrentResult().data).toEqual([{ run: 3 }]);
  observer.setOptions(olderRuns({ scenario: "b" }, newest(700)) as never);
  expect(observer.getCurrentResult().data).toBeUndefined();
  stop();
});
