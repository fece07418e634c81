"""Passing on the oncoming lane what stands on the own one, where a street has one lane a direction.

what       somebody who stands though nothing keeps him, and objects: as many as there is no room between. Who waits in a queue or for a
           light is not passed
where      both lanes lie side by side, and all is over before the next junction; one sees as far as somebody may come from
when       those who come have the right of way: one is back, by their speed now and if nothing held them, `SPARE` before they are there
until      one has gone out: then one goes on. Before, one looks again and again; who waits keeps room to go out
others     who stands stays while he is passed; who comes, though nobody was to be seen, stops before the place
how        on the quintic of minimum jerk by the least that leaves room beside what stands, over a length that hangs on the speed
"""

from math import cos, inf, sin, sqrt

from studio.compiled import inlined, lean
from studio.model.passage import arrival_below
from studio.road.network.shadow import EYE, walls_between
from studio.road.ways.path import PATH_HEADING, PATH_HEIGHT, PATH_SPACING, PATH_X, PATH_Y, interpolate, project
from studio.vehicle.parameter import FRONT, L_F, L_R, LENGTH, STEER_MAX, WIDTH
from studio.vehicle.state import ACTIVE, V_X, X, Y
from studio.world.passes.junction import LONG, NEAREST, comes_in
from studio.world.passes.neighbour import COS, REAR_X, REAR_Y, SIN
from studio.world.passes.queue import KEY, THERE, WHO, bucket_of, first_drive, from_station, is_met, station_on
from studio.world.passes.regard import STANDING, follow, let_in
from studio.world.passes.traffic import ELBOW_ROOM, PREVIEW
from studio.world.table.mind import (
    AHEAD,
    ASIDE,
    AWAY,
    BACK_FROM,
    BACK_OVER,
    CHANGING,
    COMFORT,
    EXPECTED,
    GAP,
    IDLED,
    MISJUDGED,
    OUT_BEND,
    OUT_BY,
    OUT_FROM,
    OUT_OVER,
    OUT_SLOPE,
    RED_STATION,
    SIGHT,
    STANDSTILL,
    STATION,
    STUCK,
    V_DESIRED,
    WAY_STATION,
)  # fmt: skip
from studio.world.table.oncoming import ITS_FROM, ITS_TO, OWN_FROM, OWN_TO
from studio.world.table.street import O_HEADING, O_LENGTH, O_WIDTH, O_X, O_Y, SWEPT_ASIDE, SWEPT_AT, SWEPT_OBJECT
from studio.world.table.web import ENTER, LANE, LEAVE

NOBODY = -1
EVERY = 0.5  # [s]
REACH = 100.0  # [m] what stands is looked for so far ahead
IDLE = 1.5  # [s] who stands longer though he could drive on is passed
BESIDE, KERB = 0.5, 0.15  # [m] kept beside what is passed, and beside the far edge of the other lane
SHARE = 0.8  # [1] of the way out has been driven when the front comes to what stands: 94 % of it
OVER, HURRIED, SHORTEST, SHORT = 3.0, 2.0, 15.0, 2.0  # [s], [s], [m], [m] for the way out; shorter by so much if room is short
BACK = 2.5  # [s] one drives no faster than this asks for on the way back
WIDE, BEND, LOCK = 3.0, 5.8, 0.8  # [m] goes nobody farther out; greatest second derivative of the quintic; share of the lock
TAIL = 1.5  # [m] the own rear is beyond before one comes back
EASY, NEARLY = 0.8, 0.9  # [1] times the comfortable acceleration and the wanted speed, with which one reckons
SPARE, SURE, LATE = 2.5, 1.0, 1.0  # [s] kept to who comes: when one decides, when one looks again, and by whom is stopped for one
GOES = 3.0  # [m/s] who drives so fast makes room
DEEP = 3  # lanes behind each other from which one may come
STEP, VERGE, TOP = 10.0, 40.0, 1.0  # [m] between places looked at; so far aside in a bend one sees; heights of eye and car above the road


