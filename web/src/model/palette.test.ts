import { describe, expect, it } from "vitest";
import { carColors, contrast, paintsOf } from "./palette";

const rgb = (color: string) => [1, 3, 5].map((at) => Number.parseInt(color.slice(at, at + 2), 16));

describe("the colours of the lines", () => {
  it("are those of the cars where they can be seen", () => {
    const paints = { one: "#d55e00", two: "#0072b2" };
    expect(carColors(["one", "two"], paints, false)).toEqual(["#d55e00", "#0072b2"]);
  });

  it("have contrast on white and on black whatever the cars' paint", () => {
    const paints = { one: "#ffffff", two: "#000000", three: "#e69f00", four: "#102030" };
    for (const [dark, ground] of [
      [false, [255, 255, 255]],
      [true, [36, 36, 36]],
    ] as const) {
      for (const color of carColors(Object.keys(paints), paints, dark))
        expect(contrast(rgb(color), ground)).toBeGreaterThanOrEqual(3);
    }
  });

  it("stay apart when cars are painted alike or not at all", () => {
    const vehicles = ["a", "b", "c", "d", "e"];
    const paints = { a: "#0072b2", b: "#0072b2", c: "#0070b0" };
    expect(new Set(carColors(vehicles, paints, false)).size).toBe(5);
    expect(new Set(carColors(vehicles, {}, true)).size).toBe(5);
  });

  it("are found in a document", () => {
    expect(paintsOf({ vehicles: { a: { colour: "#0072b2" }, b: {} } })).toEqual({ a: "#0072b2" });
    expect(paintsOf(undefined)).toEqual({});
  });

  it("know black on white as the greatest contrast", () => {
    expect(contrast([0, 0, 0], [255, 255, 255])).toBeCloseTo(21);
  });
});
