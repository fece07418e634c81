/** What the 3D scene shows. */

import { useDebouncedValue } from "@mantine/hooks";
import { useQuery, useQueryClient } from "@tanstack/react-query";
import { useCallback, useEffect, useMemo, useState } from "react";
import { Unreachable } from "../../api/client";
import * as queries from "../../api/queries";
import type { Scene } from "../../api/types";
import type { Changes } from "../../model/run";
import { notifyError } from "../../ui/notify";

const NO_SCENE: Scene = { vehicles: [], attribution: "", map: "", begin: null, end: null, step: null, notes: [], missing: {}, ghosts: [] };

/** Show the scenario in the 3D scene, or a run: as it goes on, or, when it is `over`, as it was recorded. */
export function useScene(id: string, set: Changes, run: number | undefined, over: boolean, ok: boolean, ghosts = "", align = "", blocked = "") {
  // Only what changes the picture is worth building the scene again.
  const visible = useMemo(
    () => Object.fromEntries(Object.entries(set).filter(([path]) => SEEN.test(path))),
    [set],
  );
  const what = useMemo(
    () => (run === undefined ? { scenario: id, set: visible } : { run, over, ghosts: over ? ghosts : "", align }),
    [id, visible, run, over, ghosts, align],
  );
  const [settled] = useDebouncedValue(what, run === undefined ? 400 : 0);
  // That this is in order says nothing about what stood here before.
  const enabled = ok && settled === what;
  const { data = NO_SCENE, error, isPlaceholderData } = useQuery({ ...queries.scene(settled), enabled });
  useEffect(() => {
    // That the server is gone stands over the whole page.
    if (error && !(error instanceof Unreachable)) notifyError(error);
  }, [error]);
  const client = useQueryClient();
  const again = useCallback(() => client.refetchQueries({ queryKey: ["scene"], type: "active" }), [client]);
  const paints = useMemo(
    () => Object.fromEntries(data.vehicles.map(({ name, color }) => [name, color])),
    [data.vehicles],
  );
  // What stands in the scene is of the scenario before until the answer about this one is there.
  const arrived = data !== NO_SCENE && !isPlaceholderData && settled === what;
  const [whose, belongs] = useState<string>();
  useEffect(() => {
    if (arrived) belongs(id);
  }, [arrived, id]);
  const waits = whose === id ? "" : error ? error.message : ok ? "The server puts up streets, houses and cars" : blocked || "The scenario is read";
  return { ...data, paints, again, waits, settling: isPlaceholderData || settled !== what };
}

const SEEN = /^(map|vehicles|traffic|script|weather|routes)\b/;
