"""Maneuvers: what an action may look at and command, while it lasts, of the vehicle that it is about; and the loop that asks it.

A scripted maneuver goes before application and driver. A vehicle has one at a time that takes its pedals, and one that takes its wheel,
which may be the same: one that begins ends those before it that have what it takes.
"""

from collections.abc import Callable
from math import isfinite
from types import ModuleType
from typing import Any, NamedTuple

from studio.compiled import compiled, inlined, lean
from studio.kind.loop import written
from studio.kind.number import sizes, spelled, tuple_of
from studio.kind.registry import Kind
from studio.vehicle.parameter import L_F, L_R
from studio.vehicle.state import A_X, ACTIVE, DELTA, PSI, V_X, X, Y
from studio.world.table.mind import (
    AHEAD_SPEED,
    D_PSI,
    DRIVES,
    GAP,
    OFFSET,
    PATH_KAPPA,
    SCRIPT_ACCELERATION,
    SCRIPT_STEERING,
    STATION,
    STEER_WISH,
    STEERS,
    WISH,
)  # fmt: skip

PEDALS, WHEEL = 1, 2  # what a maneuver may take of its vehicle: TAKES = PEDALS in the file of an action; both where it does not say


def takes(module: ModuleType) -> int:
    """What maneuvers of a kind take, together or one of them."""
    return getattr(module, "TAKES", PEDALS | WHEEL)


class Sees(NamedTuple):
    """What a maneuver knows of its vehicle at a tick."""

    elapsed: float  # [s] since it began
    speed: float  # [m/s]
    acceleration: float  # [m/s²] forward
    steering: float  # [rad] road wheel angle
    gap: float  # [m] to what is ahead; not a number when nothing is
    ahead_speed: float  # [m/s] of what is ahead
    station: float  # [m] along the own path
    offset: float  # [m] from the own path, left positive
    heading_error: float  # [rad] heading minus that of the path
    path_curvature: float  # [1/m]
    driver_acceleration: float  # [m/s²] that the driver would ask for
    driver_steering: float  # [rad] road wheel angle that the driver would ask for
    x: float  # [m] of its centre of gravity, east
    y: float  # [m] north
    heading: float  # [rad]
    wheelbase: float  # [m]
    pool: Any  # [2, pair]: the lists of pairs that stand in settings


class Maneuver(NamedTuple):
    """What it commands: pedals if it `drives`, the wheel if it `steers`; or that it is over."""

    acceleration: float  # [m/s²]
    steering: float  # [rad] road wheel angle
    drives: bool
    steers: bool
    is_over: bool


@inlined
def drive(acceleration):
    """The pedals are the maneuver's [m/s²]; the wheel stays with application or driver."""
    return Maneuver(acceleration, 0.0, True, False, False)


@inlined
def steer(angle):
    """The wheel is the maneuver's, as a road wheel angle [rad]; the pedals stay with application or driver."""
    return Maneuver(0.0, angle, False, True, False)


@inlined
def drive_and_steer(acceleration, angle):
    """Both are the maneuver's [m/s²], [rad]."""
    return Maneuver(acceleration, angle, True, True, False)


@inlined
def over():
    """The maneuver has ended, and commands nothing any more."""
    return Maneuver(0.0, 0.0, False, False, True)


@compiled  # not lean: it gives an array on
def seen(v, time, began, state, mind, parameter, pool):
    """What the maneuver of a vehicle sees, that began at a time [s]."""
    return Sees(
        time - began,
        state[V_X, v],
        state[A_X, v],
        state[DELTA, v],
        mind[GAP, v],
        mind[AHEAD_SPEED, v],
        mind[STATION, v],
        mind[OFFSET, v],
        mind[D_PSI, v],
        mind[PATH_KAPPA, v],
        mind[WISH, v],
        mind[STEER_WISH, v],
        state[X, v],
        state[Y, v],
        state[PSI, v],
        parameter[L_F, v] + parameter[L_R, v],
        pool,
    )


@inlined
def put(told, v, takes, script):
    """Writes what is commanded of a vehicle; what the maneuver does not take is left to another."""
    if takes & PEDALS != 0:
        script[DRIVES, v] = 1.0 if told.drives else 0.0
        script[SCRIPT_ACCELERATION, v] = told.acceleration
    if takes & WHEEL != 0:
        script[STEERS, v] = 1.0 if told.steers else 0.0
        script[SCRIPT_STEERING, v] = told.steering


@inlined
def is_fit(told):
    """Whether what is commanded are numbers."""
    return isfinite(told.acceleration) and isfinite(told.steering)


@lean
def has_left(v, state):
    """Whether a vehicle has arrived: its maneuver is over."""
    return state[ACTIVE, v] == 0.0


LOOP = '''"""Asks the action {name} for all vehicles that it is about."""

from studio.compiled import compiled
from studio.world.maneuver import has_left, is_fit, over, put, seen
from studio.world.table.street import ACTING
from {module} import SettingsTuple, act


@compiled
def run(time, entry, vehicle, settings, pool, phase, turned, state, mind, parameter, script, come, unfit):
    any_over = False
    for j in range(entry.size):
        e, v = entry[j], vehicle[j]
        if phase[e] != ACTING:
            continue
        if has_left(v, state):
            told = over()
        else:
            told = act(SettingsTuple({settings}), seen(v, time, turned[0, e], state, mind, parameter, pool))
        if not is_fit(told):
            unfit[e] = 1
            told = over()
        put(told, v, {takes}, script)
        if told.is_over:
            come[e] = 1
            any_over = True
    return any_over
'''


def loop(kind: Kind) -> Callable:
    """The loop of a kind of maneuver: commands its vehicles, and marks the entries that are over, and those that command no numbers."""
    module = kind.module
    tuple_of(module, module.Settings)
    source = LOOP.format(name=kind.name, module=module.__name__, settings=spelled(sizes(module.Settings), "settings"), takes=takes(module))
    return written(f"{kind.sort}_{kind.name}", source, kind).run
