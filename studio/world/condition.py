"""Conditions: what a kind of condition may look at, and the loop that asks it for everybody who waits for it.

A condition is asked at the beginning of a tick: places and speeds are those of now, what drivers have in mind, lights show and
applications have said is what it was at the tick before. A condition about others is asked after these, and sees how many of them hold.
"""

from collections.abc import Callable
from math import cos, sin
from typing import NamedTuple

import numpy as np

from studio.compiled import lean
from studio.kind.loop import written
from studio.kind.number import sizes, spelled, tuple_of
from studio.kind.registry import Kind
from studio.model import outline
from studio.road.ways.path import project
from studio.vehicle.parameter import LENGTH, WIDTH
from studio.vehicle.state import ACTIVE, PSI, V_X, X, Y
from studio.world.passes.collision import centre, overlap
from studio.world.table.mind import STATION
from studio.world.table.street import O_HEADING, O_LENGTH, O_SPEED, O_WIDTH, O_X, O_Y, OBJECT

ROUNDING = 1e-9  # [s] a time that is a whole number of ticks must not come a tick late by rounding


class View(NamedTuple):
    """All vehicles, of all worlds: the columns in a condition's settings are theirs. Rows stand in vehicle/ and world/table/."""

    time: float  # [s] since the start of the run
    tick: float  # [s]
    state: np.ndarray  # [VEHICLE, vehicle]
    parameter: np.ndarray  # [PARAMETER, vehicle]
    mind: np.ndarray  # [MIND, vehicle]
    points: np.ndarray  # [PATH, point] of all paths
    path_first: np.ndarray  # its first point, per vehicle
    path_count: np.ndarray  # of its points, per vehicle
    turned: np.ndarray  # [s] float64[2, entry]: when an entry of the script began and ended last, not a number before
    shown: np.ndarray  # what each light shows
    stop_first: np.ndarray  # the first stop line of its path, per vehicle
    stop_count: np.ndarray  # of them, per vehicle
    stop_station: np.ndarray  # [m] along the path
    stop_link: np.ndarray  # the light of each stop line
    table: np.ndarray  # [OBSTACLE, object] of all worlds
    standing: np.ndarray  # per object, 1 while it is there
    pool: np.ndarray  # [2, pair]: the lists of pairs that stand in settings
    mail: np.ndarray  # [MAIL, sender or link]: what was sent, received and lost since the tick before
    values: np.ndarray  # what is read of sensors, applications and vehicles for conditions that look at it


class Parts(NamedTuple):
    """What a condition knows of those that it is about."""

    time: float  # [s] since the start of the run
    true: int  # how many of them hold
    count: int  # how many there are
    since: float  # [s] when they began to hold all at once, and have done so without a break; infinite while they do not
    met: float  # [s] when they did so for the first time; infinite while they have not


@lean
def is_about(view, v):
    """Whether a vehicle has not arrived yet."""
    return view.state[ACTIVE, v] > 0.0


@lean
def station(view, v):
    """Station [m] of a vehicle's centre of gravity on its path."""
    s, _ = project(view.points, view.path_first[v], view.path_count[v], view.state[X, v], view.state[Y, v], view.mind[STATION, v])
    return s


class Body(NamedTuple):
    """A vehicle or a mover: the middle of its outline [m], its heading [rad], its size [m], its speed [m/s], and whether it is there."""

    x: float
    y: float
    heading: float
    length: float
    width: float
    speed: float
    is_there: bool


@lean
def body(view, b):
    """What a setting of the type BodyName stands for: the column of a vehicle, or OBJECT - i for object i of all worlds."""
    if b >= 0:
        x, y = centre(b, view.state, view.parameter)
        length, width = view.parameter[LENGTH, b], view.parameter[WIDTH, b]
        return Body(x, y, view.state[PSI, b], length, width, view.state[V_X, b], view.state[ACTIVE, b] > 0.0)
    i, t = OBJECT - b, view.table
    return Body(t[O_X, i], t[O_Y, i], t[O_HEADING, i], t[O_LENGTH, i], t[O_WIDTH, i], t[O_SPEED, i], view.standing[i] != 0)


@lean
def outline_gap(a, b, ahead):
    """Gap [m] between the outlines of two bodies when both have gone on for a time [s]; zero where they overlap."""
    dx = b.x - a.x + ahead * (b.speed * cos(b.heading) - a.speed * cos(a.heading))
    dy = b.y - a.y + ahead * (b.speed * sin(b.heading) - a.speed * sin(a.heading))
    if overlap(dx, dy, a.heading, a.length, a.width, b.heading, b.length, b.width):
        return 0.0
    return outline.gap(dx, dy, a.heading, a.length, a.width, b.heading, b.length, b.width)


@lean
def is_within(view, x, y, area):
    """Whether a place is in an area: in its circle, or within its corners, of which a ray to the east crosses the sides an odd number of
    times (M. Shimrat, Position of point relative to polygon, CACM 5, 1962)."""
    if area[4] == 0.0:
        return (x - area[0]) ** 2 + (y - area[1]) ** 2 <= area[2] ** 2
    first, count, inside = int(area[3]), int(area[4]), False
    for i in range(count):
        x_a, y_a = view.pool[0, first + i], view.pool[1, first + i]
        x_b, y_b = view.pool[0, first + (i + 1) % count], view.pool[1, first + (i + 1) % count]
        if (y_a > y) != (y_b > y) and x < x_a + (x_b - x_a) * (y - y_a) / (y_b - y_a):
            inside = not inside
    return inside


@lean
def is_asked(turn, phase, again):
    """Whether an entry in a phase waits for one of its turns; one that may begin again looks whether it might at once."""
    return phase == turn or (turn == 0 and phase == 2 and again != 0)


HEAD = '''"""Asks the condition {name} for all who wait for it."""

from math import inf

from studio.compiled import compiled
from studio.world.condition import {imports}
from {module} import SettingsTuple, {function}

NONE = inf  # of a time that has not come


@compiled
def run(view, node, entry, turn, settings, part_first, part_count, part, phase, again, since, met, held):
    for j in range(node.size):
        n, e = node[j], entry[j]
        if is_asked(turn[j], phase[e], again[e]):
'''
ALONE = """            held[n] = 1 if holds(view, SettingsTuple({settings})) else 0
"""
AROUND = """            true = 0
            for i in range(part_first[j], part_first[j] + part_count[j]):
                true += held[part[i]]
            since[n] = min(since[n], view.time) if true == part_count[j] else NONE
            met[n] = min(met[n], since[n])
            parts = Parts(view.time, true, part_count[j], since[n], met[n])
            held[n] = 1 if joins(SettingsTuple({settings}), parts) else 0
"""


def loop(kind: Kind) -> Callable:
    """The loop of a kind of condition: says in `held` whether each of those that are asked holds."""
    module = kind.module
    tuple_of(module, module.Settings)
    is_around = hasattr(module, "joins")
    settings = spelled(sizes(module.Settings), "settings")
    source = HEAD.format(
        name=kind.name,
        module=module.__name__,
        imports="Parts, is_asked" if is_around else "is_asked",
        function="joins" if is_around else "holds",
    ) + (AROUND if is_around else ALONE).format(settings=settings)
    return written(f"{kind.sort}_{kind.name}", source, kind).run
