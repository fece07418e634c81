"""Traffic: what the drivers of this tick see of road, lights and each other. Five passes, and what a driver sees of it.

Two paths that run within a lane's width of each other share a zone: a stretch of one belongs to a stretch of the other.
Following on one lane, merging and crossing are then one and the same: a car that is in the zone, or will be there
first, drives ahead at the distance that the stretches give.
"""

from math import cos, inf, isfinite, nan, sin, sqrt

from studio.compiled import inlined, lean
from studio.kind.driver import Sees
from studio.model import driver, helm
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
from studio.vehicle.parameter import C_FRONT, C_REAR, FRONT, L_F, L_R, LENGTH, MASS, STEER_MAX, STEER_RATE, WIDTH
from studio.vehicle.shift import start
from studio.vehicle.state import ACTIVE, PSI, V_X, V_Y, YAW_RATE, X, Y
from studio.world.passes.ground import touch_all
from studio.world.passes.neighbour import COS, REAR_X, REAR_Y, SIN, moved, within
from studio.world.passes.queue import from_station
from studio.world.table.mind import (
    AHEAD,
    AHEAD_SPEED,
    BRAKE_COMFORT,
    COMFORT,
    D_PSI,
    FIRST_GAP,
    FIRST_SPEED,
    FOLLOW_GAP,
    FOLLOW_SPEED,
    FOLLOWING,
    FRONT_OFFSET,
    GAP,
    HEADWAY,
    OFFSET,
    PATH_KAPPA,
    RED_STATION,
    SIGHT,
    SIGHT_SPEED,
    SPEED_FACTOR,
    STANDSTILL,
    STATION,
    STEER_WISH,
    V_DESIRED,
    WISH,
    YIELDING,
)  # fmt: skip
from studio.world.table.street import (
    O_HEADING,
    O_LENGTH,
    O_SPEED,
    O_WIDTH,
    O_X,
    O_Y,
    OBJECT,
    SWEPT_ASIDE,
    SWEPT_AT,
    SWEPT_OBJECT,
)  # fmt: skip

PREVIEW = 0.25  # [s] a driver steers for where the car will be once the steering has followed
SPEED_PREVIEW = 1.0  # [s] and slows down for what comes, but speeds up only where it is allowed
HORIZON = 60.0  # [m] how far before a merge drivers mind each other
STANDING = 0.5  # [m/s] a car slower than this, still outside, is not waited for
ELBOW_ROOM = 0.2  # [m] that a driver leaves beside the body to what stands there
SLACK = 1e-6  # [m] by which a bound gives way to rounding
ARRIVAL = 6.0  # [m] before the end of its path a car has arrived
ENTRY_CLEARANCE = 30.0  # [m] that must be free around the start of a path for a car to come in


@lean
def lights(t, signal_time, signal_first, signal_count, phase_end, phase_state, forced, shown):
    """First pass: what every signal shows, by its programme or as it is forced to."""
    for link in range(shown.size):
        if forced[link] >= 0:
            shown[link] = forced[link]
            continue
        shown[link] = signal_state(
            t, signal_time[0, link], signal_time[1, link], signal_first[link], signal_count[link], phase_end, phase_state
        )


@inlined
def locate(v, state, parameter, places, points, first, count, mind):
    """Where the car is on its path, and how its front axle stands to it."""
    psi, l_f = state[PSI, v], parameter[L_F, v]
    s, e = project(points, first, count, state[X, v], state[Y, v], mind[STATION, v])
    x_f, y_f = state[X, v] + l_f * places[COS, v], state[Y, v] + l_f * places[SIN, v]
    s_f, e_f = project(points, first, count, x_f, y_f, s + l_f)
    mind[STATION, v] = s
    mind[OFFSET, v] = e
    mind[FRONT_OFFSET, v] = e_f
    ahead = s_f + PREVIEW * state[V_X, v]
    mind[PATH_KAPPA, v] = interpolate(points, first, PATH_CURVATURE, clip(ahead, count))
    mind[D_PSI, v] = psi - interpolate(points, first, PATH_HEADING, clip(s_f, count))