@lean
def pass_by(tick, every, state, parameter, places, points, path_first, path_count, world_of, number, first_of, entity, drive_first,
            drive_count, sweep, sweep_first, sweep_count, table, standing, first_object, facing, web, first, place, at, place_of, shadow,
            drivers, mind, k):  # fmt: skip
    """Who passes on the oncoming lane, or waits for it."""
    for v in range(state.shape[1]):
        if facing.passes[v] == 0:
            continue
        mind[OUT_SLOPE, v] = mind[OUT_BEND, v] = 0.0
        stuck, mind[STUCK, v] = mind[STUCK, v], 0.0
        if state[ACTIVE, v] == 0.0:
            stay_in(v, mind)
            continue
        is_out, is_meant = mind[STATION, v] >= mind[OUT_FROM, v], mind[OUT_BY, v] != 0.0
        if not is_meant and (mind[CHANGING, v] < 1.0 or not has_before_him(v, first_of[world_of[v]], mind)):
            continue
        d = own_drive(v, drive_first[v], drive_count[v], web, mind)
        if d < 0 or facing.lane[web.strand[d]] < 0:
            if is_meant:
                go_on(v, state, parameter, mind)
            continue
        is_asked = (k + entity[v]) % every == 0 and mind[AWAY, v] == 0.0
        if not is_meant or (is_asked and not is_out):
            mind[OUT_BY, v] = 0.0
            is_too_near = consider(
                v, d, is_asked, SURE if is_meant else SPARE, state, parameter, places, points, path_first[v], path_count[v], world_of[v],
                number, first_object[world_of[v]], sweep, sweep_first[v], sweep_count[v], table, standing, facing, web, first, place, at,
                place_of[world_of[v]], shadow, drivers, mind,
            )  # fmt: skip
            mind[STUCK, v] = stuck + tick if is_too_near else 0.0
        if mind[OUT_BY, v] != 0.0:
            go_on(v, state, parameter, mind)
        if mind[OUT_BY, v] != 0.0 and mind[STATION, v] >= mind[OUT_FROM, v]:
            hold_others(v, d, world_of[v], state, parameter, number, facing, web, first, place, at, drivers, mind)


@inlined
def stay_in(v, mind):
    """One who passes nothing."""
    if mind[OUT_BY, v] != 0.0:
        mind[OUT_BY, v] = mind[ASIDE, v] = 0.0


@inlined
def has_before_him(v, first_of, mind):
    """Whether the nearest ahead is an object, somebody who idles, or one who passes what is ahead of him."""
    if not mind[GAP, v] < REACH or mind[AHEAD, v] == -1.0:
        return False
    if mind[AHEAD, v] < 0.0:
        return True
    ahead = first_of + int(mind[AHEAD, v])
    return max(mind[IDLED, ahead], mind[STUCK, ahead]) > IDLE or mind[OUT_BY, ahead] != 0.0


@inlined
def own_drive(v, first, count, web, mind):
    """The drive on a lane that one is on; -1 for none."""
    station = mind[STATION, v]
    for d in range(first_drive(station, first, count, web), first + count):
        if web.drive[ENTER, d] > station:
            break
        if station < web.drive[LEAVE, d] and web.right[web.strand[d]] == LANE:
            return d
    return NOBODY


@inlined
def over_there(own, strand, facing):
    """A station of the own strand on the other lane [m]."""
    low, high = facing.span[OWN_FROM, strand], facing.span[OWN_TO, strand]
    its_low, its_high = facing.span[ITS_FROM, strand], facing.span[ITS_TO, strand]
    return its_low + (own - low) * (its_high - its_low) / (high - low)


# -- the way out and back ----------------------------------------------------------------------------


@inlined
def gone(share):
    """The quintic of minimum jerk, and its first two derivatives, at a share of its length from 0 to 1."""
    u = min(max(share, 0.0), 1.0)
    return u * u * u * (10.0 - u * (15.0 - 6.0 * u)), 30.0 * u * u * (1.0 - u) * (1.0 - u), 60.0 * u * (1.0 - u) * (1.0 - 2.0 * u)


@inlined
def aside_at(station, v, mind):
    """How far aside one wants to be at a station [m], the slope of this way to the path, its curvature beyond that of the path [1/m]."""
    p, p1, p2 = gone((station - mind[OUT_FROM, v]) / mind[OUT_OVER, v])
    q, q1, q2 = gone((station - mind[BACK_FROM, v]) / mind[BACK_OVER, v])
    a, b, by = 1.0 / mind[OUT_OVER, v], 1.0 / mind[BACK_OVER, v], mind[OUT_BY, v]
    return (
        by * p * (1.0 - q),
        by * (p1 * a * (1.0 - q) - p * q1 * b),
        by * (p2 * a * a * (1.0 - q) - 2.0 * p1 * a * q1 * b - p * q2 * b * b),
    )


