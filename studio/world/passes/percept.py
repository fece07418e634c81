"""Percept: what a driver knows of whom he minds, and when his foot answers. Whom he minds has been found before, as it is.

    look away      by chance, so often and so long; meanwhile he knows what he knew, and steers on
    misjudge       gaps and speeds are wrong by errors that come and go
    foresee        what he decides will be done one reaction time later: he takes it to be as it will be then
    sway           the place in the lane that he wants comes and goes as well
    answer         his foot does what he decided one reaction time ago; what comes up sooner than that, and asks for hard braking, is a
                   surprise, of which he thinks as much longer as that takes

Chance goes by ticks and drivers. It is asked every `RENEWAL` for each driver; between two answers the sway goes straight.
M. Treiber, A. Kesting, D. Helbing, Physica A 360 (2006) 71: errors as Ornstein-Uhlenbeck processes, and foresight.
"""

from math import exp, inf

from studio.compiled import inlined, lean
from studio.model import driver
from studio.model.random import DRIVER_ATTENTION, DRIVER_ERROR, normals
from studio.vehicle.parameter import FRONT
from studio.vehicle.state import A_X, ACTIVE, V_X
from studio.world.table.mind import (
    AWAY,
    BRAKE_COMFORT,
    CLOSING_ERROR,
    DISTRACTION_LENGTH,
    DISTRACTION_RATE,
    EXPECTED,
    FIRST_GAP,
    FIRST_SPEED,
    FOLLOW_GAP,
    FOLLOW_SPEED,
    GAINED,
    GAP_ERROR,
    INTENT,
    LOOKS_UNTIL,
    MISJUDGED,
    PENDING,
    RED_STATION,
    SEEN_FIRST_GAP,
    SEEN_FIRST_SPEED,
    SEEN_GAP,
    SEEN_SPEED,
    SEEN_STOP,
    STARTLED,
    STATION,
    SURPRISED,
    SWAY,
    SWAY_FROM,
    SWAY_TIME,
    SWAY_TO,
    SWAYED,
    UNMET,
    WAY_STATION,
    WISH,
    WRONG_CLOSING,
    WRONG_GAP,
)  # fmt: skip

RENEWAL = 0.5  # [s] errors and sway are drawn anew
ERROR_TIME = 20.0  # [s] in which an error is forgotten
PLACES = 128  # of the ring of what has been decided
LONGEST = 2.5  # [s] a reaction time for which there is room in the ring
HARDEST, QUICKEST = -10.0, 5.0  # [m/s²] that pedals can ask for
FELT = 1.0  # [s] until a driver feels that the car does not do what his foot asks for
MOVING = 1.0  # [m/s] who is slower does not sway
MINUTE = 60.0  # [s]


def stride(tick):
    """For how many ticks a decision stands in the ring: as few as there is room for."""
    return int(LONGEST / ((PLACES - 2) * tick)) + 1


def renewal(tick):
    """Every how many ticks chance is asked."""
    return max(round(RENEWAL / tick), 1)


# -- seeing --------------------------------------------------------------------------------------------


@lean
def perceive(tick, every, state, parameter, world_of, entity, seed, drivers, mind, k, time):
    """What every driver takes that to be which he minds."""
    for v in range(state.shape[1]):
        if state[ACTIVE, v] == 0.0:
            continue
        if drivers[DISTRACTION_RATE, v] > 0.0 and time >= mind[LOOKS_UNTIL, v]:
            turn_away(v, k, time, seed[world_of[v]], entity[v], drivers, mind)
        if drivers[GAP_ERROR, v] + drivers[CLOSING_ERROR, v] + drivers[SWAY, v] > 0.0:
            err(v, k, every, every * tick, seed[world_of[v]], entity[v], state, drivers, mind)
        mind[GAINED, v] = mind[PENDING, v] + drivers[EXPECTED, v] * mind[UNMET, v]
        if mind[AWAY, v] == 0.0:
            notice(v, state, parameter, drivers, mind)


@inlined
def turn_away(v, k, time, seed, who, drivers, mind):
    """Looks away, or back again; at first he looks."""
    a, b, c, _ = normals(seed, who, DRIVER_ATTENTION, k)
    begins = mind[LOOKS_UNTIL, v] > 0.0 and mind[AWAY, v] == 0.0
    mind[AWAY, v] = 1.0 if begins else 0.0
    # the sum of two squared normal numbers is exponential, with a mean of two
    looks = 0.5 * (a * a + b * b) * MINUTE / drivers[DISTRACTION_RATE, v]
    mind[LOOKS_UNTIL, v] = time + (drivers[DISTRACTION_LENGTH, v] * exp(driver.GLANCE * c) if begins else looks)


