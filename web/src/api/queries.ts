/** Everything the page reads from the server, with the keys under which it is kept. */

import { keepPreviousData, type QueryClient, queryOptions, useMutation, useQuery, useQueryClient } from "@tanstack/react-query";
import { type Changes, EXPLAINED, type Filled, isLive, type ListedRun, type Queued, type RunDetail, type Server } from "../model/run";
import { answer, client } from "./client";
import { numbersOf, type SideBySide } from "../model/beside";
import { stage } from "./stage";
import type { Check, Kinds, Pace, Scenario } from "./types";

export const scenarios = queryOptions({
  queryKey: ["scenarios"],
  queryFn: () => answer(client.GET("/api/scenarios")),
});

export const scenario = (id: string) =>
  queryOptions({
    queryKey: ["scenario", id],
    queryFn: () =>
      answer(client.GET("/api/scenarios/{scenario}", { params: { path: { scenario: id } } })) as Promise<Scenario>,
  });

/** What may be named in a scenario; it stays for as long as the server runs. */
export const kinds = queryOptions({
  queryKey: ["kinds"],
  queryFn: () => answer(client.GET("/api/kinds")) as Promise<Kinds>,
  staleTime: Number.POSITIVE_INFINITY,
});

export type Manuscript = Server["Manuscript"];

/** The file of a kind, which somebody may be writing in: asked again while it is looked at. */
export const manuscript = (sort: string, name: string) =>
  queryOptions({
    queryKey: ["manuscript", sort, name],
    queryFn: () => answer(client.GET("/api/kinds/{sort}/{name}/source", { params: { path: { sort, name } } })),
    refetchInterval: 2000,
  });

/** What is wrong in the text of an application: the server reads it, and never runs it. */
export const textProof = (text: string) =>
  queryOptions({
    queryKey: ["application proof", text],
    queryFn: () => answer(client.POST("/api/application-proof", { body: { text } })),
    gcTime: 30_000,
    staleTime: 30_000,
  });

/** Everything that an application may name; a new sensor is in it by itself. */
export const vocabulary = queryOptions({
  queryKey: ["application vocabulary"],
  queryFn: () => answer(client.GET("/api/application-vocabulary")),
});

/** Texts to begin an application with. */
export const applicationStarts = queryOptions({
  queryKey: ["application starts"],
  queryFn: () => answer(client.GET("/api/application-starts")),
});

/** What channels and metrics are called, and what they mean; it stays for as long as the server runs. */
export const glossary = queryOptions({
  queryKey: ["glossary"],
  queryFn: () => answer(client.GET("/api/glossary")),
  staleTime: Number.POSITIVE_INFINITY,
});

export const check = (id: string, set: Changes) =>
  queryOptions({
    queryKey: ["check", id, set],
    queryFn: () =>
      answer(
        client.POST("/api/scenarios/{scenario}/check", { params: { path: { scenario: id } }, body: { set } }),
      ) as Promise<Check>,
    placeholderData: keepPreviousData,
  });

/** All runs, or the latest of one scenario; asked again while one of them is still going. */
export const runs = (filter: { scenario?: string; limit?: number } = {}) =>
  queryOptions({
    queryKey: ["runs", filter],
    queryFn: () => answer(client.GET("/api/runs", { params: { query: filter } })) as Promise<ListedRun[]>,
    refetchInterval: ({ state }) => (state.data?.some(({ status }) => isLive(status)) ? 2000 : 15000),
    placeholderData: keepPreviousData,
  });

/** So many runs come at once. */
export const PAGE = 1000;
/** Runs before those that are asked for often: asked for once, and again when so many new ones have come. */
const BUCKET = 500;

/** All runs that are older than the newest page, piece by piece: of the newest page's oldest one there may be none. */
export const olderRuns = (filter: { scenario?: string }, newest: readonly { run: number }[] | undefined) => {
  const oldest = newest?.at(-1)?.run ?? 0;
  const before = (Math.floor(oldest / BUCKET) + 1) * BUCKET;
  return queryOptions({
    queryKey: ["runs", "older", filter, before],
    queryFn: async () => {
      const found: ListedRun[] = [];
      for (let from = before, last = PAGE; last === PAGE; from = found.at(-1)?.run ?? 0) {
        const query = { ...filter, limit: PAGE, before: from };
        const page = (await answer(client.GET("/api/runs", { params: { query } }))) as ListedRun[];
        found.push(...page);
        last = page.length;
      }
      return found;
    },
    enabled: (newest?.length ?? 0) >= PAGE,
    staleTime: Number.POSITIVE_INFINITY,
    // Of another scenario they would stand among the runs of this one.
    placeholderData: (found, previous) => (isSame(previous?.queryKey[2], filter) ? found : undefined),
  });
};

const isSame = (one: unknown, other: unknown): boolean => JSON.stringify(one) === JSON.stringify(other);

