import { describe, expect, it } from "vitest";
import { dragged, fitted, meet, SCALES, scaleBar, seen, toGround, toScreen, zoomed } from "./view";

const size = { width: 800, height: 600 };
const view = { x: 100, y: -50, scale: 2 };

describe("a view of the ground", () => {
  it("has north up and east to the right", () => {
    expect(toScreen(view, size, { x: 100, y: -50 })).toEqual({ x: 400, y: 300 });
    expect(toScreen(view, size, { x: 110, y: -40 })).toEqual({ x: 420, y: 280 });
  });

  it("leads back to the ground", () => {
    for (const point of [
      { x: 3, y: 7 },
      { x: -1200.5, y: 33.25 },
    ]) {
      const back = toGround(view, size, toScreen(view, size, point));
      expect(back.x).toBeCloseTo(point.x, 9);
      expect(back.y).toBeCloseTo(point.y, 9);
    }
  });

  it("goes with the pointer when it is dragged", () => {
    const point = { x: 90, y: -20 };
    const [before, after] = [toScreen(view, size, point), toScreen(dragged(view, 30, -12), size, point)];
    expect([after.x - before.x, after.y - before.y]).toEqual([30, -12]);
  });

  it("keeps what is under the pointer where it is when it is enlarged", () => {
    const at = { x: 700, y: 80 };
    const held = toGround(view, size, at);
    const larger = zoomed(view, size, 1.7, at);
    expect(larger.scale).toBeCloseTo(3.4, 9);
    expect(toScreen(larger, size, held).x).toBeCloseTo(at.x, 6);
    expect(toScreen(larger, size, held).y).toBeCloseTo(at.y, 6);
  });

  it("ends at the least and the most scale, and still holds the point", () => {
    const at = { x: 10, y: 10 };
    for (const [factor, scale] of [
      [1e9, SCALES.most],
      [1e-9, SCALES.least],
    ] as const) {
      const end = zoomed(view, size, factor, at);
      expect(end.scale).toBe(scale);
      expect(toScreen(end, size, toGround(view, size, at)).x).toBeCloseTo(at.x, 6);
    }
  });

  it("shows all of the bounds, and fills the screen in one direction", () => {
    const bounds = [-300, 20, 500, 220] as const;
    const all = fitted(bounds, size, 20);
    const [x0, y0, x1, y1] = seen(all, size, -20);
    expect(x0).toBeCloseTo(bounds[0], 6);
    expect(x1).toBeCloseTo(bounds[2], 6);
    expect(y0).toBeLessThan(bounds[1]);
    expect(y1).toBeGreaterThan(bounds[3]);
  });

  it("knows what it sees", () => {
    const part = seen(view, size);
    expect(part).toEqual([-100, -200, 300, 100]);
    expect(meet(part, [299, 99, 400, 400])).toBe(true);
    expect(meet(part, [301, 0, 400, 50])).toBe(false);
  });
});

describe("the scale bar", () => {
  it("is a round length that fits", () => {
    for (let scale = SCALES.least; scale < SCALES.most; scale *= 1.13) {
      const { metres, pixels } = scaleBar(scale, 120);
      expect(pixels).toBeCloseTo(metres * scale, 6);
      expect(pixels).toBeLessThanOrEqual(120);
      // The next round length, at most 2.5 times as long, would not fit.
      expect(pixels * 2.5).toBeGreaterThan(120 * 0.999);
      expect([1, 2, 5]).toContain(Number((metres / 10 ** Math.floor(Math.log10(metres) + 1e-9)).toFixed(6)));
    }
  });

  it("tells its unit", () => {
    expect(scaleBar(0.05).label).toBe("2 km");
    expect(scaleBar(1).label).toBe("100 m");
    expect(scaleBar(200, 120).label).toBe("50 cm");
  });
});
