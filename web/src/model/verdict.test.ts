import { describe, expect, it } from "vitest";
import { finished, metric } from "../test/scenario";
import type { RunDetail } from "./run";
import { hindrance, suggestion, tagsOf, takenBack, type Verdict } from "./verdict";

const given = (verdict: Verdict["verdict"], reason: string): Verdict => ({ verdict, reason, who: "Ada", when: "2026-01-01T00:00:00Z" });

describe("a verdict", () => {
  it("is about a run that is over", () => {
    expect(hindrance({ status: "running" }, "discarded")).toMatch("not over");
    expect(hindrance({ status: "failed" }, "candidate")).toMatch("failed");
    expect(hindrance({ status: "failed" }, "discarded")).toBe("");
    expect(hindrance({ status: "done" }, "candidate")).toBe("");
  });

  it("is taken back by one that stands behind it", () => {
    expect(takenBack([])).toBeUndefined();
    expect(takenBack([given("candidate", "good")])).toEqual({ verdict: "open", reason: "Taken back: candidate, good" });
    const two = [given("candidate", "good"), given("discarded", "bad")];
    expect(takenBack(two)).toEqual({ verdict: "candidate", reason: "Taken back: discarded, bad" });
  });

  it("is suggested by the goals, all of them", () => {
    const run = (goals: Record<string, object>, value: number | null): RunDetail =>
      ({ ...finished({ metrics: { gap: metric(value, "m") } }), document: { goals } }) as unknown as RunDetail;
    expect(suggestion(run({}, 3))).toBeUndefined();
    expect(suggestion(run({ gap: { least: 2 } }, 3))).toEqual({ word: "candidate", why: "The goal is met." });
    expect(suggestion(run({ gap: { least: 2, most: 2.5 } }, 3))?.word).toBe("discarded");
    expect(suggestion(run({ gap: { least: 2 } }, null))?.why).toMatch("1 of 1 goals not met: gap");
  });

  it("is not suggested for a run with a collision, which only a goal of its own may allow", () => {
    const run = (goals: Record<string, object>): RunDetail =>
      ({ status: "done", document: { goals }, metrics: { gap: { value: 3 }, collisions: { value: 1 } } }) as unknown as RunDetail;
    expect(suggestion(run({ gap: { least: 2 } }))).toEqual({ word: "discarded", why: "There was a collision, whatever the goals say." });
    expect(suggestion(run({ gap: { least: 2 }, collisions: { most: 1 } }))?.word).toBe("candidate");
  });
});

it("tags are words between commas, each once", () => {
  expect(tagsOf(" wet, night,,wet ")).toEqual(["wet", "night"]);
});
