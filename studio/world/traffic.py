"""Traffic: what the drivers of this tick see of road, lights and each other, and what they want. Six passes.

Two paths that run within a lane's width of each other share a zone: a stretch of one belongs to a stretch of the other.
Following on one lane, merging and crossing are then one and the same: a car that is in the zone, or will be there
first, drives ahead at the distance that the stretches give.
"""

from math import cos, inf, nan, sin

from studio.compiled import compiled
from studio.model import driver
from studio.road.network.signals import GREEN, signal_state
from studio.road.ways.path import (
    PATH_CURVATURE,
    PATH_HEADING,
    PATH_SPACING,
    PATH_SPEED,
    PATH_X,
    PATH_Y,
    interpolate,
    project,
)
from studio.world.ground import touch_all
from studio.world.shift import start
from studio.world.state import *  # noqa: F403 - the names of the rows

PREVIEW = 0.25  # [s] a driver steers for where the car will be once the steering has followed
SPEED_PREVIEW = 1.0  # [s] and slows down for what comes, but speeds up only where it is allowed
HORIZON = 60.0  # [m] how far before a merge drivers mind each other
COURTESY = 3.0  # [m/s²] strongest braking for a car that only will be first
STANDING = 0.5  # [m/s] a car slower than this, still outside, is not waited for
ELBOW_ROOM = 0.2  # [m] that a driver leaves beside the body to what stands there
ARRIVAL = 6.0  # [m] before the end of its path a car has arrived
ENTRY_CLEARANCE = 30.0  # [m] that must be free around the start of a path for a car to come in


@compiled
def lights(t, signal_time, signal_first, signal_count, phase_end, phase_state, shown):
    """First pass: what every signal shows."""
    for link in range(shown.size):
        shown[link] = signal_state(
            t, signal_time[0, link], signal_time[1, link], signal_first[link], signal_count[link], phase_end, phase_state
        )


@compiled
def locate(v, state, parameter, points, first, count, mind):
    """Where the car is on its path, and how its front axle stands to it."""
    psi, l_f = state[PSI, v], parameter[L_F, v]
    s, e = project(points, first, count, state[X, v], state[Y, v], mind[STATION, v])
    x_f, y_f = state[X, v] + l_f * cos(psi), state[Y, v] + l_f * sin(psi)
    s_f, e_f = project(points, first, count, x_f, y_f, s + l_f)
    mind[STATION, v] = s
    mind[OFFSET, v] = e
    mind[FRONT_OFFSET, v] = e_f
    ahead = s_f + PREVIEW * state[V_X, v]
    mind[PATH_KAPPA, v] = interpolate(points, first, PATH_CURVATURE, clip(ahead, count))
    mind[D_PSI, v] = psi - interpolate(points, first, PATH_HEADING, clip(s_f, count))


@compiled
def clip(s, count):
    """A station that lies on the path."""
    return min(max(s, 0.0), (count - 1.001) * PATH_SPACING)


@compiled
def next_red(v, state, parameter, mind, stop_first, stop_count, stop_station, stop_link, shown, sight):
    """Station [m] of the next stop line in sight ahead of the bumper that shows no green and at which the driver will stop."""
    bumper = mind[STATION, v] + parameter[FRONT, v]
    for i in range(stop_first, stop_first + stop_count):
        distance = stop_station[i] - bumper
        if 0.0 < distance <= sight and shown[stop_link[i]] != GREEN and driver.must_stop(state[V_X, v], distance):
            return stop_station[i]
    return inf


@compiled
def orient(state, parameter, points, path_first, path_count, stop_first, stop_count, stop_station, stop_link, shown,
           drivers, mind):  # fmt: skip
    """Second pass: own place on the path, permitted speed, next red light; forgets what was ahead."""
    for v in range(state.shape[1]):
        if state[ACTIVE, v] == 0.0:
            continue
        locate(v, state, parameter, points, path_first[v], path_count[v], mind)
        if mind[STATION, v] > (path_count[v] - 1) * PATH_SPACING - ARRIVAL:
            state[ACTIVE, v] = 0.0
        permitted = drivers[SPEED_FACTOR, v] * permitted_speed(v, state, points, path_first[v], path_count[v], mind)
        mind[V_DESIRED, v] = min(permitted, drivers[SIGHT_SPEED, v])
        mind[RED_STATION, v] = next_red(
            v, state, parameter, mind, stop_first[v], stop_count[v], stop_station, stop_link, shown, drivers[SIGHT, v]
        )
        forget(v, mind)


