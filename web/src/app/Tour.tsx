/** A guided tour of ninety seconds through one loop. It is offered once, and comes back from the keyboard sheet or the palette. */

import { Button, CloseButton, Group, Paper, Progress, Text, Title } from "@mantine/core";
import { useLocalStorage } from "@mantine/hooks";
import { useMutation, useQuery, useQueryClient } from "@tanstack/react-query";
import { useLocation, useNavigate } from "@tanstack/react-router";
import { useEffect, useRef, useState } from "react";
import { answer, client } from "../api/client";
import { runs, scenario as scenarioQuery } from "../api/queries";
import { useDraft } from "../features/studio/draft";
import { isLive, type ListedRun, type Server, type Tree } from "../model/run";
import { isTree } from "../model/schema";
import { examples, isDone, type Seen, STEPS, toldOf } from "../model/tour";
import { lastScenario } from "../ui/memory";
import { notifyError } from "../ui/notify";
import classes from "./Tour.module.css";

/** How far somebody is: a step, "over", or nothing while it was not offered. */
type Far = number | "over" | null;

/** How far the tour is, and how to begin or end it. */
export function useTour() {
  const [far, setFar] = useLocalStorage<Far>({ key: "tour", defaultValue: null, getInitialValueInEffect: false });
  return { far, setFar, begin: () => setFar(0) };
}

export function Tour() {
  const { far, setFar } = useTour();
  const { data } = useQuery({ ...runs(), enabled: far !== "over" });
  const { pathname } = useLocation();
  if (!data || far === "over") return null;
  if (far !== null) return <Guide step={far} all={data} onStep={setFar} />;
  return data.length === 0 && pathname.startsWith("/studio") ? <Offer onBegin={() => setFar(0)} onEnd={() => setFar("over")} /> : null;
}

function Offer({ onBegin, onEnd }: { onBegin: () => void; onEnd: () => void }) {
  return (
    <Paper className={classes.card} withBorder shadow="lg" p="sm" role="dialog" aria-label="A tour is offered">
      <Title order={2} fz="sm">
        New here?
      </Title>
      <Text size="sm" my={6}>
        Ninety seconds through one loop: run, change one thing, compare, decide. Three runs of this scenario are made meanwhile, so that
        there is something to compare.
      </Text>
      <Group gap="xs">
        <Button size="xs" onClick={onBegin} data-testid="tour-begin">
          Begin the tour
        </Button>
        <Button size="xs" variant="subtle" onClick={onEnd}>
          Not now
        </Button>
      </Group>
    </Paper>
  );
}

interface GuideProps {
  step: number;
  all: readonly ListedRun[];
  onStep: (step: Far) => void;
}

function Guide({ step, all, onStep }: GuideProps) {
  const now = STEPS[step] ?? STEPS[0];
  const id = lastScenario() ?? "";
  const navigate = useNavigate();
  const making = useExamples(id, all.length === 0 && step === 0);
  const seen = useSeen(id, all, step);
  const told = now && toldOf(now, seen);
  const box = useBox(told?.at);
  const goTo = (next: number) => {
    const there = STEPS[next];
    if (!there) return onStep("over");
    onStep(next);
    if (there.place === "studio" && !seen.path.startsWith("/studio")) void navigate({ to: "/" });
    if (there.place === "runs" && seen.path !== "/runs") void navigate({ to: "/runs", search: {} });
    if (there.place === "scenarios" && seen.path !== "/scenarios") void navigate({ to: "/scenarios", search: {} });
    return undefined;
  };
  const done = now ? isDone(now, seen) : false;
  useEffect(() => {
    if (done) goTo(step + 1);
  }, [done]);
  if (!now) return null;
  return (
    <>
      {box ? <div className={classes.ring} style={{ left: box.x - 4, top: box.y - 4, width: box.width + 8, height: box.height + 8 }} /> : null}
      <Paper className={classes.card} data-place={now.place} withBorder shadow="lg" p="sm" role="dialog" aria-label="Tour">
        <Group justify="space-between" wrap="nowrap">
          <Title order={2} fz="sm" aria-live="polite">
            {now.title}
          </Title>
          <CloseButton size="sm" aria-label="End the tour" onClick={() => onStep("over")} />
        </Group>
        <Text size="sm" my={6}>
          {told?.text}
        </Text>
        <Progress size="xs" mb={8} value={(100 * (step + 1)) / STEPS.length} aria-label={`Step ${step + 1} of ${STEPS.length}`} />
        <Group gap="xs">
          <Button size="compact-xs" variant="default" disabled={step === 0} onClick={() => goTo(step - 1)}>
            Back
          </Button>
          <Button size="compact-xs" loading={making} onClick={() => goTo(step + 1)} data-testid="tour-next">
            {step + 1 < STEPS.length ? "Next" : "Done"}
          </Button>
          <Text size="xs" c="dimmed">
            {step + 1} of {STEPS.length}
          </Text>
        </Group>
      </Paper>
    </>
  );
}

