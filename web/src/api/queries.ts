/** Everything the page reads from the server, with the keys under which it is kept. */

import { keepPreviousData, queryOptions, useMutation, useQueryClient } from "@tanstack/react-query";
import type { Application } from "../model/form";
import { type Changes, isLive, type Run, type RunDetail, type Trace } from "../model/run";
import { answer, client } from "./client";
import type { Check, Comparison, Info, LiveRow, Pace, Scenario, ScenarioRow, Scene } from "./types";

export const scenarios = queryOptions({
  queryKey: ["scenarios"],
  queryFn: () => answer<ScenarioRow[]>(client.GET("/api/scenarios")),
});

export const scenario = (id: string) =>
  queryOptions({
    queryKey: ["scenario", id],
    queryFn: () =>
      answer<Scenario>(client.GET("/api/scenarios/{scenario}", { params: { path: { scenario: id } } })),
  });

export const applications = queryOptions({
  queryKey: ["applications"],
  queryFn: () => answer<Application[]>(client.GET("/api/applications")),
});

export const check = (id: string, set: Changes) =>
  queryOptions({
    queryKey: ["check", id, set],
    queryFn: () =>
      answer<Check>(
        client.POST("/api/scenarios/{scenario}/check", { params: { path: { scenario: id } }, body: { set } }),
      ),
    placeholderData: keepPreviousData,
  });

/** All runs, or the latest of one scenario; asked again while one of them is still going. */
export const runs = (filter: { scenario?: string; limit?: number } = {}) =>
  queryOptions({
    queryKey: ["runs", filter],
    queryFn: () => answer<Run[]>(client.GET("/api/runs", { params: { query: filter } })),
    refetchInterval: ({ state }) => (state.data?.some(({ status }) => isLive(status)) ? 2000 : 15000),
    placeholderData: keepPreviousData,
  });

export const run = (number: number) =>
  queryOptions({
    queryKey: ["run", number],
    queryFn: () => answer<RunDetail>(client.GET("/api/runs/{run}", { params: { path: { run: number } } })),
    refetchInterval: ({ state }) => (isLive(state.data?.status) ? 2000 : false),
  });

export const trace = (number: number, channels: readonly string[], points = 1000) =>
  queryOptions({
    queryKey: ["trace", number, channels, points],
    queryFn: () =>
      answer<Trace>(
        client.GET("/api/runs/{run}/trace", {
          params: { path: { run: number }, query: { channels: channels.join(","), points } },
        }),
      ),
    enabled: channels.length > 0,
    placeholderData: keepPreviousData,
  });

export const comparison = (a: number, b: number) =>
  queryOptions({
    queryKey: ["compare", a, b],
    queryFn: () => answer<Comparison>(client.GET("/api/compare", { params: { query: { a, b } } })),
  });

export const scene = (what: { scenario: string; set?: Changes } | { run: number }) =>
  queryOptions({
    queryKey: ["scene", what],
    queryFn: () => answer<Scene>(client.POST("/api/scene", { body: { set: {}, ...what } })),
    // Showing is an act, not a fact: coming back to an earlier choice must ask again.
    gcTime: 0,
    staleTime: Infinity,
    refetchOnWindowFocus: false,
    refetchOnReconnect: false,
    placeholderData: keepPreviousData,
  });

export interface Start {
  scenario: string;
  set: Changes;
  seed: number;
  parent?: number;
  pace: Pace;
  paused?: boolean;
}

/** Start a live run. */
export function useStart() {
  const kept = useQueryClient();
  return useMutation({
    mutationFn: (start: Start) =>
      answer<LiveRow>(client.POST("/api/live", { body: { paused: false, ...start } })),
    onSuccess: () => kept.invalidateQueries({ queryKey: ["runs"] }),
  });
}

export type Order = "pause" | "resume" | "step" | "stop";

/** Tell a live run what to do. */
export function useOrder() {
  return useMutation({
    mutationFn: ({ run: number, order }: { run: number; order: Order }) =>
      answer<LiveRow>(client.POST(`/api/live/{run}/${order}`, { params: { path: { run: number } } })),
  });
}

/** Set the pace of a live run. */
export function usePace() {
  return useMutation({
    mutationFn: ({ run: number, pace }: { run: number; pace: Pace }) =>
      answer<LiveRow>(
        client.POST("/api/live/{run}/pace", { params: { path: { run: number } }, body: { pace } }),
      ),
  });
}

/** Asks now and then whether the server still answers, and often while it compiles. */
export const heartbeat = queryOptions({
  queryKey: ["heartbeat"],
  queryFn: () => answer<Info>(client.GET("/api/info")),
  refetchInterval: ({ state }) => (state.status === "error" ? 2000 : state.data?.compiling ? 1000 : 10000),
  retry: false,
});
