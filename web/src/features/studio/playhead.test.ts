import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import { Playhead } from "./playhead";
import { nextEvent } from "./Timeline";

const event = (time: number) => ({ time, text: "", vehicle: "", kind: "" }) as never;

describe("the playhead", () => {
  const shown: number[] = [];
  let answer: (() => void)[] = [];
  const head = () =>
    new Playhead(7, 0, 10, 0.02, (_run, time) => {
      shown.push(time);
      return new Promise<void>((resolve) => answer.push(resolve));
    });
  beforeEach(() => {
    shown.length = 0;
    answer = [];
    vi.useFakeTimers();
  });
  afterEach(() => vi.useRealTimers());

  it("stands at the end at first, and stays between begin and end", () => {
    const at = head();
    expect(at.time).toBe(10);
    at.seek(-3);
    expect(at.time).toBe(0);
    at.jump(99);
    expect(at.time).toBe(10);
  });

  it("steps from sample to sample, also from between them", () => {
    const at = head();
    at.seek(1.005);
    at.move(1);
    expect(at.time).toBeCloseTo(1.02, 9);
    at.move(-1);
    at.move(-1);
    expect(at.time).toBeCloseTo(0.98, 9);
    at.seek(4.193);
    at.move(1);
    expect(at.time).toBeCloseTo(4.2, 9);
    at.seek(4.193);
    at.move(-1);
    expect(at.time).toBeCloseTo(4.18, 9);
  });

  it("asks the scene for the newest time only, and for another when that is there", async () => {
    const at = head();
    for (const time of [1, 2, 3]) at.seek(time);
    expect(shown).toEqual([1]);
    answer[0]?.();
    await vi.advanceTimersByTimeAsync(0);
    expect(shown).toEqual([1, 3]);
  });

  it("plays at its pace, and from the beginning when it is at the end", () => {
    const at = head();
    at.choosePace(2);
    at.toggle();
    vi.advanceTimersByTime(1000);
    expect(at.playing).toBe(true);
    expect(at.time).toBeCloseTo(2, 1);
    at.toggle();
    vi.advanceTimersByTime(1000);
    expect(at.time).toBeCloseTo(2, 1);
    at.toggle();
    vi.advanceTimersByTime(5000);
    expect([at.time, at.playing]).toEqual([10, false]);
  });

  it("plays a stretch over and over, from its beginning", () => {
    const at = head();
    at.repeat([3, 4]);
    at.toggle();
    const seen = new Set<number>();
    for (let i = 0; i < 300; i++) {
      vi.advanceTimersByTime(20);
      seen.add(Math.floor(at.time * 10));
    }
    expect(at.playing).toBe(true);
    expect(Math.min(...seen)).toBe(30);
    expect(Math.max(...seen)).toBeLessThanOrEqual(40);
    at.repeat(undefined);
    vi.advanceTimersByTime(20000);
    expect([at.time, at.playing]).toEqual([10, false]);
  });

  it("goes on without a limit as soon as the scene has shown what it was asked for, and no sooner", async () => {
    const at = head();
    at.choosePace(Number.POSITIVE_INFINITY);
    at.toggle();
    vi.advanceTimersByTime(500);
    expect(at.time).toBe(0); // the scene has not answered
    answer[0]?.();
    await vi.advanceTimersByTimeAsync(20);
    expect(at.time).toBe(0.25);
  });

  it("keeps a stretch within the run", () => {
    const at = head();
    at.repeat([-5, 99]);
    expect(at.loop).toEqual([0, 10]);
  });

  it("takes no stretch in which nothing was recorded", () => {
    const at = head();
    at.repeat([3, 4]);
    at.repeat([20, 40]); // what charts may show of a run that was stopped
    at.repeat([10, 10]);
    expect(at.loop).toEqual([3, 4]);
    expect([at.holds([9, 12]), at.holds([10, 10])]).toEqual([true, false]);
  });

  it("finds the event before and after", () => {
    const events = [event(1), event(1), event(4)];
    expect(nextEvent(events, 1, 1)).toBe(4);
    expect(nextEvent(events, 4, -1)).toBe(1);
    expect(nextEvent(events, 4, 1)).toBeUndefined();
  });
});
