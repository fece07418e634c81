"""Traffic: what the drivers of this tick see of road, lights and each other. Five passes, and what a driver sees of it.

Who is ahead is looked up in the queues of the strands that the own line leads over; who comes from elsewhere, where these meet others.
"""

from math import cos, inf, isfinite, sin, sqrt

from studio.compiled import inlined, lean
from studio.kind.driver import Sees
from studio.model import driver, helm
from studio.road.network.signals import GREEN, RED, signal_state
from studio.road.ways.path import (
    PATH_CURVATURE,
    PATH_HEADING,
    PATH_HEIGHT,
    PATH_SPACING,
    PATH_SPEED,
    interpolate,
    project,
)
from studio.vehicle.parameter import C_FRONT, C_REAR, FRONT, L_F, L_R, LENGTH, MASS, STEER_MAX, STEER_RATE, WIDTH
from studio.vehicle.state import ACTIVE, PSI, V_X, V_Y, YAW_RATE, X, Y
from studio.world.passes.fetch import EARLY, fetch
from studio.world.passes.ground import BEHIND, STRIDE, WINDOW
from studio.world.passes.junction import BESIDE, ELBOW_ROOM, STANDING, has_to_let_pass, is_none_to_follow, lane_under, waits
from studio.world.passes.level import OTHER_LEVEL
from studio.world.passes.neighbour import COS, SIN
from studio.world.passes.queue import KEY, THERE, WHO, first_drive, from_station, is_changed_to, is_met, station_on
from studio.world.passes.regard import (
    follow,
    forget,
    is_ahead,
    is_before,
    is_in_the_way,
    is_least,
    is_passed,
    is_unseen,
    let_in,
    rear_offset,
)
from studio.world.table.mind import (
    AHEAD,
    AHEAD_SPEED,
    ASIDE,
    BACK_FROM,
    BRAKE_COMFORT,
    CAREFUL,
    COMFORT,
    D_PSI,
    EXPECTED,
    FIRST,
    FRONT_OFFSET,
    GAINED,
    GAP,
    MINDED,
    OFFSET,
    OUT_BEND,
    OUT_BY,
    OUT_SLOPE,
    PATH_KAPPA,
    RED_STATION,
    SEEN_FIRST_GAP,
    SEEN_FIRST_SPEED,
    SEEN_GAP,
    SEEN_SPEED,
    SEEN_STOP,
    SIGHT,
    SIGHT_SPEED,
    SPEED_FACTOR,
    STATION,
    STEER_WISH,
    STOOD,
    STOPPING,
    SWAYED,
    V_DESIRED,
    WAY_STATION,
    WISH,
    YIELDING,
)  # fmt: skip
from studio.world.table.street import (
    O_HEADING,
    O_HEIGHT,
    O_LENGTH,
    O_SPEED,
    O_WIDTH,
    O_X,
    O_Y,
    OBJECT,
    SWEPT_ASIDE,
    SWEPT_AT,
    SWEPT_LEFT,
    SWEPT_OBJECT,
)  # fmt: skip
from studio.world.table.web import ENTER, LANE, LEAVE, START

PREVIEW = 0.25  # [s] a driver steers for where the car will be once the steering has followed
SPEED_PREVIEW = 1.0  # [s] and slows down for what comes, but speeds up only where it is allowed
MARGIN, DECIDING = 12.0, 3.0  # [m], [m/s²] how far before a way drivers mind who meets them there: MARGIN + v · 1 s + v²/DECIDING
AHEAD_OF_ONE = 2  # of those ahead are minded: the next, and the one before him
LOOK, LOOKING = 60.0, 2.0  # [m], [m/s²] how far ahead drivers mind who drives there: LOOK + v²/LOOKING
AWAY = 2.0  # [m/s] who has become faster than this stands no more
ARRIVAL = 6.0  # [m] before the end of its path a car has arrived


@lean
def lights(signal_time, signal_first, signal_count, phase_end, phase_state, forced, shown, t):
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
def will_stop(v, distance, station, light, state, drivers, mind):
    """Whether the driver stops for a light that is not green; who has decided to at a tick before stays with it."""
    speed, gained = state[V_X, v], mind[GAINED, v]
    if mind[RED_STATION, v] == station and driver.can_stop(speed, distance):
        return True
    then, there = driver.foreseen_speed(speed, gained), driver.foreseen_gap(distance, speed, gained, 0.0, drivers[EXPECTED, v])
    comes_too_late = light == RED or driver.is_red_then(speed, distance)
    return driver.must_stop(then, there) or (comes_too_late and driver.can_stop(then, there - then * driver.BRAKE_TIME))


