"""Changes of the road while a world runs: which have begun, which are over, and what follows. One pass a tick.

State is the phase of every change, and which of its lines every vehicle has chosen. Limits, places on the lines, stop lines
and zones follow from these and are made anew when one turns: that happens a few times in a run, so it need not be compiled.
"""

from collections.abc import Iterator, Sequence

import numpy as np

from studio.compiled import lean
from studio.road.ways.detour import limited
from studio.road.ways.path import PATH_SPEED, project
from studio.scenario.schema import Limit
from studio.vehicle.parameter import FRONT, LENGTH
from studio.vehicle.state import ACTIVE, X, Y
from studio.world import obstacle
from studio.world.line import Lines, conflicts
from studio.world.setting import Setting
from studio.world.site import Site
from studio.world.table.mind import STATION
from studio.world.table.street import ACTING, AT, BY, OVER, PIECE_ACTS, PIECE_CHANGE, WHEN
from studio.world.world import Changes, World, Worlds

EARLY = 1e-9  # [s] a time that is a whole number of ticks must not come a tick late by rounding


@lean
def has_come(i, time, moments, state, points, path_first, path_count, mind):
    """Whether a moment is there: its time, or its vehicle at its station."""
    if moments[BY, i] < 0.0:
        return time >= moments[WHEN, i] - EARLY
    v = int(moments[BY, i])
    s, _ = project(points, path_first[v], path_count[v], state[X, v], state[Y, v], mind[STATION, v])
    return state[ACTIVE, v] > 0.0 and s >= moments[AT, i]


@lean
def proceed(time, moments, state, points, path_first, path_count, mind, phase, turned):
    """Changes begin and end; whether one did."""
    any_turned = False
    for c in range(phase.size):
        if phase[c] < OVER and has_come(phase[c] * phase.size + c, time, moments, state, points, path_first, path_count, mind):
            turned[phase[c], c] = time
            phase[c] += 1
            any_turned = True
    return any_turned


@lean
def is_within(v, enter, leave, state, parameter, mind):
    """Whether a part of a vehicle is between two stations of its line."""
    bumper = mind[STATION, v] + parameter[FRONT, v]
    return state[ACTIVE, v] > 0.0 and bumper > enter and bumper - parameter[LENGTH, v] < leave


@lean
def choose(phase, vehicle, work, base, span, state, parameter, mind, held, choice, chosen):
    """Everybody who is not within a work takes the line that it asks for now; counts those who are held by one; whether one went over."""
    held[:] = 0
    any_new = False
    for j in range(vehicle.size):
        chosen[j] = choice[j]
        for b in range(work.shape[0]):
            c = work[b, j]
            if c < 0:
                break
            if (choice[j] >> b & 1) == (phase[c] == ACTING):
                continue
            line = base[j] + choice[j]
            if is_within(vehicle[j], span[2 * b, line], span[2 * b + 1, line], state, parameter, mind):
                held[c] += 1
            else:
                chosen[j] ^= 1 << b
                any_new = True
    return any_new


def turn(world: World) -> None:
    """The pass: lets changes begin and end, and what follows from it."""
    c, d, o, v, r = world.changes, world.detours, world.obstacles, world.vehicles, world.roads
    if not c.phase.size:
        return
    if proceed(world.clock.time, c.moments, v.state, r.points, r.path_first, r.path_count, v.mind, c.phase, c.turned):
        post(world)
    chosen = d.choice.copy()
    if choose(c.phase, d.vehicle, d.work, d.base, d.span, v.state, v.parameter, v.mind, d.held, d.choice, chosen):
        go_over(world, chosen)
    obstacle.put_up(o.table, c.phase, d.held, o.standing)


