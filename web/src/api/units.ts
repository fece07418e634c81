/** Units of what was set: they stand in the schemas of the scenarios, not in the runs. */

import { useQueries, useQuery } from "@tanstack/react-query";
import { useMemo } from "react";
import { type KnownKind, unitsOf, unitsOfKinds } from "../model/form";
import type { Run } from "../model/run";
import { kinds, scenario } from "./queries";

/** The unit of every path that these runs may have set. */
export function useUnits(runs: readonly Run[]): Record<string, string> {
  const ids = useMemo(() => [...new Set(runs.map((run) => run.scenario))], [runs]);
  const { data: known } = useQuery(kinds);
  const found = useQueries({
    queries: ids.map((id) => ({ ...scenario(id), staleTime: 60_000 })),
    combine: (results) => results.flatMap(({ data }) => (data ? [data] : [])),
  });
  return useMemo(() => {
    const all = found.map(({ document, given, schema }) =>
      unitsOf({ document, given, schema, kinds: known?.kinds ?? [], changes: {} }),
    );
    return Object.assign({}, unitsOfKinds((known?.kinds ?? []) as KnownKind[]), ...all) as Record<string, string>;
  }, [found, known]);
}