@inlined
def next_red(v, state, parameter, drivers, mind, stop_first, stop_count, stop_station, stop_link, shown):
    """Station [m] of the next stop line in sight ahead of the bumper that shows no green and at which the driver will stop."""
    bumper = mind[STATION, v] + parameter[FRONT, v]
    for i in range(stop_first, stop_first + stop_count):
        distance = stop_station[i] - bumper
        is_shown = 0.0 < distance <= drivers[SIGHT, v] and shown[stop_link[i]] != GREEN
        if is_shown and will_stop(v, distance, stop_station[i], shown[stop_link[i]], state, drivers, mind):
            return stop_station[i]
    return inf


@lean
def orient(tick, state, parameter, places, points, path_first, path_count, stop_first, stop_count, stop_station, stop_link, shown,
           drivers, mind):  # fmt: skip
    """Second pass: own place on the path, permitted speed, next red light; forgets what was ahead."""
    for v in range(state.shape[1]):
        if v + EARLY < state.shape[1]:
            bring(v + EARLY, state, points, path_first[v + EARLY], mind)
        if state[ACTIVE, v] == 0.0:
            continue
        locate(v, state, parameter, places, points, path_first[v], path_count[v], mind)
        if mind[STATION, v] > (path_count[v] - 1) * PATH_SPACING - ARRIVAL:
            state[ACTIVE, v] = 0.0
        permitted = drivers[SPEED_FACTOR, v] * permitted_speed(v, state, points, path_first[v], path_count[v], mind)
        mind[V_DESIRED, v] = min(permitted, drivers[SIGHT_SPEED, v])
        mind[RED_STATION, v] = next_red(v, state, parameter, drivers, mind, stop_first[v], stop_count[v], stop_station, stop_link, shown)
        stand(v, tick, state, mind)
        forget(v, mind)
        mind[STOPPING, v] = before_line(v, state, parameter, drivers, mind)


@inlined
def bring(v, state, points, first, mind):
    """Fetches what is known of the road where a driver looks for himself, and where he will be."""
    here = first + int(mind[STATION, v])
    for k in range(WINDOW):
        fetch(points, 0, here - BEHIND + k * STRIDE)
    fetch(points, PATH_SPEED, here + int(SPEED_PREVIEW * state[V_X, v]))


@inlined
def before_line(v, state, parameter, drivers, mind):
    """Acceleration [m/s²] that the next stop line permits."""
    if mind[RED_STATION, v] == inf:
        return driver.NO_LIMIT
    return driver.stopping_acceleration(
        state[V_X, v], mind[RED_STATION, v] - mind[STATION, v] - parameter[FRONT, v], drivers[COMFORT, v], drivers[BRAKE_COMFORT, v]
    )


@inlined
def stand(v, tick, state, mind):
    """Counts how long one stands; who only moves up stands on."""
    if abs(state[V_X, v]) < STANDING:
        mind[STOOD, v] += tick
    elif abs(state[V_X, v]) > AWAY:
        mind[STOOD, v] = 0.0


@inlined
def permitted_speed(v, state, points, first, count, mind):
    """Speed [m/s] that is allowed here and a little ahead."""
    here = mind[STATION, v]
    ahead = here + SPEED_PREVIEW * state[V_X, v]
    return min(interpolate(points, first, PATH_SPEED, clip(here, count)), interpolate(points, first, PATH_SPEED, clip(ahead, count)))


@lean
def others(state, parameter, places, points, path_first, path_count, world_of, number, entity, drive_first, drive_count, web, first,
           place, at, drivers, mind):  # fmt: skip
    """Third pass: for every driver who is ahead on the own strands, and whom he meets where others come near."""
    for v in range(state.shape[1]):
        if state[ACTIVE, v] != 0.0:
            look_along(
                v, state, parameter, places, points, path_first[v], path_count[v], world_of[v], number, entity, drive_first[v],
                drive_count[v], web, first, place, at, drivers, mind,
            )  # fmt: skip
            yield_at_line(v, state, parameter, drivers, mind)


