import { describe, expect, it } from "vitest";
import { spanUnder } from "./touch";

const WIDTH = 400;

describe("fingers on a chart", () => {
  it("keep the times that they hold: two that go apart to twice as far show half as much", () => {
    // From 0 to 40 s, 10 px a second; held are 15 s and 25 s.
    const span = spanUnder([{ x: 100, time: 15 }, { x: 300, time: 25 }], WIDTH, 40, [0, 40]);
    expect(span).toEqual([10, 30]);
    const [begin = 0, end = 0] = span ?? [];
    const at = (x: number) => begin + (x / WIDTH) * (end - begin);
    expect([at(100), at(300)]).toEqual([15, 25]);
  });
  it("one of them moves what is zoomed, as far as there is something", () => {
    expect(spanUnder([{ x: 100, time: 20 }], WIDTH, 40, [10, 20])).toEqual([17.5, 27.5]);
    expect(spanUnder([{ x: 400, time: 2 }], WIDTH, 40, [10, 20])).toEqual([0, 10]);
    expect(spanUnder([{ x: 0, time: 39 }], WIDTH, 40, [10, 20])).toEqual([30, 40]);
  });
  it("drawn together show all of it, and no more", () => {
    expect(spanUnder([{ x: 190, time: 5 }, { x: 210, time: 35 }], WIDTH, 40, [0, 40])).toBeUndefined();
  });
  it("that lie on each other or have changed sides leave it as it is", () => {
    expect(spanUnder([{ x: 200, time: 5 }, { x: 205, time: 35 }], WIDTH, 40, [1, 9])).toEqual([1, 9]);
    expect(spanUnder([{ x: 300, time: 5 }, { x: 100, time: 35 }], WIDTH, 40, [1, 9])).toEqual([1, 9]);
  });
});