/** What the page shows, and what it showed when the step began. */
function useSeen(id: string, all: readonly ListedRun[], step: number): Seen {
  const { pathname } = useLocation();
  const [draft] = useDraft(id);
  const now = { runs: all.filter(({ scenario }) => scenario === id).length, decided: all.filter(({ verdict }) => verdict !== "open").length };
  const begun = useRef({ step, ...now });
  if (begun.current.step !== step) begun.current = { step, ...now };
  return {
    path: pathname,
    ...now,
    going: all.some(({ scenario, status }) => scenario === id && isLive(status)),
    before: begun.current.runs,
    decidedBefore: begun.current.decided,
    changed: Object.keys(draft.changes).length,
  };
}

/** Three runs of the scenario, made once. */
function useExamples(id: string, wanted: boolean) {
  const { data } = useQuery({ ...scenarioQuery(id), enabled: wanted && id !== "" });
  const kept = useQueryClient();
  const asked = useRef(false);
  const make = useMutation({
    mutationFn: async (document: Tree) => {
      let parent: number | null = null;
      for (const { set, seed } of examples(headwayOf(document))) {
        const started: Server["Started"] = await answer(client.POST("/api/runs", { body: { scenario: id, set, seed, parent } }));
        parent ??= started.run;
      }
    },
    onSettled: () => Promise.all([["runs"], ["queue"]].map((queryKey) => kept.invalidateQueries({ queryKey }))),
    onError: notifyError,
  });
  useEffect(() => {
    if (!wanted || !data || asked.current) return;
    asked.current = true;
    make.mutate(data.document);
  }, [wanted, data]);
  return make.isPending;
}

/** The headway of the first application that has one. */
function headwayOf(document: Tree): { path: string; value: number } | undefined {
  const applications = isTree(document.applications) ? document.applications : {};
  for (const [name, application] of Object.entries(applications)) {
    const own = isTree(application) && isTree(application.parameters) ? application.parameters.headway : undefined;
    if (typeof own === "number") return { path: `applications.${name}.parameters.headway`, value: own };
  }
  return undefined;
}

/** [ms] Between two looks where something is. */
const LOOK_MS = 300;

/** Where the thing is that is pointed at, while it is seen. */
function useBox(selector: string | undefined): DOMRect | undefined {
  const [box, setBox] = useState<DOMRect>();
  useEffect(() => {
    const look = () => {
      const found = selector ? document.querySelector(selector)?.getBoundingClientRect() : undefined;
      setBox((before) => (found && before && same(found, before) ? before : found));
    };
    look();
    const timer = setInterval(look, LOOK_MS);
    return () => clearInterval(timer);
  }, [selector]);
  return box && box.width > 0 ? box : undefined;
}

const same = (one: DOMRect, other: DOMRect) =>
  one.x === other.x && one.y === other.y && one.width === other.width && one.height === other.height;
