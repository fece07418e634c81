"""Intervention: when a driver overrules the application that has the pedals, and how.

Never, unless the scenario says so for the vehicle; then only for what it names, and only after it has been needed for the driver's
reaction time without a break. It is needed while the application asks for more than the driver would let happen:

    collision      avoiding what is ahead takes more than EMERGENCY
    red light      the next light asks for braking
    right of way   a car that goes first asks for braking

Once he acts he does so until the need is over, so that he does not let go and grasp in turn: until nobody is ahead or whoever is moves
away; the light is green or passed; nobody goes first any more, and whoever did is far enough ahead. Meanwhile the application may brake
harder, and no less, than he does.
"""

from math import inf, isnan

from studio.compiled import inlined, lean
from studio.model import driver
from studio.vehicle.parameter import FRONT
from studio.vehicle.state import V_X
from studio.world.table.mind import (
    ACTS_COLLISION,
    ACTS_RED,
    ACTS_WAY,
    AHEAD_SPEED,
    BRAKE_COMFORT,
    COMFORT,
    FOLLOWING,
    GAP,
    INTERVENING,
    MINDS_COLLISION,
    MINDS_RED,
    MINDS_WAY,
    NEEDED_COLLISION,
    NEEDED_RED,
    NEEDED_WAY,
    REACTION_TIME,
    RED_STATION,
    STATION,
    YIELDING,
)  # fmt: skip

EMERGENCY = 4.0  # [m/s²] what takes a harder deceleration than this is near
EMERGENCY_GAIN = 1.2  # [1] the driver brakes a little more than is needed
NEAREST = 1.0  # [m] that are to be left
MOVING_AWAY = 0.2  # [m/s] by as much as this whoever is ahead is faster
EARLY = 1e-9  # [s] a reaction time that is a whole number of ticks must not last one more by rounding


@inlined
def emergency(v, state, mind):
    """Acceleration [m/s²] with which a driver brakes when a collision is near; else nothing is asked.

    The deceleration that still avoids it is v²/(2 gap), v the closing speed [m/s]; the last of the gap is never driven into.
    """
    closing, gap = state[V_X, v] - mind[AHEAD_SPEED, v], mind[GAP, v] - NEAREST
    if isnan(gap) or closing < 0.0:
        return driver.NO_LIMIT
    needed = closing * closing / (2.0 * max(gap, 0.01))
    return -EMERGENCY_GAIN * max(needed, EMERGENCY) if needed > EMERGENCY or gap < 0.0 else driver.NO_LIMIT


@lean
def stopping(v, state, parameter, drivers, mind):
    """Acceleration [m/s²] that the next light permits."""
    distance = mind[RED_STATION, v] - mind[STATION, v] - parameter[FRONT, v]
    if distance == inf:
        return driver.NO_LIMIT
    return driver.stopping_acceleration(state[V_X, v], distance, drivers[COMFORT, v], drivers[BRAKE_COMFORT, v])


@inlined
def is_behind_nobody(v, state, mind):
    """Whether nobody is ahead, or whoever is moves away."""
    return isnan(mind[GAP, v]) or mind[AHEAD_SPEED, v] - state[V_X, v] > MOVING_AWAY


@inlined
def has_the_way(v, mind):
    """Whether nobody goes first, and nobody who did is still so near that he has to be braked for."""
    return mind[YIELDING, v] == driver.NO_LIMIT and mind[FOLLOWING, v] >= 0.0


@inlined
def needs_way(v, asked, mind):
    """Whether a car that goes first asks for braking, or one that did until it came in front just now: reacting to it goes on."""
    return mind[YIELDING, v] < asked or (mind[NEEDED_WAY, v] < inf and mind[FOLLOWING, v] < asked)


@inlined
def attend(v, minds, since, acts, is_needed, is_over, time, drivers, mind):
    """Whether the driver acts for one of the reasons, whose rows are given."""
    if drivers[minds, v] == 0.0:
        return False
    if mind[acts, v] > 0.0:
        goes_on = not is_over
        mind[since, v] = mind[since, v] if goes_on else inf
    else:
        mind[since, v] = min(mind[since, v], time) if is_needed else inf
        goes_on = time - mind[since, v] >= drivers[REACTION_TIME, v] - EARLY
    mind[acts, v] = 1.0 if goes_on else 0.0
    return goes_on


@lean
def attended(v, time, asked, state, parameter, drivers, mind):
    """Acceleration [m/s²] that a driver permits an application which asks for `asked` [m/s²]."""
    near, red, way = emergency(v, state, mind), stopping(v, state, parameter, drivers, mind), mind[YIELDING, v]
    permitted = driver.NO_LIMIT
    if attend(v, MINDS_COLLISION, NEEDED_COLLISION, ACTS_COLLISION, near < asked, is_behind_nobody(v, state, mind), time, drivers, mind):
        permitted = min(permitted, min(near, mind[FOLLOWING, v]))
    if attend(v, MINDS_RED, NEEDED_RED, ACTS_RED, red < min(asked, 0.0), red == driver.NO_LIMIT, time, drivers, mind):
        permitted = min(permitted, red)
    if attend(v, MINDS_WAY, NEEDED_WAY, ACTS_WAY, needs_way(v, min(asked, 0.0), mind), has_the_way(v, mind), time, drivers, mind):
        permitted = min(permitted, min(way, mind[FOLLOWING, v]))
    mind[INTERVENING, v] = 1.0 if permitted < driver.NO_LIMIT else 0.0
    return permitted


@inlined
def is_minding(v, drivers):
    """Whether a driver would overrule an application at all."""
    return drivers[MINDS_COLLISION, v] + drivers[MINDS_RED, v] + drivers[MINDS_WAY, v] > 0.0


@lean
def let_go(v, mind):
    """No application has the pedals: there is nothing to overrule."""
    mind[NEEDED_COLLISION, v] = mind[NEEDED_RED, v] = mind[NEEDED_WAY, v] = inf
    mind[ACTS_COLLISION, v] = mind[ACTS_RED, v] = mind[ACTS_WAY, v] = mind[INTERVENING, v] = 0.0
