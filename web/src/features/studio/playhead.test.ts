import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import { Playhead } from "./playhead";
import { nextEvent } from "./Timeline";

const event = (time: number) => ({ time, text: "", vehicle: "", kind: "" }) as never;

describe("the playhead", () => {
  const shown: number[] = [];
  const looked: number[] = [];
  let answer: (() => void)[] = [];
  const head = () =>
    new Playhead(7, 0, 10, 0.02, (_run, time, all) => {
      shown.push(time);
      if (all) looked.push(time);
      return new Promise<void>((resolve) => answer.push(resolve));
    });
  beforeEach(() => {
    shown.length = 0;
    looked.length = 0;
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

  it("asks for what is drawn over the scene less often, and once more where it comes to stand", async () => {
    const at = new Playhead(7, 0, 10, 0.02, async (_run, time, all) => {
      shown.push(time);
      if (all) looked.push(time);
    });
    for (let i = 1; i <= 50; i++) {
      at.seek(0.1 * i);
      await vi.advanceTimersByTimeAsync(10);
    }
    await vi.advanceTimersByTimeAsync(200);
    expect(shown.length).toBeGreaterThan(50);
    expect(looked.length).toBeGreaterThanOrEqual(5);
    expect(looked.length).toBeLessThanOrEqual(7);
    expect(looked.at(-1)).toBe(5);
    const asked = shown.length;
    await vi.advanceTimersByTimeAsync(1000);
    expect(shown.length).toBe(asked);
  });

  it("asks for nothing more when nobody looks any more", async () => {
    const at = head();
    at.seek(3);
    at.leave();
    answer[0]?.();
    await vi.advanceTimersByTimeAsync(500);
    expect(shown).toEqual([3]);
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
    await vi.advanceTimersByTimeAsync(10);
    answer[1]?.(); // what is drawn over it
    await vi.advanceTimersByTimeAsync(10);
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