@inlined
def go_on(v, state, parameter, mind):
    """Where one wants to be now; who has come back passes nothing any more."""
    if mind[STATION, v] >= mind[BACK_FROM, v] + mind[BACK_OVER, v]:
        stay_in(v, mind)
        return
    mind[V_DESIRED, v] = min(mind[V_DESIRED, v], mind[BACK_OVER, v] / BACK)
    axle = mind[STATION, v] + parameter[L_F, v]
    mind[ASIDE, v], mind[OUT_SLOPE, v], _ = aside_at(axle, v, mind)
    mind[OUT_BEND, v] = aside_at(axle + PREVIEW * state[V_X, v], v, mind)[2]


@lean
def hold_others(v, d, world, state, parameter, number, facing, web, first, place, at, drivers, mind):
    """Who is passed stays where he stands; who comes, and would be there too early, stops before the place."""
    strand, own = web.strand[d], station_on(d, mind[STATION, v], web)
    key, nose = world * web.right.size + strand, own + parameter[FRONT, v]
    back = own + mind[BACK_FROM, v] - mind[STATION, v]
    i, end = from_station(key, own - parameter[LENGTH, v], first, place, at)
    while i < end and place[KEY, i] == key and at[i] < back:
        other, i = place[WHO, i], i + 1
        if other != v and abs(state[V_X, other]) < STANDING:
            follow(other, number[v], NEAREST, 0.0, state, drivers, mind)
    left, speed = back + mind[BACK_OVER, v] - own, max(state[V_X, v], 0.0)
    y_end, y_nose = over_there(own + left + parameter[FRONT, v], strand, facing), over_there(nose, strand, facing)
    time, other, way = first_comer(
        v, facing.lane[strand], y_end, y_nose, inf, world, state, parameter, facing, web, first, place, at, drivers, mind
    )
    if other < 0:
        return
    if way < 0.0:  # on the place already: both stop before each other
        gap = max(y_nose - y_end + way, 0.0)
        follow(other, number[v], 0.5 * gap, 0.0, state, drivers, mind)
        follow(v, number[other], 0.5 * gap, 0.0, state, drivers, mind)
    elif time < arrival_below(left, speed, EASY * drivers[COMFORT, v], NEARLY * mind[V_DESIRED, v]) + LATE:
        follow(other, number[v], max(way, NEAREST), 0.0, state, drivers, mind)


# -- whether -----------------------------------------------------------------------------------------


@lean
def consider(v, d, is_asked, spare, state, parameter, places, points, path_first, path_count, world, number, first_object, sweep,
             sweep_first, sweep_count, table, standing, facing, web, first, place, at, map_, shadow, drivers, mind):  # fmt: skip
    """Whether one stands too near behind something to pass it; decides whether one does, as fast as one may or slowly.

    One is back `spare` [s] before others are there; who has to wait for that keeps room to go out.
    """
    strand, station = web.strand[d], mind[STATION, v]
    own, bumper, speed = station_on(d, station, web), station + parameter[FRONT, v], max(state[V_X, v], 0.0)
    key = world * web.right.size + strand
    gap, who = first_ahead(
        v, own, bumper, key, state, parameter, number, first_object, sweep, sweep_first, sweep_count, standing, first, place, at, mind
    )
    if not 0.0 < gap < REACH:
        return False
    least = max(SHORTEST, sqrt(BEND * WIDE * (parameter[L_F, v] + parameter[L_R, v]) / (LOCK * parameter[STEER_MAX, v])))
    slow, top = least / OVER, max(NEARLY * mind[V_DESIRED, v], 1.0)
    is_possible = False
    for pace in (top, min(slow, top)):
        fits, out_by, out_from, over, back_from, back_over = plan(
            v, own, bumper, gap, pace, least, key, strand, state, parameter, places, points, path_first, path_count, sweep, sweep_first,
            sweep_count, table, standing, facing, first, place, at, drivers, mind,
        )  # fmt: skip
        is_possible = is_possible or fits
        if not fits or not is_asked or over < max(least - SHORT, HURRIED * speed):
            continue
        if is_free(
            v, own, back_from + back_over - station, pace, spare, strand, world, state, parameter, points, path_first, path_count, facing,
            web, first, place, at, map_, shadow, drivers, mind,
        ):  # fmt: skip
            mind[OUT_BY, v], mind[OUT_FROM, v], mind[OUT_OVER, v], mind[BACK_FROM, v], mind[BACK_OVER, v] = (
                out_by, out_from, over, back_from, back_over,
            )  # fmt: skip
            return False
    if is_possible and gap > SHARE * least - SHORT:
        let_in(v, who, max(gap - SHARE * least + 1.0, NEAREST), 0.0, state, drivers, mind)
    return gap < SHARE * (least - SHORT) and speed < STANDING


