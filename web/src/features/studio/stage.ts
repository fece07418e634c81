/** What the 3D scene shows. */

import { useDebouncedValue } from "@mantine/hooks";
import { useQuery } from "@tanstack/react-query";
import { useEffect, useMemo } from "react";
import * as queries from "../../api/queries";
import type { Changes } from "../../model/run";
import { notifyError } from "../../ui/notify";

const NO_SCENE = { vehicles: [], attribution: "" };

/** Show the scenario in the 3D scene, or the run that is going; when it ends, its last moment stays. */
export function useScene(id: string, set: Changes, live: number | undefined, ok: boolean) {
  // Only what changes the picture is worth building the scene again.
  const visible = useMemo(
    () => Object.fromEntries(Object.entries(set).filter(([path]) => SEEN.test(path))),
    [set],
  );
  const what = live === undefined ? { scenario: id, set: visible } : { run: live };
  const [settled] = useDebouncedValue(what, live === undefined ? 400 : 0);
  const { data = NO_SCENE, error } = useQuery({ ...queries.scene(settled), enabled: ok });
  useEffect(() => {
    if (error) notifyError(error);
  }, [error]);
  return data;
}

const SEEN = /^(map|vehicles|traffic|platoon|route|routes)\b/;
