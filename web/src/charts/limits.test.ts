import { describe, expect, it } from "vitest";
import { limitsOf } from "./limits";

const STEP = 0.02; // [s]
const time = Array.from({ length: 3001 }, (_, i) => i * STEP);
const curve = (value: (t: number) => number | null) => time.map(value);

/** 10 m behind a car that comes to a stand at 40 s: the time gap grows as one over the speed, down to 0.5 m/s. */
const standing = (t: number) => {
  const speed = t < 36 ? 13 : 13 - 3.25 * (t - 36);
  return t > 45 ? 0.8 : speed < 0.5 ? null : (1 + 0.6 * speed) / speed;
};

describe("the limits of an axis", () => {
  it("are what the curves reach", () => {
    expect(limitsOf([time, curve((t) => Math.sin(t)), curve(() => 3)])).toEqual({ low: expect.closeTo(-1, 3), high: 3 });
    expect(limitsOf([[0, 1], [2, null]])).toEqual({ low: 2, high: 2 });
    expect(limitsOf([[0, 1], [null, null]])).toBeUndefined();
    expect(limitsOf([[]])).toBeUndefined();
  });

  it("leave out a time gap near standstill, and tell up to where it goes", () => {
    const limits = limitsOf([time, curve(standing)]);
    expect(limits?.high).toBeLessThan(1.5);
    expect(limits?.above).toBeGreaterThan(2.5);
    expect(limits?.below).toBeUndefined();
  });

  it("show the needle to whoever zooms into it", () => {
    const limits = limitsOf([time, curve(standing)], [39.5, 40]);
    expect(limits?.above).toBeUndefined();
    expect(limits?.high).toBeGreaterThan(2.5);
  });

  it("leave out one wrong sample on either side", () => {
    const noisy = curve((t) => (t === time[500] ? 900 : t === time[900] ? -700 : Math.sin(40 * t)));
    expect(limitsOf([time, noisy])).toMatchObject({ above: 900, below: -700, low: expect.closeTo(-1, 1), high: expect.closeTo(1, 1) });
  });

  it("tell of no needle that is hardly a pixel long: a car that stands and rocks by 3 mm/s", () => {
    const stop = curve((t) => (t < 10 ? 12 - 1.2 * t : t === time[510] ? -0.003 : 0));
    expect(limitsOf([time, stop])).toEqual({ low: -0.003, high: 12 });
  });

  it.each([0.3, 1, 5])("hold a brake of %s s as a whole", (lasts) => {
    const ramp = 0.1;
    const brake = (t: number) =>
      -6 * Math.max(0, Math.min((t - 20) / ramp, 1, (20 + lasts + 2 * ramp - t) / ramp)) + 0.05 * Math.sin(t);
    const limits = limitsOf([time, curve(brake)]);
    expect(limits?.low).toBeLessThan(-5.9);
    expect(limits?.below).toBeUndefined();
  });

  it("hold what is on for a moment only, and a car that is far from all others", () => {
    expect(limitsOf([time, curve((t) => (t > 10 && t < 10.1 ? 1 : 0))])).toEqual({ low: 0, high: 1 });
    expect(limitsOf([time, curve(() => 150), curve((t) => 8 + Math.sin(t))])).toMatchObject({ high: 150 });
  });

  it("leave out a needle of a second and a half in forty seconds, as a car has it that crawls up to others", () => {
    const crawling = (t: number) => (t > 39.5 ? null : t < 37 ? 0.8 : 0.8 + 0.05 * (Math.exp(2.4 * (t - 37)) - 1));
    const limits = limitsOf([time, curve(crawling)]);
    expect(limits?.high).toBeLessThan(8);
    expect(limits?.above).toBeGreaterThan(18);
  });

  it("weigh by time, and not by how many samples another run has", () => {
    const merged = curve((t) => (Math.round(t / STEP) % 2 ? undefined : standing(t)) as number | null);
    expect(limitsOf([time, merged])?.high).toBeLessThan(1.5);
  });
});
