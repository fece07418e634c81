/** The scenario that is edited: read, changed by named steps, undone, and what others do to it. */

import { queryOptions, useMutation, useQuery, useQueryClient } from "@tanstack/react-query";
import { useEffect, useRef, useState } from "react";
import { isAbsolute } from "../model/editing/deed";
import type { Deed, Editing, Way } from "../model/editing/item";
import type { Plan } from "../model/map";
import type { Server } from "../model/run";
import { answer, client, Refusal } from "./client";

export const editing = (id: string) =>
  queryOptions({
    queryKey: ["editing", id],
    queryFn: () =>
      answer(client.GET("/api/scenarios/{scenario}/editing", { params: { path: { scenario: id } } })) as Promise<Editing>,
    staleTime: 5_000,
  });

/** The map of a scenario from above; the name of its map and how it is cut stand in the key. */
export const scenarioPlan = (id: string, map: unknown) =>
  queryOptions({
    queryKey: ["scenario plan", id, map],
    queryFn: () => answer(client.GET("/api/scenarios/{scenario}/plan", { params: { path: { scenario: id } } })) as Promise<Plan>,
    enabled: map !== undefined,
    staleTime: Number.POSITIVE_INFINITY,
    gcTime: 60_000,
  });

/** The way through points; what is wrong with it comes as a refusal. */
export async function findWay(id: string, body: Server["NewWay"]): Promise<Way> {
  const found = (await answer(client.POST("/api/scenarios/{scenario}/way", { params: { path: { scenario: id } }, body }))) as Way;
  if (found.problem) throw new Refusal(found.problem.message, found.problem.problems, 200);
  return found;
}

/** What this window is called among those that edit: everybody hears who has done what. */
export function whoAmI(): string {
  const kept = sessionStorage.getItem("editor");
  if (kept) return kept;
  const made = `browser ${Math.random().toString(36).slice(2, 6)}`;
  sessionStorage.setItem("editor", made);
  return made;
}

const NOTHING = { set: {}, patch: [], rename: {}, remove: [] };

/** A deed, and what is chosen when it is done. */
export interface Made {
  deed: Deed;
  paths?: readonly string[];
}

/** A deed as it was made from what was seen, or how it is made from what stands there when its turn comes. */
export type Make = Deed | ((now: Editing) => Made | undefined | Promise<Made | undefined>);

/**
 * Edits of a scenario, one after the other. What depends on what stands there is made when its turn comes; anything else is made to the
 * revision that was seen, or to one's own next ones: one's own quick second step is nobody else's.
 */
export function useEditing(id: string) {
  const kept = useQueryClient();
  const own = useRef(new Set<number>());
  const params = { path: { scenario: id } };
  const onSuccess = (state: Editing) => {
    const known = kept.getQueryData(editing(id).queryKey);
    if (!known || known.revision <= state.revision) kept.setQueryData(editing(id).queryKey, state);
    return others(kept, id);
  };
  const scope = { id: `editing ${id}` };
  const onError = () => kept.invalidateQueries({ queryKey: ["editing", id] });
  const done = (state: Editing) => {
    own.current.add(state.revision);
    return onSuccess(state);
  };
  const edit = useMutation({
    scope,
    mutationFn: async ({ make, seen }: { make: Make; seen: Editing }) => {
      const now = kept.getQueryData(editing(id).queryKey) ?? seen;
      const made = typeof make === "function" ? await make(now) : { deed: make };
      if (!made) return undefined;
      const base = typeof make === "function" ? now.revision : isAbsolute(make) ? afterOwn(seen.revision, own.current) : seen.revision;
      const body = { base, who: whoAmI(), ...NOTHING, ...made.deed };
      const state = (await answer(client.POST("/api/scenarios/{scenario}/editing", { params, body }))) as Editing;
      return { state, ...made };
    },
    onSuccess: (found) => found && done(found.state),
    onError,
  });
  const latest = () => kept.getQueryData(editing(id).queryKey)?.revision ?? 0;
  const undo = useMutation({
    scope,
    mutationFn: () =>
      answer(
        client.POST("/api/scenarios/{scenario}/editing/undo", { params, body: { base: latest(), who: whoAmI() } }),
      ) as Promise<Editing>,
    onSuccess: done,
    onError,
  });
  const redo = useMutation({
    scope,
    mutationFn: () =>
      answer(
        client.POST("/api/scenarios/{scenario}/editing/redo", { params, body: { base: latest(), who: whoAmI() } }),
      ) as Promise<Editing>,
    onSuccess: done,
    onError,
  });
  return { edit, undo, redo };
}

/** The last of one's own revisions that follow one without a gap. */
const afterOwn = (revision: number, own: ReadonlySet<number>): number => (own.has(revision + 1) ? afterOwn(revision + 1, own) : revision);

/** What other places of the page show of the scenario is asked for again. */
function others(kept: ReturnType<typeof useQueryClient>, id: string): Promise<unknown> {
  const isOf = (key: readonly unknown[]) => key[1] === id || (key[1] as { scenario?: string } | undefined)?.scenario === id;
  return Promise.all([
    kept.invalidateQueries({ queryKey: ["scenarios"] }),
    kept.invalidateQueries({ predicate: ({ queryKey }) => ["scenario", "check", "scene", "text"].includes(String(queryKey[0])) && isOf(queryKey) }),
  ]);
}

const RETRY_MS = 1500;

/** Hears of every change of a scenario, whoever makes it; returns whether the server is heard, and the last change by somebody else. */
export function useNews(id: string): { connected: boolean; by: Server["Revised"] | undefined; gone: Server["Gone"] | undefined } {
  const kept = useQueryClient();
  const [news, setNews] = useState<{ connected: boolean; by: Server["Revised"] | undefined; gone: Server["Gone"] | undefined }>({
    connected: true,
    by: undefined,
    gone: undefined,
  });
  const first = useRef(true);
  useEffect(() => {
    let [socket, timer, closed] = [undefined as WebSocket | undefined, undefined as ReturnType<typeof setTimeout> | undefined, false];
    const hear = (message: Server["Revised"] | Server["Gone"]) => {
      if (message.type === "gone") return setNews((before) => ({ ...before, gone: message }));
      const known = kept.getQueryData(editing(id).queryKey)?.revision;
      const isNew = known !== undefined && message.revision > known;
      if (isNew) void kept.invalidateQueries({ queryKey: ["editing", id] }).then(() => others(kept, id));
      const isOthers = message.revision > 0 && message.who !== whoAmI() && !first.current;
      first.current = false;
      setNews((before) => ({ connected: true, gone: undefined, by: isOthers ? message : before.by }));
    };
    const open = () => {
      socket = new WebSocket(`${location.origin.replace(/^http/, "ws")}/api/scenarios/${encodeURIComponent(id)}/editing/socket`);
      socket.onmessage = ({ data }) => hear(JSON.parse(String(data)));
      socket.onclose = () => {
        if (closed) return;
        setNews((before) => ({ ...before, connected: false }));
        timer = setTimeout(open, RETRY_MS);
      };
    };
    open();
    return () => {
      closed = true;
      clearTimeout(timer);
      socket?.close();
    };
  }, [kept, id]);
  return news;
}

/** The scenario that is edited, and its map. */
export function useEdited(id: string) {
  const state = useQuery(editing(id));
  const plan = useQuery(scenarioPlan(id, state.data?.document.map));
  return { state, plan };
}
