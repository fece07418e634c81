import { expect, test } from "vitest";
import { boundOf, common } from "./aggregate";

const channels = (...names: string[]) => ({ channels: names.map((name) => ({ name, unit: "m/s", label: name })) });

test("channels are those that every run has", () => {
  const found = common([channels("a.speed", "b.speed", "c.gap"), channels("c.gap", "a.speed")]);
  expect(found.map(({ name }) => name)).toEqual(["a.speed", "c.gap"]);
  expect(common([])).toEqual([]);
  expect(common([channels("a.speed")])).toHaveLength(1);
});

test("a time that is typed may be missing, have a comma, or be none", () => {
  expect([" ", "12,5", "-3", "1e1"].map(boundOf)).toEqual([undefined, 12.5, -3, 10]);
  expect(["12 s", "Infinity", "1.2.3"].map(boundOf)).toEqual([null, null, null]);
});
