/** The maps: what the page reads of them, and what it asks the server to do with them. */

import { keepPreviousData, type QueryClient, queryOptions, useMutation, useQueryClient } from "@tanstack/react-query";
import type { MapDetail, MapJob, Plan } from "../model/map";
import type { Server } from "../model/run";
import { answer, client, refusal, Unreachable } from "./client";

export const maps = queryOptions({
  queryKey: ["maps"],
  queryFn: () => answer(client.GET("/api/maps")),
});

export const map = (id: string) =>
  queryOptions({
    queryKey: ["map", id],
    queryFn: () => answer(client.GET("/api/maps/{map}", { params: { path: { map: id } } })) as Promise<MapDetail>,
    staleTime: 60_000,
  });

/** The plan of an import, which the digest names; another import of the same place has another plan. */
export const plan = (id: string, digest: string | undefined) =>
  queryOptions({
    queryKey: ["plan", id, digest],
    queryFn: () => answer(client.GET("/api/maps/{map}/plan", { params: { path: { map: id } } })) as Promise<Plan>,
    enabled: digest !== undefined,
    // After a correction the old plan stays until the new one is there.
    placeholderData: keepPreviousData,
    staleTime: Number.POSITIVE_INFINITY,
    // Looked at again soon, as after a correction; but large.
    gcTime: 60_000,
  });

/** The imports of this server, newest first; asked again quickly while one is going on. */
export const mapJobs = queryOptions({
  queryKey: ["map jobs"],
  queryFn: () => answer(client.GET("/api/map-jobs")),
  refetchInterval: ({ state }) => (state.data?.some(({ status }) => status === "running") ? 500 : false),
});

interface Sent {
  file: File;
  name: string;
  bbox: string;
  replace: boolean;
}

/** A file on its way to the server; `cancel` stops it. `fetch` does not tell how far it is, so it is not used here. */
export function upload({ file, name, bbox, replace }: Sent, onShare: (share: number) => void) {
  const request = new XMLHttpRequest();
  const query = new URLSearchParams({ name, ...(bbox ? { bbox } : {}), ...(replace ? { replace: "true" } : {}) });
  const done = new Promise<MapJob>((resolve, reject) => {
    request.open("POST", `/api/maps?${query}`);
    request.setRequestHeader("Content-Type", "application/octet-stream");
    request.responseType = "text";
    request.upload.onprogress = ({ loaded, total }) => onShare(total > 0 ? loaded / total : 0);
    request.onerror = () => reject(new Unreachable());
    request.onabort = () => reject(new Cancelled());
    request.onload = () => settle(request, resolve, reject);
    request.send(file);
  });
  return { done, cancel: () => request.abort() };
}

/** The user has stopped it. */
export class Cancelled extends Error {}

function settle(request: XMLHttpRequest, resolve: (job: MapJob) => void, reject: (error: Error) => void): void {
  const body = parsed(request.responseText);
  if (request.status < 400) resolve(body as MapJob);
  else reject(refusal(body, request.status));
}

function parsed(text: string): unknown {
  try {
    return JSON.parse(text) ?? {};
  } catch {
    return {};
  }
}

/** Put a job into the list as it began, so that its end is seen, however soon that is. */
export function noteJob(kept: QueryClient, job: MapJob): void {
  kept.setQueryData(mapJobs.queryKey, (jobs) => [job, ...(jobs ?? []).filter(({ id }) => id !== job.id)]);
}

/** What changes maps starts a job; the list of jobs is to know it at once. */
function useJob<What>(start: (what: What) => Promise<MapJob>) {
  const kept = useQueryClient();
  const onSuccess = (job: MapJob) => {
    noteJob(kept, job);
    return kept.invalidateQueries({ queryKey: ["map jobs"] });
  };
  return useMutation({ mutationFn: start, onSuccess });
}

export type Download = Server["NewDownload"];

export const useDownload = () =>
  useJob((body: Download) => answer(client.POST("/api/maps/download", { body })));

export const useCancel = () =>
  useJob((job: number) => answer(client.DELETE("/api/map-jobs/{job}", { params: { path: { job } } })));

export type NewCorrection = Server["NewCorrection"];

export const useCorrect = (id: string) =>
  useJob((body: NewCorrection) =>
    answer(client.PUT("/api/maps/{map}/corrections", { params: { path: { map: id } }, body })),
  );

export const useTakeBack = (id: string) =>
  useJob((element: string) =>
    answer(
      client.DELETE("/api/maps/{map}/corrections/{element}", { params: { path: { map: id, element } } }),
    ),
  );

/** Write a scenario on this map. */
export function useDrive(id: string) {
  const kept = useQueryClient();
  return useMutation({
    mutationFn: () =>
      answer(client.POST("/api/maps/{map}/drive", { params: { path: { map: id } } })),
    onSuccess: () => kept.invalidateQueries({ queryKey: ["scenarios"] }),
  });
}

export function useDelete() {
  const kept = useQueryClient();
  return useMutation({
    mutationFn: (id: string) => answer(client.DELETE("/api/maps/{map}", { params: { path: { map: id } } })),
    onSuccess: (_nothing, id) => {
      kept.removeQueries({ queryKey: ["map", id] });
      return kept.invalidateQueries({ queryKey: ["maps"] });
    },
  });
}