@inlined
def clip(s, count):
    """A station that lies on the path."""
    return min(max(s, 0.0), (count - 1.001) * PATH_SPACING)


@inlined
def will_stop(v, distance, station, state, mind):
    """Whether the driver stops for a light that is not green; who has decided to at a tick before stays with it."""
    decided = mind[RED_STATION, v] == station and driver.can_stop(state[V_X, v], distance)
    return decided or driver.must_stop(state[V_X, v], distance)


@inlined
def next_red(v, state, parameter, mind, stop_first, stop_count, stop_station, stop_link, shown, sight):
    """Station [m] of the next stop line in sight ahead of the bumper that shows no green and at which the driver will stop."""
    bumper = mind[STATION, v] + parameter[FRONT, v]
    for i in range(stop_first, stop_first + stop_count):
        distance = stop_station[i] - bumper
        if 0.0 < distance <= sight and shown[stop_link[i]] != GREEN and will_stop(v, distance, stop_station[i], state, mind):
            return stop_station[i]
    return inf


@lean
def orient(state, parameter, places, points, path_first, path_count, stop_first, stop_count, stop_station, stop_link, shown,
           drivers, mind):  # fmt: skip
    """Second pass: own place on the path, permitted speed, next red light; forgets what was ahead."""
    for v in range(state.shape[1]):
        if state[ACTIVE, v] == 0.0:
            continue
        locate(v, state, parameter, places, points, path_first[v], path_count[v], mind)
        if mind[STATION, v] > (path_count[v] - 1) * PATH_SPACING - ARRIVAL:
            state[ACTIVE, v] = 0.0
        permitted = drivers[SPEED_FACTOR, v] * permitted_speed(v, state, points, path_first[v], path_count[v], mind)
        mind[V_DESIRED, v] = min(permitted, drivers[SIGHT_SPEED, v])
        mind[RED_STATION, v] = next_red(
            v, state, parameter, mind, stop_first[v], stop_count[v], stop_station, stop_link, shown, drivers[SIGHT, v]
        )
        forget(v, mind)


@inlined
def permitted_speed(v, state, points, first, count, mind):
    """Speed [m/s] that is allowed here and a little ahead."""
    here = mind[STATION, v]
    ahead = here + SPEED_PREVIEW * state[V_X, v]
    return min(interpolate(points, first, PATH_SPEED, clip(here, count)), interpolate(points, first, PATH_SPEED, clip(ahead, count)))


@inlined
def forget(v, mind):
    """Nothing is ahead until a zone says so."""
    mind[GAP, v] = nan
    mind[AHEAD, v] = -1.0
    mind[AHEAD_SPEED, v] = 0.0
    mind[FOLLOWING, v] = mind[YIELDING, v] = driver.NO_LIMIT
    mind[FOLLOW_GAP, v] = mind[FIRST_GAP, v] = inf


@inlined
def behind(v, gap, speed, state, drivers, mind):
    """IDM acceleration [m/s²] of v, `gap` [m] behind something with a speed [m/s]."""
    own = state[V_X, v]
    return driver.following_acceleration(
        own, mind[V_DESIRED, v], gap, own - speed, drivers[STANDSTILL, v], drivers[HEADWAY, v], drivers[COMFORT, v],
        drivers[BRAKE_COMFORT, v],
    )  # fmt: skip


@inlined
def follow(v, gap, speed, state, drivers, mind):
    """Somebody is ahead: who permits least is minded."""
    permitted = behind(v, gap, speed, state, drivers, mind)
    if permitted < mind[FOLLOWING, v]:
        mind[FOLLOWING, v], mind[FOLLOW_GAP, v], mind[FOLLOW_SPEED, v] = permitted, gap, speed


