import { describe, expect, it } from "vitest";
import { examples, isDone, type Seen, STEPS, toldOf } from "./tour";

const seen = (part: Partial<Seen>): Seen => ({ path: "/studio/x", runs: 0, before: 0, going: false, changed: 0, decided: 0, decidedBefore: 0, ...part });
const step = (title: string) => STEPS.find((each) => each.title === title) as (typeof STEPS)[number];

describe("a step of the tour is over", () => {
  it.each([
    ["Run it", { runs: 1 }, true],
    ["Run it", { runs: 3, before: 3 }, false],
    ["Change one thing", { changed: 1 }, true],
    ["Every run is here", { path: "/compare" }, true],
    ["Every run is here", { path: "/runs" }, false],
    ["Decide", { decided: 2, decidedBefore: 2 }, false],
    ["Decide", { decided: 3, decidedBefore: 2 }, true],
    ["Which one is better?", { path: "/compare" }, false],
  ] as [string, Partial<Seen>, boolean][])("%s with %o: %s", (title, part, expected) => {
    expect(isDone(step(title), seen(part))).toBe(expected);
  });
});

describe("who is to run again", () => {
  it("hears how the run before is over soon, while that goes on, and is shown the pace", () => {
    const again = step("Run it again");
    expect(toldOf(again, seen({ going: true }))).toMatchObject({ at: "[data-testid='pace']", text: expect.stringContaining("as fast as possible") });
    expect(toldOf(again, seen({}))).toBe(again);
    expect(toldOf(step("Run it"), seen({ going: true }))).toBe(step("Run it"));
  });
});

describe("the runs that are there to begin with", () => {
  it("differ in the headway, or in the seed", () => {
    expect(examples({ path: "a.headway", value: 0.6 }).map(({ set }) => set)).toEqual([{}, { "a.headway": 0.42 }, { "a.headway": 0.9 }]);
    expect(examples(undefined).map(({ seed }) => seed)).toEqual([1, 2, 3]);
  });
});
