"""Levels: who is so far above or below that he is on another road."""

from math import sqrt

from studio.compiled import inlined
from studio.vehicle.parameter import H
from studio.vehicle.state import X, Y, Z
from studio.world.table.street import O_HEIGHT, O_X, O_Y

OTHER_LEVEL = 3.0  # [m] of height between those who do not meet nor see each other when they are near: one drives on a bridge
STEEPNESS = 0.06  # [1] rise over distance that is seen beyond that: half of what a sensor opens upwards, or a steep street


@inlined
def is_thing_apart(v, i, state, parameter, table):
    """Whether object i is clearly above or below the road of vehicle v."""
    beyond = abs(state[Z, v] - parameter[H, v] - table[O_HEIGHT, i]) - OTHER_LEVEL
    if beyond <= 0.0:
        return False
    dx, dy = table[O_X, i] - state[X, v], table[O_Y, i] - state[Y, v]
    return beyond > STEEPNESS * sqrt(dx * dx + dy * dy)
