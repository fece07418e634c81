/** The files that are on their way to the server, and the imports that go on there; they outlive a change of place. */

import { useQuery, useQueryClient } from "@tanstack/react-query";
import { useCallback, useEffect, useRef, useSyncExternalStore } from "react";
import { Cancelled, mapJobs, noteJob, upload } from "../../api/maps";
import type { MapJob } from "../../model/map";
import { nameFor } from "../../model/place";
import type { Problem } from "../../model/run";

/** A file that was dropped or chosen, until the server has taken it. */
export interface Upload {
  key: number;
  file: File;
  name: string;
  bbox: string;
  replace: boolean;
  /** How much of it is sent, 0 to 1. */
  share: number;
  /** Why it was not taken. */
  error: (Error & { problems?: Problem[] }) | undefined;
  /** The import that it has become. */
  job: number | undefined;
}

/** What is kept while the page lives: the uploads, and the failed imports that were waved away. */
class Store {
  uploads: readonly Upload[] = [];
  dismissed: ReadonlySet<number> = new Set();
  private listeners = new Set<() => void>();
  private cancels = new Map<number, () => void>();
  private next = 1;

  subscribe = (listener: () => void): (() => void) => {
    this.listeners.add(listener);
    return () => this.listeners.delete(listener);
  };

  private tell(): void {
    for (const listener of this.listeners) listener();
  }

  private put(uploads: readonly Upload[]): void {
    this.uploads = uploads;
    this.tell();
  }

  private change(key: number, part: Partial<Upload>): void {
    this.put(this.uploads.map((each) => (each.key === key ? { ...each, ...part } : each)));
  }

  /** Send a file; the job that it becomes, or undefined when it was refused or cancelled. */
  async send(what: Pick<Upload, "file" | "name" | "bbox" | "replace">): Promise<MapJob | undefined> {
    const key = this.next++;
    this.put([{ ...what, key, share: 0, error: undefined, job: undefined }, ...this.uploads]);
    const { done, cancel } = upload(what, (share) => this.change(key, { share }));
    this.cancels.set(key, cancel);
    try {
      const job = await done;
      this.change(key, { job: job.id, share: 1 });
      return job;
    } catch (error) {
      if (error instanceof Cancelled) this.forget(key);
      else this.change(key, { error: error as Error });
      return undefined;
    } finally {
      this.cancels.delete(key);
    }
  }

  cancel(key: number): void {
    this.cancels.get(key)?.();
  }

  forget(key: number): void {
    this.put(this.uploads.filter((each) => each.key !== key));
  }

  dismiss(job: number): void {
    this.dismissed = new Set([...this.dismissed, job]);
    this.put(this.uploads.filter((each) => each.job !== job));
  }
}

export const store = new Store();

export const useUploads = (): readonly Upload[] => useSyncExternalStore(store.subscribe, () => store.uploads);
export const useDismissed = (): ReadonlySet<number> =>
  useSyncExternalStore(store.subscribe, () => store.dismissed);

const NONE: never[] = [];

/** The imports of the server. */
export function useJobs(): readonly MapJob[] {
  return useQuery(mapJobs).data ?? NONE;
}

/** Call this once for each import that comes to its end meanwhile, also for one that was never seen going on. */
export function useEnds(onEnd: (job: MapJob) => void): void {
  const { data: jobs } = useQuery(mapJobs);
  const over = useRef<Set<number>>(undefined);
  const latest = useRef(onEnd);
  latest.current = onEnd;
  useEffect(() => {
    if (!jobs) return;
    const [before, ended] = [over.current, jobs.filter(({ status }) => status !== "running")];
    over.current = new Set(ended.map(({ id }) => id));
    if (before) for (const job of ended) if (!before.has(job.id)) latest.current(job);
  }, [jobs]);
}

/** What is known of a map is asked again when an import of it ends. */
export function useRefresh(): void {
  const kept = useQueryClient();
  useEnds(({ map, status }) => {
    if (status !== "done") return;
    void kept.invalidateQueries({ queryKey: ["maps"] });
    void kept.invalidateQueries({ queryKey: ["map", map] });
  });
}

/** Send files, one import each; the last job is the one to wait for. */
export function useSend() {
  const kept = useQueryClient();
  return useCallback(
    async (files: readonly File[], { name = "", bbox = "", replace = false } = {}) => {
      const sent = files.map((file) => store.send({ file, name: nameFor(file, files.length === 1 ? name : ""), bbox, replace }));
      const jobs = (await Promise.all(sent)).filter((job) => job !== undefined);
      for (const job of jobs) noteJob(kept, job);
      await kept.invalidateQueries({ queryKey: ["map jobs"] });
      return jobs;
    },
    [kept],
  );
}