@lean
def plan(v, own, bumper, gap, pace, least, key, strand, state, parameter, places, points, path_first, path_count, sweep, sweep_first,
         sweep_count, table, standing, facing, first, place, at, drivers, mind):  # fmt: skip
    """Whether there is room to pass with a pace [m/s] what stands `gap` [m] ahead, and the way: how far aside, from where and over how
    many metres out, and back."""
    station, speed, a, length = mind[STATION, v], max(state[V_X, v], 0.0), EASY * drivers[COMFORT, v], parameter[LENGTH, v]
    back_over = max(least, OVER * min(pace, sqrt(speed * speed + 2.0 * a * (gap + 2.0 * least))))
    far, edge = extent(
        v, own, bumper + gap, length + TAIL + back_over + drivers[STANDSTILL, v], facing.room[strand] > 0.0, key, state, parameter, places,
        points, path_first, path_count, sweep, sweep_first, sweep_count, table, standing, first, place, at, mind,
    )  # fmt: skip
    out_by = edge + BESIDE + 0.5 * parameter[WIDTH, v]
    wanted = max(least, OVER * min(max(pace, speed), sqrt(speed * speed + 2.0 * a * max(gap - SHARE * least, 0.0))))
    over = min(wanted, gap / SHARE)
    out_from = station + max(gap - SHARE * wanted, 0.0)
    back_from = max(far + length - parameter[FRONT, v] + TAIL, out_from + over)
    fits = out_by + 0.5 * parameter[WIDTH, v] + KERB <= abs(facing.room[strand])
    fits = fits and own + back_from + back_over - station + parameter[FRONT, v] <= facing.span[OWN_TO, strand]
    fits = fits and own + out_from - station >= facing.span[OWN_FROM, strand]
    return fits, out_by if facing.room[strand] > 0.0 else -out_by, out_from, over, back_from, back_over


@lean
def is_free(v, own, way, pace, spare, strand, world, state, parameter, points, path_first, path_count, facing, web, first, place, at, map_,
            shadow, drivers, mind):  # fmt: skip
    """Whether nobody comes for so many metres, and no line is there to wait at, as far as one sees and has to see."""
    station, nose, lane = mind[STATION, v], own + parameter[FRONT, v], facing.lane[strand]
    if min(mind[RED_STATION, v], mind[WAY_STATION, v]) < station + way:
        return False
    time = arrival_below(way, max(state[V_X, v], 0.0), EASY * drivers[COMFORT, v], pace) + drivers[EXPECTED, v] + spare
    reach = facing.limit[lane] * time
    seen = min(way + reach, facing.length[strand] - own)
    if not is_in_sight(v, seen, state, points, path_first, path_count, map_, shadow, drivers, mind):
        return False
    y_end, y_nose = over_there(nose + way, strand, facing), over_there(nose, strand, facing)
    comes, _, _ = first_comer(v, lane, y_end, y_nose, 2.0 * reach, world, state, parameter, facing, web, first, place, at, drivers, mind)
    return mind[MISJUDGED, v] * comes > time


