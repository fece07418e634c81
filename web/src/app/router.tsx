/** The addresses of the page; what is shown stands in them. */

import { createRootRoute, createRoute, createRouter, useNavigate } from "@tanstack/react-router";
import { lazy, Suspense } from "react";
import { ComparePage } from "../features/compare/ComparePage";
import { numbersOf } from "../model/beside";
import type { MapView } from "../features/maps/MapPage";
import type { ProjectView, Tab } from "../features/validation/ProjectPage";
import type { ScenariosView } from "../features/scenarios/ScenariosPage";
import { QueuePage } from "../features/runs/QueuePage";
import { RunPage } from "../features/runs/RunPage";
import { RunsPage, type RunsView } from "../features/runs/RunsPage";
import { Loading } from "../ui/State";
import { FirstScenario, NotFound } from "./places";
import { Shell } from "./Shell";

const number = (value: unknown): number | undefined =>
  Number.isInteger(Number(value)) && value !== "" && value !== null && value !== undefined
    ? Number(value)
    : undefined;
const real = (value: unknown): number | undefined => (typeof value === "number" && Number.isFinite(value) ? value : undefined);
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
  ): {
    run?: number | undefined;
    from?: number | undefined;
    time?: number | undefined;
    /** Other runs among its cars, with commas, and the kind of event that is at the same time in all of them. */
    ghosts?: string | undefined;
    align?: string | undefined;
    /** How the scene is looked at. */
    camera?: string | undefined;
  } => ({
    camera: text(search.camera),
    ghosts: text(search.ghosts),
    align: text(search.align),
    run: number(search.run),
    from: number(search.from),
    time: real(search.time),
  }),
  component: () => null,
});

