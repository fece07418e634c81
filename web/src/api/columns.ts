/** Recorded channels in one number, of every run: what is there is asked for at once, what is lacking is worked out piece by piece. */

import { type QueryClient, queryOptions, useQueries, useQueryClient } from "@tanstack/react-query";
import { useEffect, useMemo } from "react";
import { channelColumn, joined, samplesOf, type Told } from "../model/column";
import { isLive, type ListedRun } from "../model/run";
import type { Column } from "../model/table";
import { answer, client } from "./client";
import { run as runQuery } from "./queries";

/** So many scenarios tell which channels there are. */
const SAMPLES = 8;

const column = (name: string) =>
  queryOptions({
    queryKey: ["column", name],
    queryFn: async (): Promise<Told> => answer(client.GET("/api/column", { params: { query: { name } } })),
    staleTime: Number.POSITIVE_INFINITY,
    retry: false,
  });

/** The columns of these names, which fill while somebody looks at them, what was refused, and how it is tried again. */
export function useChannelColumns(names: readonly string[], all: readonly ListedRun[]) {
  const kept = useQueryClient();
  const found = useQueries({ queries: names.map(column) });
  const over = all.reduce((sum, { status }) => sum + Number(!isLive(status)), 0);
  const told = found.map(({ data }) => data);
  // A run that is over now has a number, too.
  useEffect(() => void kept.invalidateQueries({ queryKey: ["column"] }), [over]);
  useEffect(() => {
    for (const [i, name] of names.entries()) if (told[i] && told[i].lacking > 0 && !told[i].refused) void fill(kept, name);
  }, told);
  const columns = useMemo((): Column[] => names.map((name, i) => channelColumn(name, told[i])), [names, ...told]);
  const refused = found.flatMap(({ data, error }) => data?.refused ?? error ?? [])[0];
  return { columns, refused, retry: () => void kept.invalidateQueries({ queryKey: ["column"] }) };
}

/** Names of columns that are being worked out. */
const filling = new Set<string>();

/** Works out what is lacking, some runs at a time, as long as somebody looks. */
async function fill(kept: QueryClient, name: string) {
  const { queryKey } = column(name);
  if (filling.has(name)) return;
  filling.add(name);
  try {
    for (let lacking = 1; lacking > 0 && kept.getQueryCache().find({ queryKey })?.isActive(); ) {
      const more: Told = await answer(client.POST("/api/column", { params: { query: { name } } }));
      kept.setQueryData(queryKey, (before) => joined(before, more));
      lacking = more.cells.length > 0 ? more.lacking : 0;
    }
  } catch (error) {
    kept.setQueryData(queryKey, (before) => before && { ...before, refused: error as Error });
  } finally {
    filling.delete(name);
  }
}

/** Channels and events that runs of these scenarios have. */
export function useRecorded(all: readonly ListedRun[]) {
  const found = useQueries({ queries: samplesOf(all, SAMPLES).map(runQuery) });
  const details = found.flatMap(({ data }) => data ?? []);
  const channels = new Map(details.flatMap(({ channels: own }) => own.map((each) => [each.name, each] as const)));
  const events = new Set(details.flatMap(({ events: own }) => own.map(({ kind }) => kind)));
  return { isPending: found.some(({ isPending }) => isPending), channels: [...channels.values()], events: [...events].filter(Boolean) };
}