@lean
def first_ahead(v, own, bumper, key, state, parameter, number, first_object, sweep, sweep_first, sweep_count, standing, first, place, at,
                mind):  # fmt: skip
    """How far it is to what stands ahead [m], and its number; infinite where there is nothing, or first somebody who is not passed."""
    gap, who, reach = inf, 0, 0.5 * parameter[WIDTH, v] + ELBOW_ROOM
    for i in range(sweep_first, sweep_first + sweep_count):
        thing = int(sweep[SWEPT_OBJECT, i])
        if sweep[SWEPT_AT, i] >= bumper and standing[thing] == 1 and sweep[SWEPT_ASIDE, i] < reach:
            gap, who = sweep[SWEPT_AT, i] - bumper, -2 - (thing - first_object)
            break
    i, end = from_station(key, own, first, place, at)
    while i < end and place[KEY, i] == key:
        other, there, i = place[WHO, i], at[i] + parameter[FRONT, place[WHO, i]] - own - parameter[FRONT, v], i + 1
        if other != v and place[THERE, i - 1] != 0:
            its_gap = there - parameter[LENGTH, other]
            if its_gap >= gap:
                break
            if mind[OUT_BY, other] == 0.0:
                return (its_gap, number[other]) if is_idle(other, state, mind) else (inf, 0)
    return gap, who


@inlined
def is_idle(other, state, mind):
    """Whether somebody stands though nothing keeps him, or cannot get away from behind such a one."""
    return abs(state[V_X, other]) < STANDING and max(mind[IDLED, other], mind[STUCK, other]) > IDLE


@lean
def extent(v, own, begin, needed, is_left, key, state, parameter, places, points, path_first, path_count, sweep, sweep_first, sweep_count,
           table, standing, first, place, at, mind):  # fmt: skip
    """Where all that stands one behind the other is over [m], and how far it reaches towards the other lane from the own path [m].

    Behind it are `needed` metres; infinite where somebody leaves no room there who waits.
    """
    far, edge, grows, shift = begin - 1e-3, -inf, True, mind[STATION, v] - own
    reach = 0.5 * parameter[WIDTH, v] + ELBOW_ROOM
    while grows:
        grows = False
        i, end = from_station(key, own, first, place, at)
        while i < end and place[KEY, i] == key:
            other, nose, i = place[WHO, i], at[i] + parameter[FRONT, place[WHO, i]] + shift, i + 1
            if other == v or place[THERE, i - 1] == 0 or nose <= far or (mind[OUT_BY, other] != 0.0 and state[V_X, other] >= STANDING):
                continue
            if nose - parameter[LENGTH, other] > far + needed:
                break
            if is_idle(other, state, mind):
                far, grows = nose, True
                edge = max(edge, edge_of(other, nose, is_left, parameter, places, points, path_first, path_count))
            elif state[V_X, other] < GOES:
                return inf, edge
        for j in range(sweep_first, sweep_first + sweep_count):
            thing = int(sweep[SWEPT_OBJECT, j])
            if standing[thing] == 1 and sweep[SWEPT_ASIDE, j] < reach and begin - 1.0 < sweep[SWEPT_AT, j] <= far + needed:
                length, side = lie(thing, sweep[SWEPT_AT, j], is_left, points, path_first, path_count, table)
                if sweep[SWEPT_AT, j] + length > far:
                    far, edge, grows = sweep[SWEPT_AT, j] + length, max(edge, side), True
    return far, edge


@inlined
def edge_of(other, guess, is_left, parameter, places, points, first, count):
    """How far a body reaches from a path towards the other lane [m]."""
    x, y, length = places[REAR_X, other], places[REAR_Y, other], parameter[LENGTH, other]
    _, rear = project(points, first, count, x, y, guess)
    _, front = project(points, first, count, x + length * places[COS, other], y + length * places[SIN, other], guess)
    return (max(rear, front) if is_left else -min(rear, front)) + 0.5 * parameter[WIDTH, other]


@inlined
def lie(thing, station, is_left, points, first, count, table):
    """How long an object lies along a path that comes to it at a station [m], and how far it reaches towards the other lane [m]."""
    at = min(max(station, 0.0), (count - 1.001) * PATH_SPACING)
    _, e = project(points, first, count, table[O_X, thing], table[O_Y, thing], at)
    turn = table[O_HEADING, thing] - interpolate(points, first, PATH_HEADING, at)
    c, b = abs(cos(turn)), abs(sin(turn))
    across = 0.5 * (table[O_LENGTH, thing] * b + table[O_WIDTH, thing] * c)
    return table[O_LENGTH, thing] * c + table[O_WIDTH, thing] * b, (e if is_left else -e) + across


