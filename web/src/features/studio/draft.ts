/** What the next run will be started with; it survives a reload of the page. */

import { useSessionStorage } from "@mantine/hooks";
import { useCallback, useMemo } from "react";
import type { Pace } from "../../api/types";
import type { Changes } from "../../model/run";
import { draftKey } from "../../ui/memory";

export interface Draft {
  changes: Changes;
  /** Null: as the scenario says. */
  seed: number | null;
  pace: Pace;
  parent: number | null;
}

const FRESH: Draft = { changes: {}, seed: null, pace: 1, parent: null };

/** The draft of a scenario, and how to change parts of it. */
export function useDraft(scenario: string): [Draft, (part: Partial<Draft>) => void] {
  const [stored, store] = useSessionStorage<Partial<Draft>>({
    key: draftKey(scenario),
    defaultValue: FRESH,
    getInitialValueInEffect: false,
  });
  const update = useCallback(
    (part: Partial<Draft>) => store((before) => ({ ...FRESH, ...before, ...part })),
    [store],
  );
  const draft = useMemo(() => ({ ...FRESH, ...stored }), [stored]);
  return [draft, update];
}
