"""Which quantity broke first: the tick in which a state stopped being finite, gone through again step by step.

Of one step, the quantities are looked at in the order in which it makes them: what the wheels feel, what drives and steers,
how the wheels turn and travel, what the body does.
"""

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from studio.vehicle import light, motion
from studio.vehicle.fleet import Fleet, integrate
from studio.vehicle.state import (
    A_X,
    A_Y,
    A_Z,
    ALPHA,
    CLUTCH,
    DELTA,
    DELTA_RATE,
    F_X,
    F_Y,
    F_Z,
    KAPPA,
    M_Z,
    OMEGA,
    OMEGA_E,
    PRESSURE_F,
    PRESSURE_R,
    ROTATION,
    T_ENGINE,
    TORQUE_BRAKE,
    TORQUE_DRIVE,
    TRAVEL,
    TRAVEL_RATE,
    VEHICLE,
    WHEEL,
)  # fmt: skip
from studio.vehicle.tile import GROUND_AT, LANES, ROWS, STATE_AT, WHEEL_AT, new_tile

FELT = (KAPPA, ALPHA, F_Z, F_Y, M_Z)
TURNED = (OMEGA, F_X, ROTATION, TRAVEL_RATE, TRAVEL)
DRIVES = (DELTA, DELTA_RATE, PRESSURE_F, PRESSURE_R, TORQUE_BRAKE, T_ENGINE, OMEGA_E, CLUTCH, TORQUE_DRIVE)
MOVED = (A_X, A_Y, A_Z, *range(len(VEHICLE)))


class Found(NamedTuple):
    """A quantity, and the time [s] after the start of the tick at which it was not finite."""

    quantity: str
    after: float


def columns(fleet: Fleet) -> np.ndarray:
    """Vehicles whose state would not be finite any more."""
    return np.flatnonzero(fleet.broken)


def first(fleet: Fleet, column: int, *, k: int, tick: float, step: float) -> Found:
    """What broke first of a vehicle in tick k, before which it still stands in the arrays."""
    if column in fleet.light:
        return first_of_light(fleet, column, k=k, tick=tick)
    for steps in range(motion.steps_of(tick, step) + 1):
        alone = replace(
            fleet, blocks=block_of(fleet, column), order=np.array([column]), state=fleet.state.copy(), wheels=fleet.wheels.copy(),
            broken=fleet.broken.copy(), tile=new_tile(),
        )  # fmt: skip
        integrate(alone, k, tick, step, steps)
        if alone.broken[column]:
            return Found(not_finite(alone.tile.reshape(ROWS, LANES)[:, 0]), steps * step)
    raise ValueError(f"vehicle {column} is not broken")


def first_of_light(fleet: Fleet, column: int, *, k: int, tick: float) -> Found:
    """The same of a light one, which has done the whole tick in a step."""
    j, f = int(np.searchsorted(fleet.light, column)), fleet
    made = light.attempt(j, f.light, f.state, f.ground, f.parameter, f.lightness, f.commands, k, tick)
    return Found(next(name for name, value in zip(made._fields, made, strict=True) if not np.isfinite(value)), tick)


def block_of(fleet: Fleet, column: int) -> np.ndarray:
    """A block of a vehicle alone, on its tyres."""
    place = int(np.flatnonzero(fleet.order == column)[0])
    number = np.searchsorted(fleet.blocks[0], place, side="right") - 1
    return np.array([0, 1, *fleet.blocks[2:, number]])[:, None]


def not_finite(rows: np.ndarray) -> str:
    """The first quantity of a lane of a tile that is not finite."""
    state, wheels = rows[STATE_AT:WHEEL_AT], rows[WHEEL_AT:GROUND_AT].reshape(len(WHEEL), 4)
    candidates = [
        *((f"{WHEEL[row].name} of wheel {corner + 1}", wheels[row, corner]) for row in FELT for corner in range(4)),
        *((VEHICLE[row].name, state[row]) for row in DRIVES),
        *((f"{WHEEL[row].name} of wheel {corner + 1}", wheels[row, corner]) for row in TURNED for corner in range(4)),
        *((VEHICLE[row].name, state[row]) for row in MOVED),
    ]
    return next(name for name, value in candidates if not np.isfinite(value))
