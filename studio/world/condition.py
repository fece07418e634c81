"""Conditions: what a kind of condition may look at, and the loop that asks it for everybody who waits for it.

A condition is asked at the beginning of a tick: places and speeds are those of now, what drivers have in mind is what they saw at the
tick before.
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from studio.compiled import lean
from studio.kind.loop import written
from studio.kind.number import sizes, spelled, tuple_of
from studio.kind.registry import Kind
from studio.road.ways.path import project
from studio.vehicle.state import ACTIVE, X, Y
from studio.world.table.mind import STATION

ROUNDING = 1e-9  # [s] a time that is a whole number of ticks must not come a tick late by rounding


class View(NamedTuple):
    """All vehicles, of all worlds: the columns in a condition's settings are theirs. Rows stand in vehicle/ and world/table/."""

    time: float  # [s] since the start of the run
    state: np.ndarray  # [VEHICLE, vehicle]
    parameter: np.ndarray  # [PARAMETER, vehicle]
    mind: np.ndarray  # [MIND, vehicle]
    points: np.ndarray  # [PATH, point] of all paths
    path_first: np.ndarray  # its first point, per vehicle
    path_count: np.ndarray  # of its points, per vehicle
    turned: np.ndarray  # [s] float64[2, entry]: when an entry of the script began and ended, not a number before


@lean
def is_about(view, v):
    """Whether a vehicle has not arrived yet."""
    return view.state[ACTIVE, v] > 0.0


@lean
def station(view, v):
    """Station [m] of a vehicle's centre of gravity on its path."""
    s, _ = project(view.points, view.path_first[v], view.path_count[v], view.state[X, v], view.state[Y, v], view.mind[STATION, v])
    return s


LOOP = '''"""Asks the condition {name} for all who wait for it."""

from studio.compiled import compiled
from {module} import SettingsTuple, holds


@compiled
def run(view, entry, turn, settings, phase, come):
    for j in range(entry.size):
        if phase[entry[j]] == turn[j] and holds(view, SettingsTuple({settings})):
            come[entry[j]] = 1
'''


def loop(kind: Kind) -> Callable:
    """The loop of a kind of condition: marks in `come` the entries whose turn has come."""
    module = kind.module
    tuple_of(module, module.Settings)
    source = LOOP.format(name=kind.name, module=module.__name__, settings=spelled(sizes(module.Settings), "settings"))
    return written(f"{kind.sort}_{kind.name}", source, kind).run
