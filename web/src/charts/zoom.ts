/** The stretch of time that all charts of a page look at. */

import { useCallback, useMemo, useState } from "react";

/** From when to when [s]. */
export type Span = readonly [number, number];

export interface Zoom {
  /** All of it without one. */
  readonly span: Span | undefined;
  readonly choose: (span: Span | undefined) => void;
}

/** [s] Nobody means less than this: a hand has shaken. */
const SHORTEST = 0.02;

/** The zoom of the charts of one thing, a run for instance; another thing is seen as a whole at first. */
export function useZoom(thing: unknown): Zoom {
  const [chosen, setChosen] = useState<{ thing: unknown; span: Span }>();
  const choose = useCallback(
    (span: Span | undefined) => {
      if (span === undefined) setChosen(undefined);
      else if (span[1] - span[0] >= SHORTEST) setChosen({ thing, span });
    },
    [thing],
  );
  const span = chosen?.thing === thing ? chosen?.span : undefined;
  return useMemo(() => ({ span, choose }), [span, choose]);
}