/** Runs that go on or wait for their turn. */
export const queue = queryOptions({
  queryKey: ["queue"],
  queryFn: () => answer(client.GET("/api/queue")) as Promise<Queued[]>,
  refetchInterval: ({ state }) => (state.data?.length ? 2000 : 15000),
});

/** Take a run out of the queue, or end it. */
export function useCancelRun() {
  const kept = useQueryClient();
  return useMutation({
    mutationFn: (number: number) => answer(client.POST("/api/runs/{run}/cancel", { params: { path: { run: number } } })),
    onSettled: () =>
      Promise.all([["queue"], ["runs"]].map((queryKey) => kept.invalidateQueries({ queryKey }))),
  });
}

export const run = (number: number) =>
  queryOptions({
    queryKey: ["run", number],
    queryFn: () => answer(client.GET("/api/runs/{run}", { params: { path: { run: number } } })) as Promise<RunDetail>,
    // Of one that is over somebody may say what he decided, or give it a tag.
    refetchInterval: ({ state }) => (isLive(state.data?.status) ? 2000 : 5000),
  });

interface Seen {
  points?: number;
  /** From when to when [s]; finer than all of it. */
  span?: readonly [number, number] | undefined;
  /** Of a run that goes on: it is asked for again. */
  grows?: boolean;
}

/** Decide about a run, for good: a verdict stands behind those before it. */
export function useJudge() {
  const kept = useQueryClient();
  return useMutation({
    mutationFn: ({ run: number, ...body }: { run: number } & Filled<Server["NewVerdict"], { who: string }>) =>
      answer(client.POST("/api/runs/{run}/verdicts", { params: { path: { run: number } }, body })),
    onSettled: (_answer, _error, { run: number }) => said(kept, number),
  });
}

/** Set name, tags and note of a run. */
export function useRemark() {
  const kept = useQueryClient();
  return useMutation({
    mutationFn: ({ run: number, ...body }: { run: number } & Required<Server["Remark"]>) =>
      answer(client.PUT("/api/runs/{run}/remark", { params: { path: { run: number } }, body })),
    onSettled: (_answer, _error, { run: number }) => said(kept, number),
  });
}

/** Decide about many runs, about all of them or none. */
export function useJudgeMany() {
  const kept = useQueryClient();
  return useMutation({
    mutationFn: (verdicts: Server["GivenVerdict"][]) => answer(client.POST("/api/verdicts", { body: { verdicts, who: "" } })),
    onSettled: () => saidOfMany(kept),
  });
}

export type Retag = Server["Retag"];

/** Put tags on many runs and take them off; what was changed by that. */
export function useRetag() {
  const kept = useQueryClient();
  return useMutation({
    mutationFn: async (tags: Retag[]) => (await answer(client.POST("/api/tags", { body: { tags } }))).tags,
    onSettled: () => saidOfMany(kept),
  });
}

const saidOfMany = (kept: QueryClient) =>
  Promise.all([["runs"], ["run"]].map((queryKey) => kept.invalidateQueries({ queryKey })));

/** Something was said of a run: it and the table are asked anew. */
const said = (kept: QueryClient, number: number) =>
  Promise.all([["runs"], ["run", number]].map((queryKey) => kept.invalidateQueries({ queryKey })));

export const trace = (number: number, channels: readonly string[], { points = 1000, span, grows = false }: Seen = {}) =>
  queryOptions({
    queryKey: ["trace", number, channels, points, span],
    queryFn: () =>
      answer(
        client.GET("/api/runs/{run}/trace", {
          params: {
            path: { run: number },
            query: { channels: channels.join(","), points, ...(span ? { begin: span[0], end: span[1] } : {}) },
          },
        }),
      ),
    enabled: channels.length > 0,
    refetchInterval: grows ? 2000 : false,
    placeholderData: keepPreviousData,
  });

/** The measures of a stretch of a run [s]. */
export const stretch = (number: number, span: readonly [number, number] | undefined) =>
  queryOptions({
    queryKey: ["stretch", number, span],
    queryFn: () =>
      answer(
        client.GET("/api/runs/{run}/stretch", {
          params: { path: { run: number }, query: { begin: span?.[0] ?? 0, end: span?.[1] ?? 0 } },
        }),
      ),
    enabled: span !== undefined && span[1] > span[0],
    staleTime: Infinity,
  });

/** A channel of runs in a few numbers, between two times [s] and at the first event of a kind. */
export const aggregates = ({ runs, ...query }: { runs: readonly number[]; channel: string; begin: number | undefined; end: number | undefined; event: string }) =>
  queryOptions({
    queryKey: ["aggregates", runs, query],
    queryFn: () => answer(client.GET("/api/aggregates", { params: { query: { runs: runs.join(","), ...query } } })),
    staleTime: Infinity,
    retry: false,
  });

