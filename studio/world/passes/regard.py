"""Regard: what a driver minds, as he finds it out. Who ahead permits least, who goes first and permits least, who is nearest."""

from math import cos, inf, nan, sin

from studio.compiled import inlined
from studio.model import driver
from studio.road.ways.path import project
from studio.vehicle.parameter import FRONT, LENGTH, WIDTH
from studio.vehicle.state import V_X, X, Y
from studio.world.passes.neighbour import REAR_X, REAR_Y
from studio.world.table.mind import (
    AHEAD,
    AHEAD_SPEED,
    BACK_FROM,
    BRAKE_COMFORT,
    CAREFUL,
    COMFORT,
    D_PSI,
    FIRST,
    FIRST_GAP,
    FIRST_SPEED,
    FOLLOW_GAP,
    FOLLOW_SPEED,
    FOLLOWING,
    GAP,
    HEADWAY,
    MINDED,
    OFFSET,
    OUT_BY,
    SIGHT,
    STANDSTILL,
    STOPPING,
    V_DESIRED,
    WAITED_FOR,
    YIELDING,
)  # fmt: skip

STANDING = 0.5  # [m/s] a car slower than this stands


@inlined
def forget(v, mind):
    """Nothing is ahead until somebody is seen."""
    mind[GAP, v] = nan
    mind[AHEAD, v] = mind[MINDED, v] = -1.0
    mind[AHEAD_SPEED, v] = 0.0
    mind[FOLLOWING, v] = mind[YIELDING, v] = driver.NO_LIMIT
    mind[FOLLOW_GAP, v] = mind[FIRST_GAP, v] = mind[CAREFUL, v] = inf
    mind[WAITED_FOR, v], mind[FIRST, v] = mind[FIRST, v], -1.0


@inlined
def behind(v, gap, speed, state, drivers, mind):
    """IDM acceleration [m/s²] of v, `gap` [m] behind something with a speed [m/s]."""
    own = state[V_X, v]
    return driver.following_acceleration(
        own, mind[V_DESIRED, v], gap, own - speed, drivers[STANDSTILL, v], drivers[HEADWAY, v], drivers[COMFORT, v],
        drivers[BRAKE_COMFORT, v],
    )  # fmt: skip


@inlined
def is_least(v, permitted, mind):
    """Whether nobody and nothing has permitted less so far."""
    return permitted < mind[FOLLOWING, v] and permitted < mind[YIELDING, v] and permitted < mind[STOPPING, v]


@inlined
def follow(v, who, gap, speed, state, drivers, mind):
    """Somebody of this number in the world is ahead: who permits least is minded."""
    permitted = behind(v, gap, speed, state, drivers, mind)
    if is_least(v, permitted, mind):
        mind[MINDED, v] = who
    if permitted < mind[FOLLOWING, v]:
        mind[FOLLOWING, v], mind[FOLLOW_GAP, v], mind[FOLLOW_SPEED, v] = permitted, gap, speed


@inlined
def let_in(v, who, gap, speed, state, drivers, mind):
    """Somebody goes first: who permits least is minded."""
    permitted = max(behind(v, gap, speed, state, drivers, mind), -driver.COURTESY)
    if is_least(v, permitted, mind):
        mind[MINDED, v] = who
    if permitted < mind[YIELDING, v]:
        mind[YIELDING, v], mind[FIRST, v], mind[FIRST_GAP, v], mind[FIRST_SPEED, v] = permitted, who, gap, speed


@inlined
def rear_offset(other, s_guess, places, points, first, count):
    """How far to the left of a path [m] the rear of a car is."""
    _, e = project(points, first, count, places[REAR_X, other], places[REAR_Y, other], s_guess)
    return e


@inlined
def is_in_the_way(v, other, e, parameter):
    """Whether the rear of the other car, so far left of v's path [m], overlaps the strip that v's body will sweep along it."""
    return abs(e) < 0.5 * (parameter[WIDTH, v] + parameter[WIDTH, other])


@inlined
def is_before(v, e, half, parameter, mind):
    """Whether v would meet what reaches from e - half to e + half [m] to the left of its path, going on as far beside it as it is:
    nobody is ahead of who is parked beside his path, or has swerved round somebody.

    A box of length L and width W that is turned by ψ reaches (L |sin ψ| + W |cos ψ|)/2 to either side of its middle.
    """
    turned = mind[D_PSI, v]
    own = 0.5 * (parameter[LENGTH, v] * abs(sin(turned)) + parameter[WIDTH, v] * abs(cos(turned)))
    return abs(e - mind[OFFSET, v]) < own + half


@inlined
def is_ahead(v, other, number, gap, speed, e, parameter, mind):
    """The other car, of this number in its world, whose rear is so far left of the path [m], is what the gap is measured to,
    if it is the nearest, or the first of the nearest, of those that v's body is before."""
    if not is_before(v, e, 0.5 * parameter[WIDTH, other], parameter, mind):
        return
    if not gap >= mind[GAP, v] or (gap == mind[GAP, v] and number < mind[AHEAD, v]):  # true too while the gap is not a number
        mind[GAP, v] = gap
        mind[AHEAD, v] = number
        mind[AHEAD_SPEED, v] = speed


@inlined
def is_unseen(v, other, state, parameter, drivers):
    """Whether the other car is farther from the own front bumper than one sees."""
    dx, dy = state[X, other] - state[X, v], state[Y, other] - state[Y, v]
    reach = drivers[SIGHT, v] + parameter[FRONT, v] + parameter[LENGTH, other] - parameter[FRONT, other]
    return dx * dx + dy * dy > reach * reach


@inlined
def is_passed(v, other, rear, state, parameter, mind):
    """Whether v passes another on the oncoming lane, whose rear is at a station [m]: he stands, and v comes back behind him only.

    Or the other way round: who passes one who stands is not ahead of him yet.
    """
    if mind[OUT_BY, other] != 0.0 and abs(state[V_X, v]) < STANDING:
        return True
    return mind[OUT_BY, v] != 0.0 and abs(state[V_X, other]) < STANDING and rear + parameter[LENGTH, other] <= mind[BACK_FROM, v]
