/** What the buttons of the run bar do, and where a new run's setting comes from. */

import { useQuery } from "@tanstack/react-query";
import { useNavigate } from "@tanstack/react-router";
import { useEffect } from "react";
import type { LiveState } from "../../api/live";
import * as queries from "../../api/queries";
import { fromSet, refusal } from "../../model/form";
import { isLive, type Problem } from "../../model/run";
import { notify, notifyError } from "../../ui/notify";
import type { Draft } from "./draft";
import type { Controls } from "./RunBar";

interface ControlProps {
  id: string;
  draft: Draft;
  update: (part: Partial<Draft>) => void;
  seed: number;
  live: LiveState | undefined;
  run: number | undefined;
  /** Why no run can be started; empty when one can. */
  blocked: string;
}

/** What the buttons of the run bar do. */
export function useControl({
  id,
  draft,
  update,
  seed,
  live,
  run,
  blocked,
}: ControlProps): Controls & { starting: boolean } {
  const start = useStarter({ id, draft, update, seed, blocked });
  const order = queries.useOrder();
  const pace = queries.usePace();
  const tell = (what: queries.Order) => {
    if (run !== undefined) order.mutate({ run, order: what }, { onError: notifyError });
  };
  return {
    starting: start.isPending,
    onRun: () => start.begin(false),
    onPause: () => tell("pause"),
    onResume: () => tell("resume"),
    onStop: () => tell("stop"),
    onStep: () => (live && isLive(live.status) ? tell("step") : start.begin(true)),
    onSeed: (seed) => update({ seed }),
    onSeeds: (seeds) => update({ seeds: Math.min(Math.max(1, Math.round(seeds)), MOST_SEEDS) }),
    onPace: (next) => {
      update({ pace: next });
      if (run !== undefined && live && isLive(live.status))
        pace.mutate({ run, pace: next }, { onError: notifyError });
    },
  };
}

/** So many seeds are run at once; those that have no place wait for their turn. */
export const MOST_SEEDS = 100;

/** Start a run of the draft and show it; the one after it will be its child. */
function useStarter({ id, draft, update, seed, blocked }: Omit<ControlProps, "live" | "run">) {
  const start = queries.useStart();
  const others = queries.useStartUnseen();
  const order = queries.useOrder();
  const navigate = useNavigate();
  const begin = (paused: boolean) => {
    if (start.isPending) return;
    if (blocked) return notify("No run was started", blocked, "red");
    const { changes, pace, parent, seeds } = draft;
    const body = { scenario: id, set: changes, seed, pace, paused, ...(parent === null ? {} : { parent }) };
    start.mutate(body, {
      onError: (error) => notifyError(Object.keys(changes).length ? ofForm(error) : error),
      onSuccess: ({ run, status }) => {
        update({ parent: run });
        const rest = Array.from({ length: paused ? 0 : seeds - 1 }, (_, place) => seed + 1 + place);
        const family = parent === null ? {} : { parent };
        if (rest.length) others.mutate({ scenario: id, set: changes, ...family, rest }, { onError: notifyError });
        // A first step out of rest is one step, too; a run that is not up yet just stays at its start.
        if (paused && status !== "waiting") order.mutate({ run, order: "step" });
        navigate({ to: "/studio/$scenario", params: { scenario: id }, search: { run } });
      },
    });
  };
  return { begin, isPending: start.isPending };
}

/** The file is as it should be when a changed form is refused. */
function ofForm(error: Error & { problems?: Problem[] }): Error {
  const text = refusal(error.problems ?? []);
  return text ? new Error(text) : error;
}

/** "Tune from here": take over the setting of a run, once. A form that nobody has touched takes over that of the run in the address. */
export function useTakeOver(id: string, from: number | undefined, run: number | undefined, update: (part: Partial<Draft>) => void) {
  const navigate = useNavigate();
  const wanted = from ?? run;
  const { data } = useQuery({ ...queries.run(wanted ?? 0), enabled: wanted !== undefined });
  useEffect(() => {
    if (wanted === undefined || data?.run !== wanted) return;
    if (data.scenario === id) update({ changes: fromSet(data.parameters), seed: data.seed, parent: wanted });
    if (from !== undefined)
      navigate({ to: "/studio/$scenario", params: { scenario: id }, search: { run: from }, replace: true });
  }, [wanted, from, data, id, navigate, update]);
}
