/** The stage of this page: the scene that it has to itself, whatever other tabs show. */

import { keepPreviousData, queryOptions } from "@tanstack/react-query";
import { answer, client, Refusal } from "./client";

/** A tab that is loaded again wishes for the stage that it had; one that was opened from it has its memory, but not its stage. */
const KEY = "stage";
/** The scene beside the plan has another one: the studio under the editor goes on showing what it did. */
const BOARD = "stage beside the plan";

let given: Promise<number> | undefined;

/** The number of this page's stage, asked for once. */
export function stage(): Promise<number> {
  given ??= allotted(KEY).catch((error) => {
    given = undefined;
    throw error;
  });
  return given;
}

async function allotted(key: string): Promise<number> {
  const found = await answer(client.POST("/api/stages", { body: { wanted: remembered(key) } }));
  sessionStorage.setItem(key, String(found.stage));
  return found.stage;
}

const addressOf = (stage: number): string => (stage === 1 ? "/scene/" : `/scene/${stage}/`);

function remembered(key: string): number | null {
  const kept = Number(sessionStorage.getItem(key));
  return Number.isInteger(kept) && kept > 0 ? kept : null;
}

/** Asked again when all stages are taken, or nobody answers, as another tab may have been closed. */
const patient = {
  staleTime: Number.POSITIVE_INFINITY,
  retry: (_count: number, error: Error) => !(error instanceof Refusal),
  retryDelay: 1000,
  refetchInterval: ({ state }: { state: { status: string } }) => (state.status === "error" ? (3000 as const) : (false as const)),
};

/** Where the scene of this page is. */
export const scenePlace = queryOptions({
  queryKey: ["stage"],
  queryFn: async () => addressOf(await stage()),
  ...patient,
  gcTime: Number.POSITIVE_INFINITY,
});

/** The stage of the scene beside the plan, and where it is; given up when that is closed. */
export const board = queryOptions({
  ...patient,
  queryKey: ["stage beside the plan"],
  queryFn: async () => {
    const number = await allotted(BOARD);
    return { number, place: addressOf(number) };
  },
  gcTime: 0,
});

/** Shows a revision of a scenario on a stage: its cars and objects where they stand at the start. */
export const onBoard = (scenario: string, revision: number, number: number | undefined) =>
  queryOptions({
    queryKey: ["scene beside the plan", scenario, revision, number],
    queryFn: () => answer(client.POST("/api/scene", { body: { stage: number ?? 1, scenario, set: {}, ghosts: [], align: "" } })),
    enabled: number !== undefined,
    // Showing is an act, not a fact: coming back to it must ask again.
    gcTime: 0,
    staleTime: Number.POSITIVE_INFINITY,
    refetchOnWindowFocus: false,
    refetchOnReconnect: false,
    placeholderData: keepPreviousData,
  });