@compiled
def permitted_speed(v, state, points, first, count, mind):
    """Speed [m/s] that is allowed here and a little ahead."""
    here = mind[STATION, v]
    ahead = here + SPEED_PREVIEW * state[V_X, v]
    return min(
        interpolate(points, first, PATH_SPEED, clip(here, count)), interpolate(points, first, PATH_SPEED, clip(ahead, count))
    )


@compiled
def forget(v, mind):
    """Nothing is ahead until a zone says so."""
    mind[GAP, v] = nan
    mind[AHEAD, v] = -1.0
    mind[AHEAD_SPEED, v] = 0.0
    mind[FOLLOWING, v] = driver.NO_LIMIT
    mind[YIELDING, v] = driver.NO_LIMIT


@compiled
def behind(v, other, gap, state, drivers, mind):
    """IDM acceleration [m/s²] of v behind the other car."""
    closing = state[V_X, v] - state[V_X, other]
    return driver.following_acceleration(
        state[V_X, v], mind[V_DESIRED, v], gap, closing, drivers[STANDSTILL, v], drivers[HEADWAY, v],
        drivers[COMFORT, v], drivers[BRAKE_COMFORT, v],
    )  # fmt: skip


@compiled
def is_in_the_way(v, other, s_guess, state, parameter, points, first, count):
    """Whether the rear of the other car overlaps the strip that v's body will sweep along its path."""
    psi, back = state[PSI, other], parameter[LENGTH, other] - parameter[FRONT, other]
    x, y = state[X, other] - back * cos(psi), state[Y, other] - back * sin(psi)
    _, e = project(points, first, count, x, y, s_guess)
    return abs(e) < 0.5 * (parameter[WIDTH, v] + parameter[WIDTH, other])


@compiled
def is_ahead(v, other, gap, state, mind):
    """The other car is what the gap is measured to, if it is the nearest."""
    if not gap >= mind[GAP, v]:  # also true while the gap is not a number
        mind[GAP, v] = gap
        mind[AHEAD, v] = other
        mind[AHEAD_SPEED, v] = state[V_X, other]


@compiled
def goes_first(v, other, d_v, d_other, zone_start, state, mind):
    """Whether the other car, also before the zone, will be there before v: nearer, and neither waiting nor held."""
    held = mind[RED_STATION, other] <= zone_start
    nearer = d_other < d_v or (d_other == d_v and other < v)
    return nearer and not held and d_other < HORIZON and state[V_X, other] > STANDING


@compiled
def is_unseen(v, other, state, parameter, drivers):
    """Whether the other car is farther from the own front bumper than one sees."""
    dx, dy = state[X, other] - state[X, v], state[Y, other] - state[Y, v]
    reach = drivers[SIGHT, v] + parameter[FRONT, v] + parameter[LENGTH, other] - parameter[FRONT, other]
    return dx * dx + dy * dy > reach * reach


@compiled
def meet(v, other, v_enter, v_leave, other_enter, other_leave, state, parameter, points, first, count, drivers, mind):
    """What one zone means for v: a car that is in it, in front, is followed; one that will be there first is let in."""
    bumper = mind[STATION, v] + parameter[FRONT, v]
    bumper_other = mind[STATION, other] + parameter[FRONT, other]
    rear_other = bumper_other - parameter[LENGTH, other]
    if bumper - parameter[LENGTH, v] > v_leave or rear_other > other_leave or v_enter - bumper > HORIZON:
        return
    if is_unseen(v, other, state, parameter, drivers):
        return
    gap = (rear_other - other_enter) - (bumper - v_enter)
    in_front = mind[STATION, other] - other_enter > mind[STATION, v] - v_enter
    if bumper_other >= other_enter:
        if in_front:
            mind[FOLLOWING, v] = min(mind[FOLLOWING, v], behind(v, other, gap, state, drivers, mind))
            rear = bumper + gap
            if gap > 0.0 and is_in_the_way(v, other, rear, state, parameter, points, first, count):
                is_ahead(v, other, gap, state, mind)
    elif bumper < v_enter:
        if goes_first(v, other, v_enter - bumper, other_enter - bumper_other, other_enter, state, mind):
            wish = max(behind(v, other, gap, state, drivers, mind), -COURTESY)
            mind[YIELDING, v] = min(mind[YIELDING, v], wish)


@compiled
def meetings(state, parameter, points, path_first, path_count, zone_pair, zone_span, drivers, mind):
    """Third pass: every zone, for the first car of its pair."""
    for z in range(zone_pair.shape[1]):
        v, other = zone_pair[0, z], zone_pair[1, z]
        if state[ACTIVE, v] > 0.0 and state[ACTIVE, other] > 0.0:
            meet(
                v, other, zone_span[0, z], zone_span[1, z], zone_span[2, z], zone_span[3, z],
                state, parameter, points, path_first[v], path_count[v], drivers, mind,
            )  # fmt: skip