def go_over(world: World, chosen: np.ndarray) -> None:
    """Vehicles take other lines: place on it, stop lines, objects in the way, and everybody's zones."""
    c, d, o, v, r = world.changes, world.detours, world.obstacles, world.vehicles, world.roads
    for j in np.flatnonzero(chosen != d.choice):
        column, old, new = d.vehicle[j], d.base[j] + d.choice[j], d.base[j] + chosen[j]
        v.mind[STATION, column] = carried(v.mind[STATION, column], d.span[:, old], d.span[:, new])
        for i in np.flatnonzero(c.moments[BY] == column):
            c.moments[AT, i] = carried(c.moments[AT, i], d.span[:, old], d.span[:, new])
        (
            r.path_first[column], r.path_count[column], r.stop_first[column], r.stop_count[column],
            o.sweep_first[column], o.sweep_count[column],
        ) = d.lines[:, new]  # fmt: skip
    d.choice[:] = chosen
    meet_anew(world)


def meet_anew(world: World) -> None:
    """Everybody's conflicts, on the lines that are taken now."""
    r = world.roads
    r.conflicts = conflicts(world.worlds, r.points, r.path_first, r.path_count, world.detours.known)


def follow(world: World) -> None:
    """Makes anew what follows from phases and choices, after both have been set from outside."""
    if world.changes.phase.size:
        post(world)
    if world.detours.vehicle.size:
        meet_anew(world)


def carried(station: float, old: np.ndarray, new: np.ndarray) -> float:
    """A station [m] of one line on another that differs within works; old and new are where they enter and leave these."""
    known = ~np.isnan(old)
    order = np.argsort(old[known])
    here, there = old[known][order], new[known][order]
    if station <= here[0]:
        return station
    return float(np.interp(station, here, there) + max(station - here[-1], 0.0))


def post(world: World) -> None:
    """What the changes that act mean for the roads: limits, and slippery pieces."""
    c, pieces = world.changes, world.roads.pieces
    post_limits(c, world.roads.points)
    pieces[PIECE_ACTS] = c.phase[pieces[PIECE_CHANGE].astype(np.int64)] == ACTING


def post_limits(changes: Changes, points: np.ndarray) -> None:
    """The speeds of all paths under the limits that act."""
    columns, speed = changes.free
    points[PATH_SPEED, columns] = speed
    for number, columns, speed in changes.limits:
        if changes.phase[number] == ACTING:
            points[PATH_SPEED, columns] = np.minimum(points[PATH_SPEED, columns], speed)


# -- at the start --------------------------------------------------------------------------------------


def changes_of(settings: Sequence[Setting], worlds: Worlds, lines: Lines) -> Changes:
    """All changes of all worlds before they begin."""
    placed = [(w, site) for w, each in enumerate(settings) for site in each.sites]
    columns = {(w, name): worlds.first[w] + i for w, each in enumerate(settings) for i, name in enumerate(each.names)}
    occasions = [(w, site.begins) for w, site in placed] + [(w, site.ends) for w, site in placed]
    limits = [each for number, (w, site) in enumerate(placed) for each in limits_of(number, site, w, lines)]
    limited_at = np.unique(np.concatenate([np.zeros(0, np.int64), *(columns for _, columns, _ in limits)]))
    return Changes(
        world=np.array([w for w, _ in placed], dtype=np.int64),
        moments=np.array([(each.time, columns.get((w, each.vehicle), -1), each.station) for w, each in occasions]).reshape(-1, 3).T.copy(),
        phase=np.zeros(len(placed), dtype=np.int64),
        turned=np.full((2, len(placed)), np.nan),
        limits=limits,
        free=(limited_at, lines.points[PATH_SPEED, limited_at]),
    )


def limits_of(number: int, site: Site, world: int, lines: Lines) -> Iterator[tuple[int, np.ndarray, np.ndarray]]:
    """What a limit means for every line of its world that it concerns: its number, columns of points, speed."""
    do = site.change.do
    if not isinstance(do, Limit):
        return
    for laid in lines.laid:
        if laid.world == world:
            speed = limited(laid.path, site.line, do.start, do.end, do.speed)
            concerned = np.flatnonzero(np.isfinite(speed))
            if concerned.size:
                yield number, laid.first + concerned, speed[concerned]
