/** Verdicts on runs: which may be given, what the goals suggest, and how a given one is taken back. */

import { goalsOf } from "./goal";
import { isLive, type Run, type RunDetail, type Server } from "./run";

export type Word = Run["verdict"];
export type Verdict = Server["Verdict"];

export const WORDS: readonly Word[] = ["candidate", "discarded", "open"];

/** What is done to a run by each. */
export const ACTS: Record<Word, string> = { candidate: "Make it a candidate", discarded: "Discard it", open: "Leave it open" };

/** Why a verdict may not be given now; "" when it may. */
export function hindrance({ status }: Pick<Run, "status">, word: Word): string {
  if (isLive(status)) return "The run is not over yet.";
  return word === "candidate" && status !== "done" ? `The run did not come to its end: it is ${status}.` : "";
}

/** What the scenario's goals say, which a person decides about. */
export function suggestion(run: Pick<RunDetail, "status" | "document" | "metrics">): { word: Word; why: string } | undefined {
  const goals = goalsOf(run);
  if (run.status !== "done" || goals.length === 0) return undefined;
  const hits = run.metrics.collisions?.value ?? 0;
  if (hits > 0 && !goals.some(({ metric }) => metric === "collisions")) return { word: "discarded", why: `${hits === 1 ? "There was a collision" : `There were ${hits} collisions`}, whatever the goals say.` };
  const missed = goals.filter(({ margin }) => margin === null || margin < 0);
  const many = goals.length === 1 ? "The goal is" : `All ${goals.length} goals are`;
  if (missed.length === 0) return { word: "candidate", why: `${many} met.` };
  return { word: "discarded", why: `${missed.length} of ${goals.length} goals not met: ${missed.map(({ metric }) => metric).join(", ")}.` };
}

/** The verdict that brings back what counted before the last one; it stands behind it, as all do. */
export function takenBack(given: readonly Verdict[]): { verdict: Word; reason: string } | undefined {
  const last = given.at(-1);
  if (!last) return undefined;
  const before = given.at(-2)?.verdict ?? "open";
  return { verdict: before, reason: `Taken back: ${last.verdict}, ${last.reason}`.slice(0, LONGEST) };
}

/** Letters of a reason. */
export const LONGEST = 500;

/** Tags as somebody types them, separated by commas. */
export const tagsOf = (text: string): string[] => [...new Set(text.split(",").map((each) => each.trim()).filter(Boolean))];

/** The runs about which a verdict may be given now, and the others, with the reason why not. */
export function apart<Some extends Pick<Run, "run" | "status">>(runs: readonly Some[], word: Word): { able: Some[]; unable: { run: Some; why: string }[] } {
  const told = runs.map((run) => ({ run, why: hindrance(run, word) }));
  return { able: told.filter(({ why }) => !why).map(({ run }) => run), unable: told.filter(({ why }) => why) };
}
