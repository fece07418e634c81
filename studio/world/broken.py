"""Which quantity broke first: the step in which a state stopped being finite, looked at again, in the order of causes."""

import numpy as np

from studio.world.fleet import Fleet
from studio.world.state import *  # noqa: F403 - the names of the rows

# From cause to effect: what is commanded, what the wheels carry, what drives them, what the body does.
CAUSES = (*range(DELTA, J_GEAR + 1), TORQUE_BRAKE, TORQUE_DRIVE, A_X, A_Y, A_Z)
WHEEL_CAUSES = (TRAVEL, TRAVEL_RATE, KAPPA, ALPHA, F_Z, F_X, F_Y, M_Z, OMEGA, ROTATION)


def first(fleet: Fleet, state: np.ndarray, wheels: np.ndarray, column: int = 0) -> str:
    """Name and place of the first quantity of a vehicle that is not finite; state and wheels are those before the step."""
    n = fleet.size
    for name, value in earlier(state, wheels, column, n):
        if not np.isfinite(value):
            return name
    for row in WHEEL_CAUSES[:8]:
        for corner in range(4):
            if not np.isfinite(fleet.wheels[row, corner * n + column]):
                return f"{WHEEL[row].name} of wheel {corner + 1}"
    order = (*CAUSES, *range(len(VEHICLE)))
    return next(VEHICLE[row].name for row in order if not np.isfinite(fleet.state[row, column]))


def earlier(state: np.ndarray, wheels: np.ndarray, column: int, n: int):
    """Everything that was there before the step."""
    for row in range(len(VEHICLE)):
        yield VEHICLE[row].name, state[row, column]
    for row in range(len(WHEEL)):
        for corner in range(4):
            yield f"{WHEEL[row].name} of wheel {corner + 1}", wheels[row, corner * n + column]
