"""Which quantity broke first: the tick in which a state stopped being finite, gone through again step by step.

Of one step, the quantities are looked at in the order in which it makes them: what the wheels feel, what drives and steers,
how the wheels turn and travel, what the body does.
"""

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from studio.vehicle import motion
from studio.vehicle.fleet import Fleet, integrate
from studio.vehicle.state import (
    A_X, A_Y, A_Z, ALPHA, CLUTCH, DELTA, DELTA_RATE, F_X, F_Y, F_Z, KAPPA, M_Z, OMEGA, OMEGA_E, PRESSURE_F, PRESSURE_R,
    ROTATION, T_ENGINE, TORQUE_BRAKE, TORQUE_DRIVE, TRAVEL, TRAVEL_RATE, VEHICLE, WHEEL,
)  # fmt: skip

FELT = (KAPPA, ALPHA, F_Z, F_Y, M_Z)
TURNED = (OMEGA, F_X, ROTATION, TRAVEL_RATE, TRAVEL)
DRIVES = (DELTA, DELTA_RATE, PRESSURE_F, PRESSURE_R, TORQUE_BRAKE, T_ENGINE, OMEGA_E, CLUTCH, TORQUE_DRIVE)
MOVED = (A_X, A_Y, A_Z, *range(len(VEHICLE)))


class Found(NamedTuple):
    """A quantity, and the time [s] after the start of the tick at which it was not finite."""

    quantity: str
    after: float


def columns(fleet: Fleet) -> np.ndarray:
    """Vehicles whose state is not finite."""
    wheels = np.isfinite(fleet.wheels).all(axis=0).reshape(4, -1).all(axis=0)
    return np.flatnonzero(~(np.isfinite(fleet.state).all(axis=0) & wheels))


def first(fleet: Fleet, state, wheels, column: int, *, k: int, tick: float, step: float) -> Found:
    """What broke first of a vehicle in tick k; state and wheels are those before it."""
    again = replace(fleet)
    for steps in range(motion.steps_of(tick, step) + 1):
        again.state, again.wheels = state.copy(), wheels.copy()
        integrate(again, k, tick, step, steps)
        name = not_finite(again.state, again.wheels, column)
        if name:
            return Found(name, steps * step)
    return Found(not_finite(fleet.state, fleet.wheels, column), tick)


def not_finite(state: np.ndarray, wheels: np.ndarray, column: int) -> str:
    """The first quantity that is not finite, or nothing."""
    by_corner = wheels.reshape(len(WHEEL), 4, -1)[:, :, column]
    candidates = [
        *((f"{WHEEL[row].name} of wheel {corner + 1}", by_corner[row, corner]) for row in FELT for corner in range(4)),
        *((VEHICLE[row].name, state[row, column]) for row in DRIVES),
        *((f"{WHEEL[row].name} of wheel {corner + 1}", by_corner[row, corner]) for row in TURNED for corner in range(4)),
        *((VEHICLE[row].name, state[row, column]) for row in MOVED),
    ]
    return next((name for name, value in candidates if not np.isfinite(value)), "")
