/** The parameter form of a scenario, as the page and the server see it. */

import { useDebouncedValue } from "@mantine/hooks";
import { useQuery } from "@tanstack/react-query";
import { useCallback, useMemo } from "react";
import { maps } from "../../api/maps";
import * as queries from "../../api/queries";
import { refusal, sections, suggesting } from "../../model/form";
import type { Changes } from "../../model/run";

const NONE: never[] = [];

/** The form of a scenario with the user's changes, and what the server says about them. */
export function useForm(id: string, changes: Changes) {
  const scenario = useQuery(queries.scenario(id));
  const kinds = useQuery(queries.kinds);
  const { document, given, schema } = scenario.data ?? {};
  const known = kinds.data?.kinds ?? NONE;
  // Without an answer the name of the map is typed.
  const { data: places } = useQuery(maps);
  const form = useMemo(() => {
    if (!document || !given || !schema) return undefined;
    const files = places?.map((place) => `maps/${place.id}`) ?? NONE;
    return suggesting(sections({ document, given, schema, kinds: known, changes }), "map.file", files);
  }, [document, given, schema, known, changes, places]);
  const [settled] = useDebouncedValue(changes, 300);
  const { data: checked, isPlaceholderData } = useQuery({
    ...queries.check(id, settled),
    enabled: form !== undefined,
  });
  // What was said about earlier changes says nothing about these.
  const ok = checked !== undefined && checked.ok && settled === changes && !isPlaceholderData;
  const { refetch: again } = scenario;
  const { refetch: andKinds } = kinds;
  const retry = useCallback(() => void Promise.all([again(), andKinds()]), [again, andKinds]);
  const error = scenario.error ?? kinds.error;
  const problems = checked?.problems ?? NONE;
  const blocked = error ? `The scenario could not be loaded: ${error.message}` : refusal(problems);
  return useMemo(
    () => ({
      blocked,
      sections: form,
      ok,
      problems,
      /** Of the file that the form stands for. */
      digest: scenario.data?.digest,
      title: scenario.data?.title,
      duration: durationOf(checked?.document ?? document),
      seed: typeof document?.seed === "number" ? document.seed : 1,
      error,
      retry,
    }),
    [form, ok, checked, problems, blocked, document, scenario.data, error, retry],
  );
}

export type Form = ReturnType<typeof useForm>;

/** How long the scenario runs [s], wherever the document says it. */
export function durationOf(document: unknown): number {
  const { clock, duration } = (document ?? {}) as { clock?: { duration?: unknown }; duration?: unknown };
  const found = clock?.duration ?? duration;
  return typeof found === "number" ? found : 0;
}