@inlined
def yield_at_line(v, state, parameter, drivers, mind):
    """Waiting before a line is giving way as well."""
    if mind[WAY_STATION, v] < inf:
        distance = mind[WAY_STATION, v] - mind[STATION, v] - parameter[FRONT, v]
        permitted = driver.stopping_acceleration(state[V_X, v], distance, drivers[COMFORT, v], drivers[BRAKE_COMFORT, v])
        if is_least(v, permitted, mind):
            mind[MINDED, v] = mind[FIRST, v]
        mind[YIELDING, v] = min(mind[YIELDING, v], permitted)


@inlined
def look_along(v, state, parameter, places, points, path_first, path_count, world, number, entity, drive_first, drive_count, web, first,
               place, at, drivers, mind):  # fmt: skip
    """Strand after strand, until enough are ahead and no way is near that is still to be decided about.

    Ways between which there is no room for the own body are decided about together, before the line of the first.
    """
    station, speed = mind[STATION, v], max(state[V_X, v], 0.0)
    bumper = station + parameter[FRONT, v]
    rear, far = bumper - parameter[LENGTH, v], bumper + LOOK + speed * speed / LOOKING
    near = bumper + MARGIN + speed + speed * speed / DECIDING
    left, may_go, decided = AHEAD_OF_ONE, True, mind[WAY_STATION, v]
    mind[WAY_STATION, v], line, behind, inside = inf, inf, -inf, False
    for d in range(first_drive(rear, drive_first, drive_count, web), drive_first + drive_count):
        enter, strand = web.drive[ENTER, d], web.strand[d]
        is_way = web.right[strand] != LANE
        goes_on = is_way and enter - behind < parameter[LENGTH, v] + driver.STOP_CLOSE
        if enter > far or not (left > 0 or (may_go and (enter <= near or goes_on))):
            return
        if web.drive[LEAVE, d] <= rear:
            continue
        own = station_on(d, station, web)
        if left > 0 or enter <= bumper:
            left -= led_by(
                v, own, max(left, 1), world * web.right.size + strand, enter > bumper and web.drive[START, d] > 0.0, state, parameter,
                places, points, path_first, path_count, number, entity, first, place, at, drivers, mind,
            )  # fmt: skip
        if may_go and bumper < enter and is_changed_to(d, bumper, speed, web):
            under = max(lane_under(d, drive_first, web), drive_first)
            may_go = not has_to_let_pass(
                v, own, enter, decided, world * web.right.size + strand, world * web.right.size + web.strand[under],
                station_on(under, station, web), state, parameter, number, entity, first, place, at, drivers, mind,
            )  # fmt: skip
        if is_way:
            line = line if goes_on else enter
            behind = web.drive[LEAVE, d] if enter > bumper else -inf
        if may_go and (enter <= near or goes_on) and is_met(strand, web):
            may_go = not waits(
                v, d, drive_first + drive_count, own, line if is_way else enter, bumper, inside and is_way, decided, state, parameter,
                places, points, path_first, path_count, world, number, entity, web, first, place, at, drivers, mind,
            )  # fmt: skip
        inside = is_way and enter <= bumper


@inlined
def led_by(v, own, most, key, is_over, state, parameter, places, points, path_first, path_count, number, entity, first, place, at,
           drivers, mind):  # fmt: skip
    """How many are ahead on one strand, of so many at most; they are followed, and the first who is in the way is who is ahead.

    `is_over` says that it is a lane onto which v has still to come, from the side.
    """
    nose, found = own + parameter[FRONT, v], 0
    i, end = from_station(key, own, first, place, at)
    while i < end and place[KEY, i] == key and found < most:
        other, there, is_there, i = place[WHO, i], at[i], place[THERE, i], i + 1
        if other == v or is_unseen(v, other, state, parameter, drivers):
            continue
        gap = there + parameter[FRONT, other] - parameter[LENGTH, other] - nose
        if is_there == 0:
            if own > 0.0 and gap >= BESIDE:  # somebody who will change to this lane
                let_in(v, number[other], gap, state[V_X, other], state, drivers, mind)
            continue
        if is_passed(v, other, mind[STATION, v] + parameter[FRONT, v] + gap, state, parameter, mind):
            continue
        if is_none_to_follow(v, other, gap, is_over, state, parameter, places, points, path_first, path_count, number, entity, mind):
            continue
        follow(v, number[other], gap, state[V_X, other], state, drivers, mind)
        found += 1
        e = rear_offset(other, mind[STATION, v] + gap, places, points, path_first, path_count) if gap > 0.0 else inf
        if is_in_the_way(v, other, e, parameter):
            is_ahead(v, other, number[other], gap, state[V_X, other], e, parameter, mind)
    return found


