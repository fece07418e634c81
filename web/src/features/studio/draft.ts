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
  /** How many seeds are run at once, from the one above on. */
  seeds: number;
}

const FRESH: Draft = { changes: {}, seed: null, pace: 1, parent: null, seeds: 1 };

const NOTHING: Partial<Draft> = {};

/** The draft of a scenario, how to change parts of it, and whether nobody has done so yet. */
export function useDraft(scenario: string): [Draft, (part: Partial<Draft>) => void, boolean] {
  const [stored, store] = useSessionStorage<Partial<Draft>>({
    key: draftKey(scenario),
    defaultValue: NOTHING,
    getInitialValueInEffect: false,
  });
  const update = useCallback(
    (part: Partial<Draft>) => store((before) => ({ ...FRESH, ...before, ...part })),
    [store],
  );
  const draft = useMemo(() => ({ ...FRESH, ...stored }), [stored]);
  return [draft, update, Object.keys(stored).length === 0];
}