@compiled
def obstacles(state, parameter, sweep, sweep_first, sweep_count, standing, drivers, mind):
    """Fourth pass: the first object in sight that stands in the strip which the own body will sweep."""
    for v in range(state.shape[1]):
        if state[ACTIVE, v] == 0.0:
            continue
        bumper, reach = mind[STATION, v] + parameter[FRONT, v], 0.5 * parameter[WIDTH, v] + ELBOW_ROOM
        for i in range(sweep_first[v], sweep_first[v] + sweep_count[v]):
            gap, number = sweep[SWEPT_AT, i] - bumper, int(sweep[SWEPT_OBJECT, i])
            if gap >= 0.0 and standing[number] == 1 and sweep[SWEPT_ASIDE, i] < reach:
                if gap <= drivers[SIGHT, v]:
                    stand_before(v, number, gap, state, drivers, mind)
                break


@compiled
def stand_before(v, number, gap, state, drivers, mind):
    """Object `number` is followed as a car that stands."""
    wish = driver.following_acceleration(
        state[V_X, v], mind[V_DESIRED, v], gap, state[V_X, v], drivers[STANDSTILL, v], drivers[HEADWAY, v],
        drivers[COMFORT, v], drivers[BRAKE_COMFORT, v],
    )  # fmt: skip
    mind[FOLLOWING, v] = min(mind[FOLLOWING, v], wish)
    if not gap >= mind[GAP, v]:
        mind[GAP, v], mind[AHEAD, v], mind[AHEAD_SPEED, v] = gap, OBJECT - number, 0.0


@compiled
def stop_wish(v, state, parameter, drivers, mind):
    """Acceleration [m/s²] that the next light permits."""
    distance = mind[RED_STATION, v] - mind[STATION, v] - parameter[FRONT, v]
    if distance == inf:
        return driver.NO_LIMIT
    return driver.stopping_acceleration(
        state[V_X, v], distance, drivers[STANDSTILL, v], drivers[HEADWAY, v], drivers[COMFORT, v],
        drivers[BRAKE_COMFORT, v],
    )  # fmt: skip


@compiled
def steer_wish(v, state, parameter, drivers, mind):
    """Road wheel angle [rad] that keeps the path."""
    compliance = driver.front_compliance(
        parameter[MASS, v], parameter[L_R, v], parameter[L_F, v] + parameter[L_R, v], parameter[C_FRONT, v]
    )
    return driver.path_steering(
        mind[FRONT_OFFSET, v], mind[D_PSI, v], mind[PATH_KAPPA, v], state[V_X, v], state[YAW_RATE, v],
        drivers[STEER_GAIN, v], drivers[YAW_DAMPING, v], compliance, parameter[STEER_MAX, v],
    )  # fmt: skip


@compiled
def decide(state, parameter, drivers, mind):
    """Fifth pass: what every driver wants of pedals and wheel."""
    for v in range(state.shape[1]):
        if state[ACTIVE, v] == 0.0:
            continue
        mind[STOPPING, v] = stop_wish(v, state, parameter, drivers, mind)
        free = driver.free_acceleration(
            state[V_X, v], mind[V_DESIRED, v], drivers[COMFORT, v], drivers[BRAKE_COMFORT, v]
        )
        mind[WISH, v] = min(min(free, mind[FOLLOWING, v]), min(mind[YIELDING, v], mind[STOPPING, v]))
        mind[STEER_WISH, v] = steer_wish(v, state, parameter, drivers, mind)


@compiled
def is_free(x, y, first, count, state):
    """Whether no car of the same world is near a place."""
    for other in range(first, first + count):
        dx, dy = state[X, other] - x, state[Y, other] - y
        if state[ACTIVE, other] > 0.0 and dx * dx + dy * dy < ENTRY_CLEARANCE * ENTRY_CLEARANCE:
            return False
    return True


@compiled
def recirculate(
    returns, points, path_first, path_count, raised, world_of, first, count, state, wheels, ground, parameter, gears, mind
):  # fmt: skip
    """Sixth pass: traffic that has arrived comes in again where its way begins, as soon as there is room."""
    for v in range(state.shape[1]):
        if state[ACTIVE, v] > 0.0 or returns[v] == 0:
            continue
        at, w = path_first[v], world_of[v]
        x, y = points[PATH_X, at], points[PATH_Y, at]
        if is_free(x, y, first[w], count[w], state):
            if raised[v] != 0:
                touch_all(v, state.shape[1], 0.0, points, at, path_count[v], ground)
            start(v, x, y, points[PATH_HEADING, at], points[PATH_SPEED, at], state, wheels, ground, parameter, gears)
            mind[STATION, v] = 0.0
