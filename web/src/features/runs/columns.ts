/** The columns that a table of these runs has. */

import { useMemo } from "react";
import { useGlossary } from "../../api/glossary";
import { useUnits } from "../../api/units";
import type { ListedRun } from "../../model/run";
import { type Column, metricColumns, parameterColumns, RUN_COLUMNS } from "../../model/table";

export function useColumns(all: readonly ListedRun[], ofChannels: readonly Column[]): Column[] {
  const units = useUnits(all);
  const known = useGlossary().metrics;
  const own = useMemo(() => [...RUN_COLUMNS, ...parameterColumns(all, units), ...metricColumns(all, known)], [all, units, known]);
  return useMemo(() => [...own, ...ofChannels], [own, ofChannels]);
}
