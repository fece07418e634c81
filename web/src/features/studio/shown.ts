/** The run that the studio shows: live or stored, in one shape. */

import { useQuery } from "@tanstack/react-query";
import { useEffect, useMemo, useState } from "react";
import { type LiveState, useLive } from "../../api/live";
import * as queries from "../../api/queries";
import type { Span } from "../../charts/zoom";
import { drawn, leadersOf } from "../../model/channel";
import { type Layout, needed } from "../../model/layout";
import { type Channel, isLive, type RunDetail } from "../../model/run";
import type { Samples } from "../../model/samples";
import { durationOf } from "./form";
import type { Progressing } from "./RunBar";

const NONE: never[] = [];

/** The run in the address: its live state while it goes, its stored trace of what the charts show otherwise. */
export function useShownRun(run: number | undefined, layout: Layout, span: Span | undefined) {
  const stored = useQuery({ ...queries.run(run ?? 0), enabled: run !== undefined });
  const detail = run === undefined ? undefined : stored.data;
  const [followed, follow] = useState<number>();
  const going = isLive(detail?.status);
  useEffect(() => {
    if (going) follow(run);
  }, [going, run]);
  const live = useLive(followed === run ? run : undefined);
  // The process of a run may die without a last word; what is stored then counts.
  const lost = live !== undefined && !live.connected && detail !== undefined && !going;
  useEffect(() => {
    if (lost) follow(undefined);
  }, [lost]);
  const { data: spanned } = useQuery(queries.beyond(detail));
  const samples = useStoredSamples(live ? undefined : detail, layout, span);
  return {
    live,
    detail,
    channels: live?.channels ?? detail?.channels ?? NONE,
    samples: live?.samples ?? samples,
    /** Whether the run is over and its samples are on their way. */
    coming: run !== undefined && !live && !stored.error && (detail === undefined || (!going && detail.channels.length > 0)) && !samples,
    version: live?.version ?? 0,
    events: live?.events ?? detail?.events ?? NONE,
    spanned,
    progress: live ? fromLive(live) : detail ? fromStored(detail) : undefined,
  };
}

const fromLive = ({ run, status, time, duration_s, real_time_factor, position, error }: LiveState): Progressing => ({
  run,
  status,
  time,
  duration: duration_s,
  factor: real_time_factor,
  position,
  error,
});

const fromStored = ({ run, status, sim_time_s, error, document }: RunDetail): Progressing => ({
  run,
  status,
  time: sim_time_s ?? 0,
  duration: durationOf(document) || (sim_time_s ?? 0),
  factor: 0,
  position: 0,
  error,
});

/** The trace of a finished run in the same shape as live samples. */
function useStoredSamples(
  run: RunDetail | undefined,
  layout: Layout,
  span: Span | undefined,
): Samples | undefined {
  const finished = run !== undefined && !isLive(run.status);
  const known = finished ? run.channels : NONE;
  const names = useMemo(() => known.map(({ name }: Channel) => name), [known]);
  const channels = useMemo(() => {
    const leaders = leadersOf(run?.document);
    return needed(layout, (quantity) => drawn(quantity, names, leaders), new Set(names));
  }, [layout, names, run?.document]);
  const { data } = useQuery(queries.trace(run?.run ?? 0, channels, { span }));
  return useMemo(() => {
    if (!finished || !data) return undefined;
    const columns = Object.entries(data.channels).map(([name, { values }]) => [name, values] as const);
    return { time: data.time, channels: Object.fromEntries(columns) };
  }, [data, finished]);
}
