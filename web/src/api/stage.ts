/** The stage of this page: the scene that it has to itself, whatever other tabs show. */

import { queryOptions } from "@tanstack/react-query";
import { answer, client, Refusal } from "./client";

/** A tab that is loaded again wishes for the stage that it had; one that was opened from it has its memory, but not its stage. */
const KEY = "stage";

let given: Promise<number> | undefined;

/** The number of this page's stage, asked for once. */
export function stage(): Promise<number> {
  given ??= allotted().catch((error) => {
    given = undefined;
    throw error;
  });
  return given;
}

async function allotted(): Promise<number> {
  const found = await answer(client.POST("/api/stages", { body: { wanted: remembered() } }));
  sessionStorage.setItem(KEY, String(found.stage));
  return found.stage;
}

function remembered(): number | null {
  const kept = Number(sessionStorage.getItem(KEY));
  return Number.isInteger(kept) && kept > 0 ? kept : null;
}

/** Where the scene of this page is; asked again when all stages are taken, or nobody answers, as another tab may have been closed. */
export const scenePlace = queryOptions({
  queryKey: ["stage"],
  queryFn: async () => {
    const number = await stage();
    return number === 1 ? "/scene/" : `/scene/${number}/`;
  },
  staleTime: Number.POSITIVE_INFINITY,
  gcTime: Number.POSITIVE_INFINITY,
  retry: (_count, error) => !(error instanceof Refusal),
  retryDelay: 1000,
  refetchInterval: ({ state }) => (state.status === "error" ? 3000 : false),
});
