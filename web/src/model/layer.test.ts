import { expect, it } from "vitest";
import { LAYERS, toggled, USUAL, whyNot } from "./layer";

it("switches a layer on and off again, and keeps the order of the menu", () => {
  const on = toggled(USUAL, "gaps");
  expect(on).toEqual(["names", "gaps", "lamps", "notices"]);
  expect(toggled(on, "gaps")).toEqual(USUAL);
});

it("forgets a layer that there is no more", () => {
  expect(toggled(["wings", "names"], "gaps")).toEqual(["names", "gaps"]);
});

it("says why nothing of a layer is drawn", () => {
  expect(whyNot("names", false, {})).toBe("");
  expect(whyNot("gaps", false, {})).toContain("before a run");
  expect(whyNot("gaps", true, {})).toBe("");
  expect(whyNot("messages", true, { messages: "this run has no log of messages" })).toBe("this run has no log of messages");
  expect(new Set(LAYERS.map(({ name }) => name)).size).toBe(LAYERS.length);
});