@inlined
def err(v, k, every, span, seed, who, state, drivers, mind):
    """Errors and sway, drawn anew where it is this driver's turn."""
    turn = (k + who) % every
    if turn == 0 or k == 0:
        a, b, c, _ = normals(seed, who, DRIVER_ERROR, k)
        share = exp(-span / ERROR_TIME) if k > 0 else 0.0
        mind[WRONG_GAP, v] = driver.wandered(mind[WRONG_GAP, v], share, a)
        mind[WRONG_CLOSING, v] = driver.wandered(mind[WRONG_CLOSING, v], share, b)
        mind[MISJUDGED, v] = exp(drivers[GAP_ERROR, v] * mind[WRONG_GAP, v])
        mind[SWAY_FROM, v] = mind[SWAY_TO, v]
        if abs(state[V_X, v]) > MOVING and drivers[SWAY, v] > 0.0 and k > 0:
            share = exp(-span / drivers[SWAY_TIME, v])
            mind[SWAY_TO, v] = drivers[SWAY, v] * driver.wandered(mind[SWAY_TO, v] / drivers[SWAY, v], share, c)
    mind[SWAYED, v] = mind[SWAY_FROM, v] + (mind[SWAY_TO, v] - mind[SWAY_FROM, v]) * (turn / every)


@inlined
def notice(v, state, parameter, drivers, mind):
    """Looks: whom he follows, who goes first, and the line before which he stops."""
    speed, gained, t = state[V_X, v], mind[GAINED, v], drivers[EXPECTED, v]
    mind[SEEN_GAP, v], mind[SEEN_SPEED, v] = seen(v, mind[FOLLOW_GAP, v], mind[FOLLOW_SPEED, v], speed, gained, t, drivers, mind)
    mind[SEEN_FIRST_GAP, v], mind[SEEN_FIRST_SPEED, v] = seen(v, mind[FIRST_GAP, v], mind[FIRST_SPEED, v], speed, gained, t, drivers, mind)
    line = min(mind[RED_STATION, v], mind[WAY_STATION, v]) - mind[STATION, v] - parameter[FRONT, v]
    mind[SEEN_STOP, v] = driver.foreseen_gap(line, speed, gained, 0.0, t)


@inlined
def seen(v, gap, ahead, speed, gained, t, drivers, mind):
    """Gap [m] and speed [m/s] of what is ahead, estimated and foreseen."""
    if gap == inf:
        return gap, ahead
    estimated = ahead - gap * drivers[CLOSING_ERROR, v] * mind[WRONG_CLOSING, v]
    return driver.foreseen_gap(gap * mind[MISJUDGED, v], speed, gained, estimated, t), estimated


# -- answering -----------------------------------------------------------------------------------------


@lean
def answer(tick, hold, state, drivers, mind, intents, k, time):
    """The foot of every driver does what was decided one reaction time ago; who takes no part decides to keep his speed."""
    for v in range(state.shape[1]):
        if drivers[EXPECTED, v] + drivers[SURPRISED, v] == 0.0:
            continue
        late = int(drivers[EXPECTED, v] / tick + 0.5)
        done = intents[((k - late) // hold) % PLACES, v]
        wish = min(max(mind[WISH, v], HARDEST), QUICKEST) if state[ACTIVE, v] != 0.0 else 0.0
        mind[INTENT, v] = decided(v, time, wish, done, drivers, mind)
        if late == 0:
            mind[WISH, v] = mind[INTENT, v]
            continue
        if k % hold == 0:
            intents[(k // hold) % PLACES, v] = mind[INTENT, v]
            mind[PENDING, v] += hold * tick * mind[INTENT, v]
        mind[PENDING, v] -= tick * done
        mind[UNMET, v] += (state[A_X, v] - done - mind[UNMET, v]) * tick / FELT
        mind[WISH, v] = done


@inlined
def decided(v, time, wish, done, drivers, mind):
    """What he decides on [m/s²] who wants `wish` now, and does `done`: a surprise keeps him from it for a while."""
    if time < mind[STARTLED, v]:
        return mind[INTENT, v]
    is_new = mind[STARTLED, v] == 0.0 and mind[INTENT, v] >= -driver.STARTLING and done >= -drivers[BRAKE_COMFORT, v]
    longer = drivers[SURPRISED, v] - drivers[EXPECTED, v]
    mind[STARTLED, v] = 0.0
    if is_new and wish < -driver.STARTLING and longer > 0.0:
        mind[STARTLED, v] = time + longer
        return mind[INTENT, v]
    return wish