@lean
def is_in_sight(v, needed, state, points, first, count, map_, shadow, drivers, mind):
    """Whether one sees so many metres of the street ahead: past buildings, in a bend, over a crest, in this weather.

    Beside a bend one sees as far aside as a quarter of `VERGE` is to the chord; eye and car are `TOP` above the road (RAL 2012).
    """
    if needed > drivers[SIGHT, v]:
        return False
    x, y, here = state[X, v], state[Y, v], min(max(mind[STATION, v], 0.0), (count - 1.001) * PATH_SPACING)
    heading, eye = interpolate(points, first, PATH_HEADING, here), interpolate(points, first, PATH_HEIGHT, here) + TOP
    c, b, steepest, away = cos(heading), sin(heading), -inf, STEP
    while away <= needed and here + away < (count - 1.001) * PATH_SPACING:
        px, py = interpolate(points, first, PATH_X, here + away), interpolate(points, first, PATH_Y, here + away)
        height = interpolate(points, first, PATH_HEIGHT, here + away)
        if abs((py - y) * c - (px - x) * b) > VERGE or (height + TOP - eye) / away < steepest:
            return False
        if walls_between(shadow, map_, x, y, EYE, px, py, EYE)[0] > 0:
            return False
        steepest, away = max(steepest, (height - eye) / away), away + STEP
    return True


# -- who comes ---------------------------------------------------------------------------------------


@lean
def first_comer(v, lane, y_end, y_nose, reach, world, state, parameter, facing, web, first, place, at, drivers, mind):
    """When the first who comes on a lane is at a station of it [s], who, and how far he is before it [m]; infinite and -1 for nobody.

    At once if he is on it, up to where v is. Who stands there and idles lets nobody through but one who passes him.
    """
    key, is_blocked = world * web.right.size + lane, False
    i, low = from_station(key, y_nose + LONG, first, place, at)[0] - 1, first[bucket_of(key, first.size - 1)]
    while i >= low and place[KEY, i] == key:
        other, nose, i = place[WHO, i], at[i] + parameter[FRONT, place[WHO, i]], i - 1
        if other == v or nose - parameter[LENGTH, other] >= y_nose:
            continue
        if nose > y_end or (mind[OUT_BY, other] != 0.0 and y_end - nose < reach):
            return 0.0, other, y_end - nose
        if y_end - nose > reach:
            return inf, NOBODY, inf
        is_blocked = is_blocked or is_idle(other, state, mind)
        if not is_blocked:
            return comes_in(other, y_end - nose, state, drivers, mind), other, y_end - nose
    if is_blocked:
        return inf, NOBODY, inf
    return from_afar(v, lane, y_end, reach, world, state, parameter, facing, web, first, place, at, drivers, mind)


@lean
def from_afar(v, lane, way, reach, world, state, parameter, facing, web, first, place, at, drivers, mind):
    """The same of those who come onto a lane, `way` [m] before the place."""
    for _ in range(DEEP):
        time, who, left = inf, NOBODY, inf
        for j in range(facing.into_first[lane], facing.into_first[lane + 1]):
            its_time, other, its_way = last_on(
                v, facing.into[j], way, world, state, parameter, facing, web, first, place, at, drivers, mind
            )
            if its_time < time:
                time, who, left = its_time, other, its_way
        leading = facing.into[facing.into_first[lane]] if facing.into_first[lane + 1] - facing.into_first[lane] == 1 else -1
        if who != NOBODY or leading < 0 or is_met(leading, web) or way > reach:
            return time, who, left
        way += facing.length[leading]
        lane = facing.into[facing.into_first[leading]]
        time, who, left = last_on(v, lane, way, world, state, parameter, facing, web, first, place, at, drivers, mind)
        if who != NOBODY:
            return time, who, left
        way += facing.length[lane]
    return inf, NOBODY, inf


@inlined
def last_on(v, strand, way, world, state, parameter, facing, web, first, place, at, drivers, mind):
    """The same of who is nearest to the end of a strand that ends `way` [m] before the place; not of one who stops at a light before."""
    key = world * web.right.size + strand
    i, low = from_station(key, inf, first, place, at)[0] - 1, first[bucket_of(key, first.size - 1)]
    while i >= low and place[KEY, i] == key:
        other, nose, i = place[WHO, i], at[i] + parameter[FRONT, place[WHO, i]], i - 1
        left = way + facing.length[strand] - nose
        if other != v and mind[RED_STATION, other] - mind[STATION, other] - parameter[FRONT, other] > left:
            return comes_in(other, left, state, drivers, mind), other, left
    return inf, NOBODY, inf
