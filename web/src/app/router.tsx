/** The addresses of the page; what is shown stands in them. */

import { createRootRoute, createRoute, createRouter, useNavigate } from "@tanstack/react-router";
import { ComparePage } from "../features/compare/ComparePage";
import { RunPage } from "../features/runs/RunPage";
import { RunsPage, type RunsView } from "../features/runs/RunsPage";
import { FirstScenario, NotFound } from "./places";
import { Shell } from "./Shell";

const number = (value: unknown): number | undefined =>
  Number.isInteger(Number(value)) && value !== "" && value !== null && value !== undefined
    ? Number(value)
    : undefined;
const text = (value: unknown): string | undefined =>
  typeof value === "string" || typeof value === "number" ? String(value) : undefined;

const root = createRootRoute({ component: Shell, notFoundComponent: NotFound });

const index = createRoute({ getParentRoute: () => root, path: "/", component: FirstScenario });

/** The shell draws the studio itself, because its scene outlives a change of place. */
export const studioRoute = createRoute({
  getParentRoute: () => root,
  path: "/studio/$scenario",
  validateSearch: (
    search: Record<string, unknown>,
  ): { run?: number | undefined; from?: number | undefined } => ({
    run: number(search.run),
    from: number(search.from),
  }),
  component: () => null,
});

const runsRoute = createRoute({
  getParentRoute: () => root,
  path: "/runs",
  validateSearch: ({ scenario, q, sort, varying }: Record<string, unknown>): RunsView => ({
    scenario: text(scenario),
    q: text(q),
    sort: text(sort),
    varying: varying === false ? false : undefined,
  }),
  component: function Runs() {
    const navigate = useNavigate();
    return (
      <RunsPage
        view={runsRoute.useSearch()}
        onView={(view) => navigate({ to: "/runs", search: view, replace: true })}
      />
    );
  },
});

const runRoute = createRoute({
  getParentRoute: () => root,
  path: "/runs/$run",
  component: function OneRun() {
    const run = number(runRoute.useParams().run);
    return run === undefined ? <NotFound /> : <RunPage key={run} run={run} />;
  },
});

const compareRoute = createRoute({
  getParentRoute: () => root,
  path: "/compare",
  validateSearch: ({
    a,
    b,
  }: Record<string, unknown>): { a?: number | undefined; b?: number | undefined } => ({
    a: number(a),
    b: number(b),
  }),
  component: function Compare() {
    const { a, b } = compareRoute.useSearch();
    const navigate = useNavigate();
    return (
      <ComparePage
        a={a}
        b={b}
        onChoose={(nextA, nextB) => navigate({ to: "/compare", search: { a: nextA, b: nextB } })}
      />
    );
  },
});

export const router = createRouter({
  routeTree: root.addChildren([index, studioRoute, runsRoute, runRoute, compareRoute]),
});

declare module "@tanstack/react-router" {
  interface Register {
    router: typeof router;
  }
}