const runsRoute = createRoute({
  getParentRoute: () => root,
  path: "/runs",
  validateSearch: ({ scenario, q, sort, by, varying, only, as, base, draw, axes, pins }: Record<string, unknown>): RunsView => ({
    pins: text(pins),
    scenario: text(scenario),
    q: text(q),
    sort: text(sort),
    by: text(by),
    varying: varying === false ? false : undefined,
    only: text(only),
    as: as === "space" || as === "lineage" || as === "board" ? as : undefined,
    base: number(base),
    draw: draw === "points" || draw === "ranks" ? draw : undefined,
    axes: text(axes),
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

const queueRoute = createRoute({ getParentRoute: () => root, path: "/queue", component: QueuePage });

const compareRoute = createRoute({
  getParentRoute: () => root,
  path: "/compare",
  // An address with `a` and `b` is one of two runs.
  validateSearch: ({ runs, a, b }: Record<string, unknown>): { runs?: string | undefined } => ({
    runs: text(runs) ?? (a === undefined && b === undefined ? undefined : numbersOf(`${a},${b}`).join(",")),
  }),
  component: function Compare() {
    const navigate = useNavigate();
    return (
      <ComparePage
        chosen={numbersOf(compareRoute.useSearch().runs)}
        onChoose={(chosen) => navigate({ to: "/compare", search: { runs: chosen.join(",") } })}
      />
    );
  },
});

// Scenario files, maps and kinds are loaded when somebody goes there: the studio starts sooner without them.
const MapsPage = lazy(async () => ({ default: (await import("../features/maps/MapsPage")).MapsPage }));
const MapPage = lazy(async () => ({ default: (await import("../features/maps/MapPage")).MapPage }));

const ScenariosPage = lazy(async () => ({
  default: (await import("../features/scenarios/ScenariosPage")).ScenariosPage,
}));
const TextPage = lazy(async () => ({ default: (await import("../features/scenarios/TextPage")).TextPage }));

const scenariosRoute = createRoute({
  getParentRoute: () => root,
  path: "/scenarios",
  validateSearch: ({ q, sort }: Record<string, unknown>): ScenariosView => ({ q: text(q), sort: text(sort) }),
  component: function Scenarios() {
    const navigate = useNavigate();
    return (
      <Suspense fallback={<Loading what="the scenarios" />}>
        <ScenariosPage
          view={scenariosRoute.useSearch()}
          onView={(view) => navigate({ to: "/scenarios", search: view, replace: true })}
        />
      </Suspense>
    );
  },
});

const textRoute = createRoute({
  getParentRoute: () => root,
  path: "/scenarios/$scenario/text",
  component: function Text() {
    const { scenario } = textRoute.useParams();
    return (
      <Suspense fallback={<Loading what="the text" />}>
        <TextPage key={scenario} id={scenario} />
      </Suspense>
    );
  },
});

const ValidationsPage = lazy(async () => ({
  default: (await import("../features/validation/ValidationsPage")).ValidationsPage,
}));
const ProjectPage = lazy(async () => ({ default: (await import("../features/validation/ProjectPage")).ProjectPage }));

const validateRoute = createRoute({
  getParentRoute: () => root,
  path: "/validate",
  component: () => (
    <Suspense fallback={<Loading what="the projects" />}>
      <ValidationsPage />
    </Suspense>
  ),
});

const TABS: readonly string[] = ["logs", "maneuvers", "calibration", "verdicts", "text"] satisfies Tab[];

const projectRoute = createRoute({
  getParentRoute: () => root,
  path: "/validate/$project",
  validateSearch: ({ tab, log, at }: Record<string, unknown>): ProjectView => ({
    tab: TABS.includes(String(tab)) ? (tab as Tab) : undefined,
    log: text(log),
    at: number(at),
  }),
  component: function OneProject() {
    const { project } = projectRoute.useParams();
    const navigate = useNavigate();
    return (
      <Suspense fallback={<Loading what="the project" />}>
        <ProjectPage
          key={project}
          name={project}
          view={projectRoute.useSearch()}
          onView={(view) => navigate({ to: "/validate/$project", params: { project }, search: view, replace: true })}
        />
      </Suspense>
    );
  },
});

const EditPage = lazy(async () => ({ default: (await import("../features/edit/EditPage")).EditPage }));

const editRoute = createRoute({
  getParentRoute: () => root,
  path: "/edit/$scenario",
  validateSearch: ({ at }: Record<string, unknown>): { at?: string | undefined } => ({ at: text(at) }),
  component: function Edit() {
    const { scenario } = editRoute.useParams();
    const navigate = useNavigate();
    return (
      <Suspense fallback={<Loading what="the editor" />}>
        <EditPage
          key={scenario}
          id={scenario}
          at={editRoute.useSearch().at}
          onAt={(at) => void navigate({ to: "/edit/$scenario", params: { scenario }, search: { at }, replace: true })}
        />
      </Suspense>
    );
  },
});

const KindsPage = lazy(async () => ({ default: (await import("../features/kinds/KindsPage")).KindsPage }));

const mapsRoute = createRoute({
  getParentRoute: () => root,
  path: "/maps",
  component: () => (
    <Suspense fallback={<Loading what="the maps" />}>
      <MapsPage />
    </Suspense>
  ),
});

const mapRoute = createRoute({
  getParentRoute: () => root,
  path: "/maps/$map",
  validateSearch: ({ at, road, hide, q, sort }: Record<string, unknown>): MapView => ({
    at: text(at),
    road: text(road),
    hide: text(hide),
    q: text(q),
    sort: text(sort),
  }),
  component: function OneMap() {
    const { map } = mapRoute.useParams();
    const navigate = useNavigate();
    const view = mapRoute.useSearch();
    return (
      <Suspense fallback={<Loading what="the map" />}>
        <MapPage
          key={map}
          id={map}
          view={view}
          onView={(next) => navigate({ to: "/maps/$map", params: { map }, search: next, replace: true })}
        />
      </Suspense>
    );
  },
});

const SourcePage = lazy(async () => ({ default: (await import("../features/kinds/SourcePage")).SourcePage }));

const sourceRoute = createRoute({
  getParentRoute: () => root,
  path: "/source/$name",
  validateSearch: ({ start }: Record<string, unknown>): { start?: string | undefined } => ({ start: text(start) }),
  component: function Source() {
    const { name } = sourceRoute.useParams();
    return (
      <Suspense fallback={<Loading what="the source" />}>
        <SourcePage key={name} name={name} start={sourceRoute.useSearch().start} />
      </Suspense>
    );
  },
});

const kindsRoute = createRoute({
  getParentRoute: () => root,
  path: "/kinds",
  component: () => (
    <Suspense fallback={<Loading what="the kinds" />}>
      <KindsPage />
    </Suspense>
  ),
});

export const router = createRouter({
  routeTree: root.addChildren([
    index,
    studioRoute,
    scenariosRoute,
    textRoute,
    editRoute,
    runsRoute,
    runRoute,
    queueRoute,
    compareRoute,
    mapsRoute,
    mapRoute,
    kindsRoute,
    sourceRoute,
    validateRoute,
    projectRoute,
  ]),
});

declare module "@tanstack/react-router" {
  interface Register {
    router: typeof router;
  }
}