@lean
def obstacles(state, parameter, sweep, sweep_first, sweep_count, standing, first_object, world_of, drivers, mind):
    """Fourth pass: the first object in sight that stands in the strip which the own body will sweep."""
    for v in range(state.shape[1]):
        if state[ACTIVE, v] == 0.0:
            continue
        bumper, reach = mind[STATION, v] + parameter[FRONT, v], 0.5 * parameter[WIDTH, v] + ELBOW_ROOM
        for i in range(sweep_first[v], sweep_first[v] + sweep_count[v]):
            gap, number = sweep[SWEPT_AT, i] - bumper, int(sweep[SWEPT_OBJECT, i])
            if mind[OUT_BY, v] != 0.0 and sweep[SWEPT_AT, i] < mind[BACK_FROM, v]:
                continue  # it is passed on the oncoming lane
            if gap >= 0.0 and standing[number] == 1 and sweep[SWEPT_ASIDE, i] < reach:
                if gap <= drivers[SIGHT, v]:
                    left = sweep[SWEPT_LEFT, i]
                    half = abs(left) - sweep[SWEPT_ASIDE, i]
                    stand_before(v, number - first_object[world_of[v]], gap, 0.0, left, half, state, parameter, drivers, mind)
                break


@lean
def stand_before(v, number, gap, speed, e, half, state, parameter, drivers, mind):
    """Object `number` of the world, from e - half to e + half [m] left of the path, is followed as a car with its speed [m/s]."""
    follow(v, OBJECT - number, gap, speed, state, drivers, mind)
    if not gap >= mind[GAP, v] and is_before(v, e, half, parameter, mind):
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
    if abs(interpolate(points, first, PATH_HEIGHT, clip(s, count)) - table[O_HEIGHT, i]) > OTHER_LEVEL:
        return
    across = table[O_HEADING, i] - interpolate(points, first, PATH_HEADING, clip(s, count))
    c, b = abs(cos(across)), abs(sin(across))
    along, aside = 0.5 * (table[O_LENGTH, i] * c + table[O_WIDTH, i] * b), 0.5 * (table[O_LENGTH, i] * b + table[O_WIDTH, i] * c)
    gap = s - along - mind[STATION, v] - parameter[FRONT, v]
    beside = min(abs(e), abs(e - mind[OUT_BY, v])) - aside  # of the path, and of where one passes on the oncoming lane
    if gap >= 0.0 and beside < 0.5 * parameter[WIDTH, v] + ELBOW_ROOM:
        stand_before(v, number, gap, max(table[O_SPEED, i] * cos(across), 0.0), e, aside, state, parameter, drivers, mind)


@inlined
def compliance(v, own, other, stiffness, parameter):
    """Slip angle per lateral acceleration [rad s²/m] of the axle that is `own` from the centre of gravity, the other one `other`."""
    return helm.compliance(parameter[MASS, v], parameter[other, v], parameter[own, v] + parameter[other, v], parameter[stiffness, v])


@inlined
def sees(v, state, parameter, mind):
    """What a driver of any kind sees of all this."""
    front, rear = compliance(v, L_F, L_R, C_FRONT, parameter), compliance(v, L_R, L_F, C_REAR, parameter)
    return Sees(
        driver.foreseen_speed(state[V_X, v], mind[GAINED, v]), state[YAW_RATE, v], min(mind[V_DESIRED, v], mind[CAREFUL, v]),
        mind[SEEN_GAP, v], mind[SEEN_SPEED, v], mind[SEEN_FIRST_GAP, v], mind[SEEN_FIRST_SPEED, v], mind[SEEN_STOP, v],
        mind[FRONT_OFFSET, v] - mind[SWAYED, v] - mind[ASIDE, v], mind[D_PSI, v] - mind[OUT_SLOPE, v],
        mind[PATH_KAPPA, v] + mind[OUT_BEND, v], front, parameter[STEER_MAX, v],
        parameter[STEER_RATE, v], parameter[L_F, v] + parameter[L_R, v], front - rear,
        state[V_Y, v] + parameter[L_F, v] * state[YAW_RATE, v], state[V_X, v],
    )  # fmt: skip


@inlined
def put(v, acceleration, steering, mind):
    """Keeps what a driver wants, acceleration [m/s²] and road wheel angle [rad]; 1 when these are no numbers, else 0."""
    mind[WISH, v], mind[STEER_WISH, v] = acceleration, steering
    return 0 if isfinite(acceleration) and isfinite(steering) else 1