@inlined
def let_in(v, gap, speed, state, drivers, mind):
    """Somebody goes first: who permits least is minded."""
    permitted = max(behind(v, gap, speed, state, drivers, mind), -driver.COURTESY)
    if permitted < mind[YIELDING, v]:
        mind[YIELDING, v], mind[FIRST_GAP, v], mind[FIRST_SPEED, v] = permitted, gap, speed


@inlined
def is_in_the_way(v, other, s_guess, parameter, places, points, first, count):
    """Whether the rear of the other car overlaps the strip that v's body will sweep along its path."""
    _, e = project(points, first, count, places[REAR_X, other], places[REAR_Y, other], s_guess)
    return abs(e) < 0.5 * (parameter[WIDTH, v] + parameter[WIDTH, other])


@inlined
def is_ahead(v, other, number, gap, state, mind):
    """The other car, of this number in its world, is what the gap is measured to, if it is the nearest, or the first of the nearest."""
    if not gap >= mind[GAP, v] or (gap == mind[GAP, v] and number < mind[AHEAD, v]):  # true too while the gap is not a number
        mind[GAP, v] = gap
        mind[AHEAD, v] = number
        mind[AHEAD_SPEED, v] = state[V_X, other]


@inlined
def goes_first(v, other, d_v, d_other, zone_start, state, mind):
    """Whether the other car, also before the zone, will be there before v: nearer, and neither waiting nor held."""
    held = mind[RED_STATION, other] <= zone_start
    nearer = d_other < d_v or (d_other == d_v and other < v)
    return nearer and not held and d_other < HORIZON and state[V_X, other] > STANDING


@inlined
def is_unseen(v, other, state, parameter, drivers):
    """Whether the other car is farther from the own front bumper than one sees."""
    dx, dy = state[X, other] - state[X, v], state[Y, other] - state[Y, v]
    reach = drivers[SIGHT, v] + parameter[FRONT, v] + parameter[LENGTH, other] - parameter[FRONT, other]
    return dx * dx + dy * dy > reach * reach


@inlined
def meet(v, other, number, v_enter, v_leave, other_enter, other_leave, state, parameter, places, points, first, count, drivers, mind):
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
            follow(v, gap, state[V_X, other], state, drivers, mind)
            rear = bumper + gap
            if gap > 0.0 and is_in_the_way(v, other, rear, parameter, places, points, first, count):
                is_ahead(v, other, number, gap, state, mind)
    elif bumper < v_enter and goes_first(v, other, v_enter - bumper, other_enter - bumper_other, other_enter, state, mind):
        let_in(v, gap, state[V_X, other], state, drivers, mind)


@inlined
def asks_no_more(v, gap, speed, state, drivers, mind):
    """Whether nobody from this gap [m] on, none slower than `speed`, can ask more of v than is asked already, or be nearer."""
    if not gap > mind[GAP, v] or gap <= 0.0 or state[V_X, v] < 0.0:
        return False
    return behind(v, gap, speed, state, drivers, mind) >= mind[FOLLOWING, v]


@inlined
def meet_queue(v, begin, end, order, slowest, number, longest, v_enter, v_leave, other_enter, other_leave, state, parameter, places,
               points, first, count, drivers, mind):  # fmt: skip
    """What one zone means for v: everybody in the queue of the other track from where he may matter on.

    Who is farther back than v itself will not be first, and from somewhere ahead on nobody asks more than the nearer ones.
    """
    bumper = mind[STATION, v] + parameter[FRONT, v]
    if bumper - parameter[LENGTH, v] > v_leave or v_enter - bumper > HORIZON:
        return
    station = other_enter + (mind[STATION, v] - v_enter) - longest - SLACK
    for place in range(from_station(station, begin, end, mind, order), end):
        other = order[place]
        rear = mind[STATION, other] - longest - SLACK  # or before
        if rear > other_leave:
            return
        if mind[STATION, other] >= other_enter and asks_no_more(
            v, (rear - other_enter) - (bumper - v_enter), slowest[place], state, drivers, mind
        ):
            return
        if other != v:
            meet(
                v, other, number[other], v_enter, v_leave, other_enter, other_leave, state, parameter, places, points, first, count,
                drivers, mind,
            )  # fmt: skip


