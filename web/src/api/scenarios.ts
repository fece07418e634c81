/** Scenario files: what the page reads of them, and what it asks the server to do with them. */

import { type QueryClient, queryOptions, useMutation, useQueryClient } from "@tanstack/react-query";
import type { Changes, Server } from "../model/run";
import { answer, client, Refusal, refusal, Unreachable } from "./client";

export const LARGEST = 4_000_000;

export const templates = queryOptions({
  queryKey: ["templates"],
  queryFn: () => answer(client.GET("/api/templates")),
  staleTime: Number.POSITIVE_INFINITY,
});

/** Deleted scenarios, the latest first. */
export const trash = queryOptions({
  queryKey: ["trash"],
  queryFn: () => answer(client.GET("/api/trash")),
});

/** A text, and the digest by which the server knows whether it is still the one. */
export interface Text {
  text: string;
  digest: string;
}

/** The text of a scenario file; while it is edited nobody may exchange it, so it is asked for when the editor opens. */
export const text = (id: string) =>
  queryOptions({
    queryKey: ["text", id],
    queryFn: () => readText(id),
    gcTime: 0,
    staleTime: Number.POSITIVE_INFINITY,
    refetchOnWindowFocus: false,
    refetchOnReconnect: false,
  });

export async function readText(id: string): Promise<Text> {
  const asked = client.GET("/api/scenarios/{scenario}/text", { params: { path: { scenario: id } }, parseAs: "text" });
  const { data, error, response } = await asked.catch(() => {
    throw new Unreachable();
  });
  if (!response.ok) throw refusal(parsed(error), response.status);
  return { text: data ?? "", digest: (response.headers.get("ETag") ?? "").replaceAll('"', "") };
}

/** With `parseAs: "text"` a refusal comes as it was sent. */
function parsed(body: unknown): unknown {
  try {
    return typeof body === "string" ? JSON.parse(body) : body;
  } catch {
    return {};
  }
}

const AS_YAML = { bodySerializer: (body: string) => body, headers: { "Content-Type": "application/yaml" } };

/** What is wrong with a text, line by line. */
export const textCheck = (id: string, body: string) =>
  queryOptions({
    queryKey: ["text check", id, body],
    queryFn: () =>
      answer(
        client.POST("/api/scenarios/{scenario}/text/check", { params: { path: { scenario: id } }, body, ...AS_YAML }),
      ),
    gcTime: 30_000,
    staleTime: 30_000,
  });

/** Where a scenario file is downloaded from. */
export const downloadOf = (id: string): string => `/api/scenarios/${encodeURIComponent(id)}/text?download=true`;

const expecting = (digest: string | undefined) => (digest ? { "If-Match": `"${digest}"` } : {});

/** Ask again for everything that may say something else now: the list, the trash, and of one scenario form, check and scene. */
function refresh(kept: QueryClient, ...ids: string[]): Promise<unknown> {
  const isOf = (key: readonly unknown[]) =>
    ids.includes(String(key[1])) || ids.includes((key[1] as { scenario?: string } | undefined)?.scenario ?? "");
  return Promise.all([
    kept.invalidateQueries({ queryKey: ["scenarios"] }),
    kept.invalidateQueries({ queryKey: ["trash"] }),
    kept.invalidateQueries({
      predicate: ({ queryKey }) => ["scenario", "check", "scene"].includes(String(queryKey[0])) && isOf(queryKey),
    }),
  ]);
}

export const isTaken = (error: unknown): boolean => error instanceof Refusal && error.status === 409;
/** Whether somebody else has changed or deleted the file meanwhile. */
export const isStale = (error: unknown): boolean => error instanceof Refusal && error.status === 412;
export const isGone = (error: unknown): boolean => error instanceof Refusal && error.status === 404;

export function useCreate() {
  const kept = useQueryClient();
  return useMutation({
    mutationFn: (body: Server["NewScenario"]) => answer(client.POST("/api/scenarios", { body })),
    onSuccess: () => refresh(kept),
  });
}

