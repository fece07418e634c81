/** The playhead of a run that is over: one time for the scene, the charts, the events and the clock. */

import { useEffect, useMemo, useSyncExternalStore } from "react";
import { answer, client, Unreachable } from "../../api/client";
import { stage } from "../../api/stage";
import type { Scene } from "../../api/types";
import type { Layers } from "../../model/layer";
import type { Server } from "../../model/run";
import { notifyError } from "../../ui/notify";
import type { Sight } from "./sight";

export const PACES = [0.05, 0.1, 0.25, 0.5, 1, 2, 4, 8, Number.POSITIVE_INFINITY];

/** [s] Between two pictures without a limit: as fast as the scene can show them. */
const STRIDE = 0.25;

/** Between two pictures; by a clock and not by what is drawn, so that a slow picture does not slow down the time. */
const PERIOD_MS = 20;

/** Of a sample: who is nearer to one than this stands on it. */
const SAME = 1e-3;

/**
 * [ms] From one look at what is drawn over the scene to the next: it is a hundred times the work of where everybody is, so that it comes
 * less often while the time goes on, and when it stands still, once more.
 */
const LOOK_MS = 100;

/** What is asked of the scene while it has not answered: only the newest time counts. */
interface Asking {
  busy: boolean;
  wanted: number | undefined;
  /** Whether the next question is for what is drawn over the scene as well. */
  all: boolean;
}

export class Playhead {
  time: number;
  playing = false;
  pace = 1;
  /** From when to when [s] it plays over and over. */
  loop: readonly [number, number] | undefined;
  private readonly listeners = new Set<() => void>();
  private readonly asking: Asking = { busy: false, wanted: undefined, all: false };
  private clock = 0;
  private look = 0;
  private looked = Number.NEGATIVE_INFINITY;
  private failed = false;

  constructor(
    readonly run: number,
    readonly begin: number,
    readonly end: number,
    readonly step: number,
    /** Shows a time in the scene: where everybody is, or all, with what is drawn over it. */
    private readonly show: (run: number, time: number, all: boolean) => Promise<unknown>,
  ) {
    this.time = end;
  }

  readonly subscribe = (listener: () => void): (() => void) => {
    this.listeners.add(listener);
    return () => this.listeners.delete(listener);
  };

  /** Go to a time [s]. */
  readonly seek = (time: number): void => {
    const next = Math.min(Math.max(time, this.begin), this.end);
    if (next === this.time) return;
    this.time = next;
    this.ask(next);
    this.tell();
  };

  /** So many samples on, or back; from between two the nearer one that way is the first. */
  readonly move = (samples: number): void => {
    this.pause();
    const at = (this.time - this.begin) / this.step;
    const from = samples > 0 ? Math.floor(at + SAME) : Math.ceil(at - SAME);
    this.seek(this.begin + (from + samples) * this.step);
  };

  /** So many seconds on, or back. */
  readonly jump = (seconds: number): void => this.seek(this.time + seconds);

  readonly toggle = (): void => (this.playing ? this.pause() : this.play());

  readonly choosePace = (pace: number): void => {
    this.pace = pace;
    this.tell();
  };

  /** Plays a stretch over and over from now on; without one, to the end. One that holds no two samples is none. */
  readonly repeat = (loop: readonly [number, number] | undefined): void => {
    if (loop && !this.holds(loop)) return;
    this.loop = loop && this.within(loop);
    this.tell();
  };

  /** Whether something of the run was recorded in a stretch. */
  readonly holds = (loop: readonly [number, number]): boolean => {
    const [from, to] = this.within(loop);
    return to - from >= this.step - SAME;
  };

  private within([from, to]: readonly [number, number]): readonly [number, number] {
    const inside = (time: number) => Math.min(Math.max(time, this.begin), this.end);
    return [inside(from), inside(to)];
  }

  /** At the end, from the beginning; outside of what it plays over and over, from the beginning of that. */
  play(): void {
    const [from, to] = this.loop ?? [this.begin, this.end];
    if (this.time >= to || (this.loop && this.time < from)) this.seek(from);
    this.playing = true;
    let last = performance.now();
    this.clock = window.setInterval(() => {
      const now = performance.now();
      this.goOn((now - last) / 1000);
      last = now;
    }, PERIOD_MS);
    this.tell();
  }

