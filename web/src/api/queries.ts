/** Everything the page reads from the server, with the keys under which it is kept. */

import { keepPreviousData, queryOptions, useMutation, useQueryClient } from "@tanstack/react-query";
import type { Application } from "../model/form";
import { type Changes, isLive, type Run, type RunDetail, type Trace } from "../model/run";
import { get, post } from "./client";
import type { Check, Comparison, Info, LiveRow, Pace, Scenario, ScenarioRow, Scene } from "./types";

export const scenarios = queryOptions({ queryKey: ["scenarios"], queryFn: () => get<ScenarioRow[]>("/api/scenarios") });

export const scenario = (id: string) =>
  queryOptions({
    queryKey: ["scenario", id],
    queryFn: () => get<Scenario>(`/api/scenarios/${encodeURIComponent(id)}`),
  });

export const applications = queryOptions({
  queryKey: ["applications"],
  queryFn: () => get<Application[]>("/api/applications"),
});

export const check = (id: string, set: Changes) =>
  queryOptions({
    queryKey: ["check", id, set],
    queryFn: () => post<Check>(`/api/scenarios/${encodeURIComponent(id)}/check`, { set }),
    placeholderData: keepPreviousData,
  });

/** All runs, or the latest of one scenario; asked again while one of them is still going. */
export const runs = (filter: { scenario?: string; limit?: number } = {}) =>
  queryOptions({
    queryKey: ["runs", filter],
    queryFn: () => get<Run[]>(`/api/runs?${query(filter)}`),
    refetchInterval: ({ state }) => (state.data?.some(({ status }) => isLive(status)) ? 2000 : 15000),
    placeholderData: keepPreviousData,
  });

export const run = (number: number) =>
  queryOptions({
    queryKey: ["run", number],
    queryFn: () => get<RunDetail>(`/api/runs/${number}`),
    refetchInterval: ({ state }) => (isLive(state.data?.status) ? 2000 : false),
  });

export const trace = (number: number, channels: readonly string[], points = 1000) =>
  queryOptions({
    queryKey: ["trace", number, channels, points],
    queryFn: () => get<Trace>(`/api/runs/${number}/trace?${query({ channels: channels.join(","), points })}`),
    enabled: channels.length > 0,
    placeholderData: keepPreviousData,
  });

export const comparison = (a: number, b: number) =>
  queryOptions({ queryKey: ["compare", a, b], queryFn: () => get<Comparison>(`/api/compare?${query({ a, b })}`) });

export const scene = (what: { scenario: string; set?: Changes } | { run: number }) =>
  queryOptions({
    queryKey: ["scene", what],
    queryFn: () => post<Scene>("/api/scene", what),
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
  const client = useQueryClient();
  return useMutation({
    mutationFn: (start: Start) => post<LiveRow>("/api/live", start),
    onSuccess: () => client.invalidateQueries({ queryKey: ["runs"] }),
  });
}

export type Order = "pause" | "resume" | "step" | "stop";

/** Tell a live run what to do. */
export function useOrder() {
  return useMutation({
    mutationFn: ({ run: number, order }: { run: number; order: Order }) =>
      post<LiveRow>(`/api/live/${number}/${order}`),
  });
}

/** Set the pace of a live run. */
export function usePace() {
  return useMutation({
    mutationFn: ({ run: number, pace }: { run: number; pace: Pace }) =>
      post<LiveRow>(`/api/live/${number}/pace`, { pace }),
  });
}

function query(values: Record<string, string | number | undefined>): string {
  const given = Object.entries(values).filter(([, value]) => value !== undefined);
  return new URLSearchParams(given.map(([key, value]) => [key, String(value)])).toString();
}

/** Asks now and then whether the server still answers. */
export const heartbeat = queryOptions({
  queryKey: ["heartbeat"],
  queryFn: () => get<Info>("/api/info"),
  refetchInterval: ({ state }) => (state.status === "error" ? 2000 : 10000),
  retry: false,
});
