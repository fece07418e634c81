/** The guided tour through one loop: set up, run, look, tune, compare, decide. What somebody has done already needs no telling. */

export interface Step {
  title: string;
  text: string;
  /** What is pointed at, as CSS says it. */
  at?: string;
  /** Where it is. */
  place: "studio" | "runs" | "compare" | "scenarios";
  /** What has to be over before it can be done, while that goes on. */
  first?: { while: (seen: Seen) => boolean; at: string; text: string };
  /** What shows that it is done. */
  done?: (seen: Seen) => boolean;
}

/** What the page shows of how far somebody is. */
export interface Seen {
  path: string;
  /** Runs of this scenario, those of the tour too. */
  runs: number;
  /** Runs that there were when the step began. */
  before: number;
  /** Whether one of them goes on. */
  going: boolean;
  /** Parameters that differ from the file. */
  changed: number;
  /** Runs about which something was decided. */
  decided: number;
  decidedBefore: number;
}

export const STEPS: readonly Step[] = [
  {
    place: "studio",
    at: "iframe[title='3D scene']",
    title: "The scenario, as it will start",
    text: "Drag to turn the city, scroll to come nearer, click a car to follow it. Nothing moves until you say so.",
  },
  {
    place: "studio",
    at: "[data-testid='run']",
    title: "Run it",
    text: "Press Run, or r. The cars drive in the scene, the charts grow, and the run is kept for good.",
    done: ({ runs, before }) => runs > before,
  },
  {
    place: "studio",
    at: "[aria-label='Parameters']",
    title: "Change one thing",
    text: "Press /, look for headway, and give it another value. What differs from the file is marked, and can be reset.",
    done: ({ changed }) => changed > 0,
  },
  {
    place: "studio",
    at: "[data-testid='run']",
    title: "Run it again",
    text: "The new run is a child of the one before: it is kept what was changed on the way.",
    first: {
      while: ({ going }) => going,
      at: "[data-testid='pace']",
      text: "The run before still goes on, at the pace of real time. Choose here: as fast as possible, and it is over in seconds. Then press Run again.",
    },
    done: ({ runs, before }) => runs > before,
  },
  {
    place: "runs",
    at: "[data-testid='runs-table']",
    title: "Every run is here",
    text: "What was set and what came out. Tick two rows or more (x), then press Compare (Shift+X).",
    done: ({ path }) => path.startsWith("/compare"),
  },
  {
    place: "compare",
    at: "[data-testid='compare-metrics']",
    title: "Which one is better?",
    text: "Only what differs is shown. Every metric says of whom it is and when; a click on the time shows that moment in the scene.",
  },
  {
    place: "runs",
    at: "[data-testid='runs-table']",
    title: "Decide",
    text: "Go to the row of the better run and press c: a candidate, and why. With d it is discarded. Nothing that was decided is lost.",
    done: ({ decided, decidedBefore }) => decided > decidedBefore,
  },
  {
    place: "scenarios",
    at: "[data-testid='new-scenario']",
    title: "The next scenario is your own",
    text: "Make one from a template on a map, or duplicate this one. Everything else is a key away: ? lists them, Ctrl+K goes anywhere.",
  },
];

/** What is told now, and what is pointed at: of the step, or of what has to be over before. */
export const toldOf = (step: Step, seen: Seen): Pick<Step, "text" | "at"> => (step.first?.while(seen) ? step.first : step);

/** Whether a step is over by what somebody has done. */
export const isDone = (step: Step, seen: Seen): boolean => step.done?.(seen) ?? false;

/** What is made for somebody who has no runs yet: the scenario as it is, and twice with another headway where there is one, else with other seeds. */
export function examples(headway: { path: string; value: number } | undefined): { set: Record<string, number>; seed: number | null }[] {
  if (!headway) return [1, 2, 3].map((seed) => ({ set: {}, seed }));
  const others = [0.7, 1.5].map((factor) => Number((factor * headway.value).toPrecision(2)));
  return [{ set: {}, seed: null }, ...others.map((value) => ({ set: { [headway.path]: value }, seed: null }))];
}