  /** Some seconds of real time have passed. */
  private goOn(seconds: number): void {
    const [from, to] = this.loop ?? [this.begin, this.end];
    const unlimited = this.pace === Number.POSITIVE_INFINITY;
    if (unlimited && this.asking.busy) return;
    this.seek(Math.min(this.time + (unlimited ? STRIDE : this.pace * seconds), to));
    if (this.time < to) return;
    if (this.loop && to > from) this.seek(from);
    else this.pause();
  }

  readonly pause = (): void => {
    if (!this.playing) return;
    window.clearInterval(this.clock);
    this.playing = false;
    this.tell();
  };

  /** Has the time shown where it stands. */
  readonly refresh = (): void => this.ask(this.time);

  /** Nobody looks any more. */
  readonly leave = (): void => {
    this.pause();
    window.clearTimeout(this.look);
  };

  /** Another question only when the last one is answered: a slow scene skips pictures and stays on time. */
  private ask(time: number, all = false): void {
    this.asking.wanted = time;
    this.asking.all ||= all;
    if (this.asking.busy) return;
    this.asking.busy = true;
    void this.drain();
  }

  private async drain(): Promise<void> {
    while (this.asking.wanted !== undefined) {
      const { wanted: time, all } = this.asking;
      Object.assign(this.asking, { wanted: undefined, all: false });
      if (all) this.looked = performance.now();
      else this.lookSoon();
      await this.show(this.run, time, all).then(
        () => {
          this.failed = false;
        },
        (error: Error) => this.fail(error),
      );
    }
    this.asking.busy = false;
  }

  private lookSoon(): void {
    if (this.look) return;
    const wait = Math.max(0, this.looked + LOOK_MS - performance.now());
    this.look = window.setTimeout(() => {
      this.look = 0;
      this.ask(this.time, true);
    }, wait);
  }

  /** The scene does not follow: told once, until it does again. That the server is gone is told elsewhere. */
  private fail(error: Error): void {
    if (!this.failed && !(error instanceof Unreachable)) notifyError(error);
    this.failed = true;
  }

  private tell(): void {
    for (const listener of this.listeners) listener();
  }
}

/**
 * Shows a time of a run in the scene, and answers what can be drawn over it, if that is asked for; when another page has had it show something else, it is
 * told `again` what this one wants.
 */
export async function showInScene(run: number, time: number, layers: boolean, again: () => Promise<unknown>): Promise<Layers | null> {
  const ask = async () =>
    (await answer(client.PUT("/api/scene/time", { body: { stage: await stage(), run, time, layers } }))) as Server["Shown"];
  const first = await ask();
  if (first.shown) return first.layers ?? null;
  await again();
  return (await ask()).layers ?? null;
}

interface Playing extends Pick<Scene, "begin" | "end" | "step"> {
  again: () => Promise<unknown>;
}

/** The playhead of the run that the scene plays back; none while it shows something else. */
export function usePlayhead(run: number | undefined, { begin, end, step, again }: Playing, sight: Sight): Playhead | undefined {
  const head = useMemo(
    () =>
      run === undefined || !isNumber(begin) || !isNumber(end) || !isNumber(step) || end <= begin
        ? undefined
        : new Playhead(run, begin, end, step, async (which, time, all) => {
            const seen = await showInScene(which, time, all, again);
            if (all) sight.put(seen);
          }),
    [run, begin, end, step, again, sight],
  );
  useEffect(() => {
    head?.refresh();
    return head?.leave;
  }, [head]);
  return head;
}

const isNumber = (value: number | null | undefined): value is number => typeof value === "number";

const still = () => () => undefined;

/** The time of a playhead, rounded to `grain` [s], so that not every picture is a rendering. */
export function useMoment(head: Playhead | undefined, grain = 0): number | undefined {
  const rounded = () => (head === undefined ? undefined : grain ? Math.round(head.time / grain) * grain : head.time);
  return useSyncExternalStore(head?.subscribe ?? still, rounded);
}

/** Whether it plays. */
export const usePlaying = (head: Playhead): boolean => useSyncExternalStore(head.subscribe, () => head.playing);

/** What it plays over and over. */
export const useLoop = (head: Playhead): Playhead["loop"] => useSyncExternalStore(head.subscribe, () => head.loop);

/** How fast it plays. */
export const usePace = (head: Playhead): number => useSyncExternalStore(head.subscribe, () => head.pace);