@lean
def meetings(state, parameter, places, points, path_first, path_count, world_of, number, longest, track, queue_of, partner_first, partner,
             zone_first, zone_span, queue_first, order, slowest, drivers, mind):  # fmt: skip
    """Third pass: for every driver the queues on the tracks that his own meets."""
    for v in range(state.shape[1]):
        if state[ACTIVE, v] == 0.0:
            continue
        for p in range(partner_first[track[v]], partner_first[track[v] + 1]):
            queue = queue_of[world_of[v], partner[p]]
            if queue < 0 or queue_first[queue] == queue_first[queue + 1]:
                continue
            for z in range(zone_first[p], zone_first[p + 1]):
                meet_queue(
                    v, queue_first[queue], queue_first[queue + 1], order, slowest, number, longest, zone_span[0, z], zone_span[1, z],
                    zone_span[2, z], zone_span[3, z], state, parameter, places, points, path_first[v], path_count[v], drivers, mind,
                )  # fmt: skip


@lean
def obstacles(state, parameter, sweep, sweep_first, sweep_count, standing, first_object, world_of, drivers, mind):
    """Fourth pass: the first object in sight that stands in the strip which the own body will sweep."""
    for v in range(state.shape[1]):
        if state[ACTIVE, v] == 0.0:
            continue
        bumper, reach = mind[STATION, v] + parameter[FRONT, v], 0.5 * parameter[WIDTH, v] + ELBOW_ROOM
        for i in range(sweep_first[v], sweep_first[v] + sweep_count[v]):
            gap, number = sweep[SWEPT_AT, i] - bumper, int(sweep[SWEPT_OBJECT, i])
            if gap >= 0.0 and standing[number] == 1 and sweep[SWEPT_ASIDE, i] < reach:
                if gap <= drivers[SIGHT, v]:
                    stand_before(v, number - first_object[world_of[v]], gap, 0.0, state, drivers, mind)
                break


@lean
def stand_before(v, number, gap, speed, state, drivers, mind):
    """Object `number` of the world is followed as a car with its speed [m/s]."""
    follow(v, gap, speed, state, drivers, mind)
    if not gap >= mind[GAP, v]:
        mind[GAP, v], mind[AHEAD, v], mind[AHEAD_SPEED, v] = gap, OBJECT - number, speed


@lean
def movers(state, parameter, points, path_first, path_count, mover, table, standing, first_object, object_count, world_of, drivers, mind):
    """The same for those who move, wherever they are now: a driver minds one from the moment on at which he is in that strip."""
    for v in range(state.shape[1]):
        if state[ACTIVE, v] == 0.0:
            continue
        first = first_object[world_of[v]]
        for i in mover:
            if standing[i] != 0 and first <= i < first + object_count[world_of[v]]:
                mind_mover(v, i, i - first, state, parameter, points, path_first[v], path_count[v], table, drivers, mind)


@lean
def mind_mover(v, i, number, state, parameter, points, first, count, table, drivers, mind):
    """What one who moves means for a driver."""
    dx, dy = table[O_X, i] - state[X, v], table[O_Y, i] - state[Y, v]
    distance = sqrt(dx * dx + dy * dy)
    if distance > drivers[SIGHT, v] + parameter[FRONT, v] or dx * cos(state[PSI, v]) + dy * sin(state[PSI, v]) < 0.0:
        return
    s, e = project(points, first, count, table[O_X, i], table[O_Y, i], mind[STATION, v] + distance)
    across = table[O_HEADING, i] - interpolate(points, first, PATH_HEADING, clip(s, count))
    c, b = abs(cos(across)), abs(sin(across))
    along, aside = 0.5 * (table[O_LENGTH, i] * c + table[O_WIDTH, i] * b), 0.5 * (table[O_LENGTH, i] * b + table[O_WIDTH, i] * c)
    gap = s - along - mind[STATION, v] - parameter[FRONT, v]
    if gap >= 0.0 and abs(e) - aside < 0.5 * parameter[WIDTH, v] + ELBOW_ROOM:
        stand_before(v, number, gap, max(table[O_SPEED, i] * cos(across), 0.0), state, drivers, mind)


