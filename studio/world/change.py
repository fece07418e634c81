"""Changes of the road while a world runs: which have begun, which are over, and what follows. One pass a tick.

The phase of every change is state. Everything else that a change does is a function of the phases, and is made anew when
one of them turns: that happens a few times in a run, so it need not be compiled.
"""

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from studio.compiled import compiled
from studio.road.detour import limited
from studio.road.path import PATH_SPEED, Path, project
from studio.scenario.schema import Limit
from studio.world import obstacle
from studio.world.setting import Setting
from studio.world.site import Site
from studio.world.state import *  # noqa: F403 - the names of the rows
from studio.world.world import Changes, World, Worlds

EARLY = 1e-9  # [s] a time that is a whole number of ticks must not come a tick late by rounding


@compiled
def has_come(i, time, moments, state, points, path_first, path_count, mind):
    """Whether a moment is there: its time, or its vehicle at its station."""
    if moments[BY, i] < 0.0:
        return time >= moments[WHEN, i] - EARLY
    v = int(moments[BY, i])
    s, _ = project(points, path_first[v], path_count[v], state[X, v], state[Y, v], mind[STATION, v])
    return state[ACTIVE, v] > 0.0 and s >= moments[AT, i]


@compiled
def proceed(time, moments, state, points, path_first, path_count, mind, phase, turned):
    """Changes begin and end; whether one did."""
    any_turned = False
    for c in range(phase.size):
        if phase[c] < OVER and has_come(phase[c] * phase.size + c, time, moments, state, points, path_first, path_count, mind):
            turned[phase[c], c] = time
            phase[c] += 1
            any_turned = True
    return any_turned


def turn(world: World) -> None:
    """The pass: lets changes begin and end."""
    c, v, r = world.changes, world.vehicles, world.roads
    if c.phase.size and proceed(
        world.clock.time, c.moments, v.state, r.points, r.path_first, r.path_count, v.mind, c.phase, c.turned
    ):
        post_limits(c, r.points)
        obstacle.put_up(world.obstacles.table, c.phase, world.obstacles.standing)


def post_limits(changes: Changes, points: np.ndarray) -> None:
    """The speeds of all paths under the limits that act."""
    columns, speed = changes.free
    points[PATH_SPEED, columns] = speed
    for number, columns, speed in changes.limits:
        if changes.phase[number] == ACTING:
            points[PATH_SPEED, columns] = np.minimum(points[PATH_SPEED, columns], speed)


# -- at the start --------------------------------------------------------------------------------------


class Laid(NamedTuple):
    """A path of a world, and where its points begin."""

    world: int
    path: Path
    first: int


def changes_of(settings: Sequence[Setting], worlds: Worlds, points: np.ndarray, paths: list[Laid]) -> Changes:
    """All changes of all worlds before they begin."""
    placed = [(w, site) for w, each in enumerate(settings) for site in each.sites]
    columns = {(w, name): worlds.first[w] + i for w, each in enumerate(settings) for i, name in enumerate(each.names)}
    occasions = [(w, site.begins) for w, site in placed] + [(w, site.ends) for w, site in placed]
    limits = [each for number, (w, site) in enumerate(placed) for each in limits_of(number, site, w, paths)]
    limited_at = np.unique(np.concatenate([np.zeros(0, np.int64), *(columns for _, columns, _ in limits)]))
    return Changes(
        moments=np.array([(each.time, columns.get((w, each.vehicle), -1), each.station) for w, each in occasions]).reshape(-1, 3).T.copy(),
        phase=np.zeros(len(placed), dtype=np.int64),
        turned=np.full((2, len(placed)), np.nan),
        limits=limits,
        free=(limited_at, points[PATH_SPEED, limited_at]),
    )


def limits_of(number: int, site: Site, world: int, paths: list[Laid]) -> Iterator[tuple[int, np.ndarray, np.ndarray]]:
    """What a limit means for every path of its world that it concerns: its number, columns of points, speed."""
    do = site.change.do
    if not isinstance(do, Limit):
        return
    for laid in paths:
        if laid.world == world:
            speed = limited(laid.path, site.line, do.start, do.end, do.speed)
            concerned = np.flatnonzero(np.isfinite(speed))
            if concerned.size:
                yield number, laid.first + concerned, speed[concerned]