interface Copy {
  id: string;
  name: string;
  title?: string | undefined;
  set?: Changes;
}

export function useCopy() {
  const kept = useQueryClient();
  return useMutation({
    mutationFn: ({ id, name, title, set = {} }: Copy) =>
      answer(
        client.POST("/api/scenarios/{scenario}/copy", {
          params: { path: { scenario: id } },
          body: { name, set, ...(title ? { title } : {}) },
        }),
      ),
    onSuccess: () => refresh(kept),
  });
}

interface Renaming extends Omit<Copy, "set"> {
  digest: string;
}

export function useRename() {
  const kept = useQueryClient();
  return useMutation({
    mutationFn: ({ id, name, title, digest }: Renaming) =>
      answer(
        client.POST("/api/scenarios/{scenario}/rename", {
          params: { path: { scenario: id } },
          headers: expecting(digest),
          body: { name, ...(title ? { title } : {}) },
        }),
      ),
    onSettled: (done, _error, { id }) =>
      Promise.all([
        // Of the old name there is nothing to ask for any more.
        refresh(kept, ...(done && done.scenario !== id ? [] : [id])),
        kept.invalidateQueries({ queryKey: ["runs"] }),
      ]),
  });
}

export function useDeleteScenario() {
  const kept = useQueryClient();
  return useMutation({
    mutationFn: ({ id, digest }: { id: string; digest: string }) =>
      answer(
        client.DELETE("/api/scenarios/{scenario}", { params: { path: { scenario: id } }, headers: expecting(digest) }),
      ),
    onSettled: () => refresh(kept),
  });
}

export function useRestore() {
  const kept = useQueryClient();
  return useMutation({
    mutationFn: ({ entry, name }: { entry: string; name?: string }) =>
      answer(client.POST("/api/trash/{entry}/restore", { params: { path: { entry } }, body: name ? { name } : {} })),
    onSettled: (done) => refresh(kept, ...(done ? [done.scenario] : [])),
  });
}

/** Take a file in under a name; it is checked before. */
export function useImport() {
  const kept = useQueryClient();
  return useMutation({
    mutationFn: ({ name, text: body }: { name: string; text: string }) =>
      answer(client.POST("/api/scenarios/import", { params: { query: { name } }, body, ...AS_YAML })),
    onSuccess: ({ scenario }) => refresh(kept, scenario),
  });
}

/** Write a text in the place of a file, if that is still the one with this digest. */
export function useSaveText() {
  const kept = useQueryClient();
  return useMutation({
    mutationFn: ({ id, text: body, digest }: Text & { id: string }) =>
      answer(
        client.PUT("/api/scenarios/{scenario}/text", {
          params: { path: { scenario: id } },
          body,
          ...AS_YAML,
          headers: { ...AS_YAML.headers, ...expecting(digest) },
        }),
      ),
    onSuccess: (_done, { id }) => refresh(kept, id),
  });
}

/** Write the changes of a form into its file. */
export function useSaveForm(id: string) {
  const kept = useQueryClient();
  return useMutation({
    mutationFn: ({ set, digest }: { set: Changes; digest: string | undefined }) =>
      answer(
        client.POST("/api/scenarios/{scenario}/save", {
          params: { path: { scenario: id } },
          headers: expecting(digest),
          body: { set },
        }),
      ),
    onSettled: () => refresh(kept, id),
  });
}

/** Take back what was saved, unless somebody has changed the file since. */
export function useTakeBackSave(id: string) {
  const kept = useQueryClient();
  return useMutation({
    mutationFn: ({ inverse, digest }: Server["Patched"]) =>
      answer(
        client.PATCH("/api/scenarios/{scenario}", {
          params: { path: { scenario: id } },
          headers: { "Content-Type": "application/json-patch+json", ...expecting(digest) },
          body: inverse,
        }),
      ),
    onSettled: () => refresh(kept, id),
  });
}
