/** The notice at the end of a run. */

import { useQueryClient } from "@tanstack/react-query";
import { Link } from "@tanstack/react-router";
import { useEffect, useRef } from "react";
import type { LiveState } from "../../api/live";
import { isLive } from "../../model/run";
import { notify } from "../../ui/notify";

/** When the run ends: say so, with the way to its page. */
export function useFarewell(live: LiveState | undefined, run: number | undefined) {
  const client = useQueryClient();
  const before = useRef<{ run: number; going: boolean }>(undefined);
  const status = live?.status;
  useEffect(() => {
    if (!status || run === undefined) return;
    const ended = before.current?.run === run && before.current.going && !isLive(status);
    before.current = { run, going: isLive(status) };
    if (!ended) return;
    void client.invalidateQueries({ queryKey: ["runs"] });
    void client.invalidateQueries({ queryKey: ["run", run] });
    notify(
      `Run #${run} ${status === "done" ? "is done" : status}`,
      <Link to="/runs/$run" params={{ run: String(run) }}>
        Show its metrics and charts
      </Link>,
      status === "done" ? "teal" : status === "stopped" || status === "cancelled" ? "gray" : "red",
    );
  }, [status, run, client]);
}