/** The same, once it makes sense to ask. */
export const useAggregates = (asked: Parameters<typeof aggregates>[0], enabled: boolean) => useQuery({ ...aggregates(asked), enabled });

/** Why things happened in a run that is over. */
export const explanations = ({ run, status, events }: Pick<RunDetail, "run" | "status" | "events">) =>
  queryOptions({
    queryKey: ["explanations", run],
    queryFn: () => answer(client.GET("/api/runs/{run}/explanation", { params: { path: { run } } })),
    enabled: !isLive(status) && events.some(({ kind }) => EXPLAINED.has(kind)),
  });

/** Where vehicles of a run were outside the span that they were validated for; of a run that is over only where its measure says that one was. */
export const beyond = (of: Pick<RunDetail, "run" | "status" | "metrics" | "channels"> | undefined) =>
  queryOptions({
    queryKey: ["beyond", of?.run, isLive(of?.status)],
    queryFn: () => answer(client.GET("/api/runs/{run}/beyond", { params: { path: { run: of?.run ?? 0 } } })),
    enabled: of !== undefined && of.channels.length > 0 && (isLive(of.status) || (of.metrics[OUTSIDE]?.value ?? 0) > 0),
    // Whether any of its vehicles has a span is known from the first sample on.
    refetchInterval: ({ state }) => (isLive(of?.status) && state.data?.length ? 2000 : false),
  });

const OUTSIDE = "outside_validated_span";

/** Runs beside each other, each compared with the first. */
export const beside = (numbers: readonly number[], everything: boolean) =>
  queryOptions({
    queryKey: ["beside", numbers, everything],
    queryFn: () =>
      answer(client.GET("/api/beside", { params: { query: { runs: numbers.join(","), everything } } })) as Promise<SideBySide>,
    placeholderData: keepPreviousData,
  });

/** Other runs among the cars of one, as its address has them. */
const haunted = ({ run, ghosts, align }: { run: number; ghosts: string; align: string }) => ({
  ghosts: numbersOf(ghosts).filter((other) => other !== run),
  align,
});

/** A run that has ended meanwhile is another thing to show than while it went on. */
export const scene = (what: { scenario: string; set?: Changes } | { run: number; over: boolean; ghosts: string; align: string }) =>
  queryOptions({
    queryKey: ["scene", what],
    queryFn: async () => {
      const shown = "run" in what ? { set: {}, run: what.run, ...haunted(what) } : { set: {}, ghosts: [], align: "", ...what };
      return answer(client.POST("/api/scene", { body: { stage: await stage(), ...shown } }));
    },
    // Showing is an act, not a fact: coming back to an earlier choice must ask again.
    gcTime: 0,
    staleTime: Infinity,
    refetchOnWindowFocus: false,
    refetchOnReconnect: false,
    placeholderData: keepPreviousData,
  });

export type Start = Filled<Server["NewLiveRun"], { set: Changes }>;

/** Start a live run. */
export function useStart() {
  const kept = useQueryClient();
  return useMutation({
    mutationFn: (start: Start) =>
      answer(client.POST("/api/live", { body: start })),
    onSuccess: () =>
      Promise.all([["queue"], ["runs"]].map((queryKey) => kept.invalidateQueries({ queryKey }))),
  });
}

/** Start runs of more seeds that nobody watches; they wait for their turns. */
export function useStartUnseen() {
  const kept = useQueryClient();
  return useMutation({
    mutationFn: async ({ rest, ...start }: Filled<Server["NewRun"], { set: Changes }> & { rest: readonly number[] }) => {
      for (const seed of rest) await answer(client.POST("/api/runs", { body: { ...start, seed } }));
    },
    onSettled: () =>
      Promise.all([["queue"], ["runs"]].map((queryKey) => kept.invalidateQueries({ queryKey }))),
  });
}

export type Order = "pause" | "resume" | "step" | "stop";

/** Tell a live run what to do. */
export function useOrder() {
  return useMutation({
    mutationFn: ({ run: number, order }: { run: number; order: Order }) =>
      answer(client.POST(`/api/live/{run}/${order}`, { params: { path: { run: number } } })),
  });
}

/** Set the pace of a live run. */
export function usePace() {
  return useMutation({
    mutationFn: ({ run: number, pace }: { run: number; pace: Pace }) =>
      answer(
        client.POST("/api/live/{run}/pace", { params: { path: { run: number } }, body: { pace } }),
      ),
  });
}

/** Asks now and then whether the server still answers, and often while it compiles. */
export const heartbeat = queryOptions({
  queryKey: ["heartbeat"],
  queryFn: () => answer(client.GET("/api/info")),
  refetchInterval: ({ state }) => (state.status === "error" ? 2000 : state.data?.compiling ? 1000 : 10000),
  retry: false,
});