@inlined
def compliance(v, own, other, stiffness, parameter):
    """Slip angle per lateral acceleration [rad s²/m] of the axle that is `own` from the centre of gravity, the other one `other`."""
    return helm.compliance(parameter[MASS, v], parameter[other, v], parameter[own, v] + parameter[other, v], parameter[stiffness, v])


@inlined
def sees(v, state, parameter, mind):
    """What a driver of any kind sees of all this."""
    front, rear = compliance(v, L_F, L_R, C_FRONT, parameter), compliance(v, L_R, L_F, C_REAR, parameter)
    return Sees(
        state[V_X, v], state[YAW_RATE, v], mind[V_DESIRED, v], mind[FOLLOW_GAP, v], mind[FOLLOW_SPEED, v], mind[FIRST_GAP, v],
        mind[FIRST_SPEED, v], mind[RED_STATION, v] - mind[STATION, v] - parameter[FRONT, v], mind[FRONT_OFFSET, v], mind[D_PSI, v],
        mind[PATH_KAPPA, v], front, parameter[STEER_MAX, v], parameter[STEER_RATE, v], parameter[L_F, v] + parameter[L_R, v], front - rear,
        state[V_Y, v] + parameter[L_F, v] * state[YAW_RATE, v],
    )  # fmt: skip


@inlined
def put(v, acceleration, steering, mind):
    """Keeps what a driver wants, acceleration [m/s²] and road wheel angle [rad]; 1 when these are no numbers, else 0."""
    mind[WISH, v], mind[STEER_WISH, v] = acceleration, steering
    return 0 if isfinite(acceleration) and isfinite(steering) else 1


@lean
def is_free(x, y, world, reach, world_of, state, grid, places, found, entered, count):
    """Whether no car of the same world is near a place: none of those that are about, nor of the first that have entered just now."""
    for i in range(within(world, x, y, 1.0, 0.0, -reach, reach, -reach, reach, grid, places, found)):
        if is_close(found[i], x, y, state):
            return False
    for i in range(count):
        if world_of[entered[i]] == world and is_close(entered[i], x, y, state):
            return False
    return True


@lean
def is_close(other, x, y, state):
    """Whether a car is near a place."""
    dx, dy = state[X, other] - x, state[Y, other] - y
    return state[ACTIVE, other] > 0.0 and dx * dx + dy * dy < ENTRY_CLEARANCE * ENTRY_CLEARANCE


@lean
def recirculate(
    returns, points, path_first, path_count, raised, world_of, grid, places, found, entered, state, wheels, ground, parameter, gears, mind
):  # fmt: skip
    """Fifth pass: traffic that has arrived comes in again where its way begins, as soon as there is room."""
    count, reach = 0, 0.0
    for v in range(state.shape[1]):
        if state[ACTIVE, v] > 0.0 or returns[v] == 0:
            continue
        if reach == 0.0:
            reach = ENTRY_CLEARANCE + moved(state, places)
        at = path_first[v]
        x, y = points[PATH_X, at], points[PATH_Y, at]
        if is_free(x, y, world_of[v], reach, world_of, state, grid, places, found, entered, count):
            if raised[v] != 0:
                touch_all(v, state.shape[1], 0.0, points, at, path_count[v], ground)
            start(v, x, y, points[PATH_HEADING, at], points[PATH_SPEED, at], state, wheels, ground, parameter, gears)
            mind[STATION, v] = 0.0
            entered[count] = v
            count += 1
