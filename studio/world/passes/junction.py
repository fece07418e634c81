"""Junctions: whom a driver lets go first on a way, and where he waits for it.

Before the line of a way, where its strand begins, he decides whether he may go; beyond it he is committed, and others know it.

    sign, ring, light    who goes first by the map is let by, unless the gap before him is long enough; a full halt first where a stop sign
                         stands. With a green light one waits in the junction, where the ways meet
    equal                who comes first goes first; at an all-way stop who has stood longer. Where the ways run together who is slow moves
                         up to that place: from afar, each of a stream would be there before him
    corners              whom a building hides is not minded; one comes so slowly that one can still stop for him, and feels one's way
    several ways         between which there is no room for the own body are decided about together, before the line of the first
    behind a line        who has come to a stand there, before the place where he gives way, gives way there once more to those who drive
    within a junction    behind a way, where another begins at once, one does not wait before its line for somebody who stands beyond, but
                         moves up to where he is: one's own rear may be in another's way
    crossed ways         are not entered while there is no room behind them; nor is a ring where there is room for a few only
    slow traffic         lets in whoever has waited for long, and after half a minute one takes shorter gaps
    nobody goes          of those who have stood a while, who has stood longest goes before one who stands as well; if he cannot, since
                         another stands in his way, that one goes
"""

from math import inf, nan, sqrt

from studio.compiled import inlined
from studio.model import driver
from studio.model.passage import AFTER, PATIENT, arrival, arrival_below, is_enough, merging_headway, wanted_gap
from studio.road.ways.conflict import ALONG, EQUAL, GIVE, NONE, SHARED, TAKE
from studio.road.ways.path import PATH_SPACING, PATH_SPEED, interpolate, project
from studio.vehicle.parameter import FRONT, LENGTH, WIDTH
from studio.vehicle.state import V_X
from studio.world.passes.corner import READY, appears_in, has_corner, is_hidden, ready_speed
from studio.world.passes.narrow import waits_outside
from studio.world.passes.neighbour import COS, REAR_X, REAR_Y, SIN
from studio.world.passes.queue import KEY, THERE, WHO, from_station
from studio.world.passes.regard import STANDING, behind, follow, is_ahead, is_in_the_way, is_unseen, let_in, rear_offset
from studio.world.table.mind import (
    BRAKE_COMFORT,
    CAREFUL,
    COMFORT,
    EXPECTED,
    FIRST,
    FOLLOW_GAP,
    FOLLOW_SPEED,
    GAINED,
    GAP_SHARE,
    HALTED,
    MISJUDGED,
    RED_STATION,
    SPEED_FACTOR,
    STANDSTILL,
    STATION,
    STOOD,
    V_DESIRED,
    WAITED_FOR,
    WAY_STATION,
)  # fmt: skip
from studio.world.table.web import ALL_WAY_STOP, END, ENTER, ITS_ENTER, ITS_LEAVE, LANE, LEAVE, OWN_ENTER, OWN_LEAVE, SIGNAL, START, STOP

NOBODY = -1
PATIENCE = 2.0  # [s] that one stands before who has stood longer goes first
HALT, AT_LINE = 0.1, 4.0  # [m/s], [m] slower than this, and so near to a line, one has halted there
FAIR, CRAWL, GENTLE, NEAREST = 10.0, 3.0, 2.0, 1.0  # [s], [m/s], [m/s²], [m] in slow traffic who has waited so long is let in
SLOW, FLOWING = 2.0, 6.0  # [m/s] who drives slower than this behind a junction may leave no room; the second on a ring
WEARY = 60.0  # [s] who has waited for a ring so long comes in where there is room for two
LONG = 15.0  # [m] from the centre of gravity no front is farther
BEHIND = 60.0  # [m] behind oneself others are minded before a lane change
BESIDE, SAFE = 1.0, 3.0  # [m], [m/s²] nearer than this is beside; harder than this nobody is made to brake by a lane change
ELBOW_ROOM = 0.2  # [m] that a driver leaves beside the body
AT_LIGHT = 1.0  # [m] from a line, a stop line is that of its light


@inlined
def waits(v, d, last, own, line, bumper, inside, decided, state, parameter, places, points, path_first, path_count, world, number, entity,
          web, first, place, at, drivers, mind):  # fmt: skip
    """Whether a driver has to wait before a line [m] for those whom he meets on a strand; he minds all of them.

    `inside` says that he is on a way right behind which this strand begins.
    """
    strand, to_line = web.strand[d], line - bumper
    is_way = web.right[strand] != LANE and to_line >= 0.0
    if is_way and mind[RED_STATION, v] <= web.drive[ENTER, d] + AT_LIGHT:
        return True
    must, who = False, NOBODY
    if is_way:
        must = has_to_halt(v, strand, line, to_line, state, web, mind)
        if not must and web.room[strand] > 0:
            who = leaves_no_room(v, d, last, own, world, state, parameter, number, web, first, place, at, drivers, mind)
            must = who != NOBODY
    top = top_speed(v, d, drivers, points, path_first, path_count, web, mind)
    top = min(top, max(careful_speed(v, strand, own, to_line, top, state, parameter, web, drivers, mind), CRAWL))
    for m in range(web.first[strand], web.first[strand + 1]):
        if own + parameter[FRONT, v] - parameter[LENGTH, v] > web.span[OWN_LEAVE, m]:
            continue
        if web.turn[m] >= SHARED:
            if waits_outside(v, d, last, m, own, world, state, parameter, number, entity, web, first, place, at, drivers, mind):
                return True
            continue
        key = world * web.right.size + web.partner[m]
        i, end = from_station(key, earliest(m, web), first, place, at)
        while i < end and place[KEY, i] == key:
            other, there, i = place[WHO, i], at[i], i + 1
            if other != v and meet(
                v, other, m, strand, own, there, to_line, top, inside, state, parameter, places, points, path_first, path_count, number,
                entity, web, drivers, mind,
            ):  # fmt: skip
                must, who = True, number[other]
    return must and is_way and is_held(v, who, line, to_line, decided, state, drivers, mind)


@inlined
def careful_speed(v, strand, own, to_line, top, state, parameter, web, drivers, mind):
    """Speed [m/s] from which v can still stop for those who go first and are hidden yet; with a light, that lets nobody come."""
    if web.right[strand] != LANE and web.right[strand] != SIGNAL:
        nose, late = own + parameter[FRONT, v], max(state[V_X, v], 0.0) * (driver.SETTLING + drivers[EXPECTED, v])
        for m in range(web.first[strand], web.first[strand + 1]):
            to_enter = web.span[OWN_ENTER, m] - nose
            if web.turn[m] != GIVE or to_enter <= 0.0 or not has_corner(m, web):
                continue
            if not is_gone(v, m, to_enter, appears_in(m, to_enter, web), web.fast[m], top, state, parameter, web, drivers, mind):
                left = to_line - driver.STOP_CLOSE if to_line >= 0.0 else to_enter - READY
                mind[CAREFUL, v] = min(mind[CAREFUL, v], ready_speed(left - late, drivers[BRAKE_COMFORT, v]))
    return mind[CAREFUL, v]


@inlined
def earliest(m, web):
    """From which station on [m] who drives on the partner of a strand matters: who gives way only once he has passed his line."""
    if web.turn[m] == NONE:
        return web.span[ITS_ENTER, m] - LONG
    return -LONG if web.turn[m] == TAKE else -inf


@inlined
def is_held(v, who, line, to_line, decided, state, drivers, mind):
    """Whether a driver stops before a line, for `who` if it is for somebody.

    Who would have to brake too hard goes on, but who had `decided` to stop there stays with it.
    """
    speed, gained = state[V_X, v], mind[GAINED, v]
    then, there = driver.foreseen_speed(speed, gained), driver.foreseen_gap(to_line, speed, gained, 0.0, drivers[EXPECTED, v])
    if driver.must_stop(then, there) or (decided == line and driver.can_stop(speed, to_line)):
        mind[WAY_STATION, v], mind[FIRST, v] = line, who
        return True
    return False


@inlined
def has_to_halt(v, strand, line, to_line, state, web, mind):
    """Whether a stop sign still asks for a halt."""
    if web.right[strand] != STOP and web.right[strand] != ALL_WAY_STOP:
        return False
    if to_line < AT_LINE and state[V_X, v] < HALT:
        mind[HALTED, v] = line
    return mind[HALTED, v] != line


@inlined
def leaves_no_room(v, d, last, own, world, state, parameter, number, web, first, place, at, drivers, mind):
    """Who leaves no room behind a way, for those who are on it and for oneself, by his number; who drives there makes room."""
    is_patient, room = mind[STOOD, v] < WEARY, web.room[web.strand[d]]
    needed = (room if is_patient else min(room, 2)) * (parameter[LENGTH, v] + drivers[STANDSTILL, v])
    needed += taken(v, d, own, world, parameter, web, first, place, at, drivers)
    beyond, fast = 0.0, FLOWING if room > 1 and is_patient else SLOW
    for e in range(d + 1, last):
        queue = world * web.right.size + web.strand[e]
        i, end = from_station(queue, -inf, first, place, at)
        while i < end and place[KEY, i] == queue:
            other, nose, i = place[WHO, i], at[i] + parameter[FRONT, place[WHO, i]], i + 1
            if other != v and nose >= 0.0:
                return NOBODY if state[V_X, other] >= fast or beyond + nose - parameter[LENGTH, other] >= needed else number[other]
        beyond += web.drive[END, e] - web.drive[START, e]
        if beyond >= needed:
            return NOBODY
    return NOBODY


@inlined
def taken(v, d, own, world, parameter, web, first, place, at, drivers):
    """What those who are on a way ahead will need behind it [m]."""
    queue, found = world * web.right.size + web.strand[d], 0.0
    i, end = from_station(queue, own, first, place, at)
    while i < end and place[KEY, i] == queue:
        other, nose, i = place[WHO, i], at[i] + parameter[FRONT, place[WHO, i]], i + 1
        if other != v and 0.0 <= nose < web.drive[END, d]:
            found += parameter[LENGTH, other] + drivers[STANDSTILL, other]
    return found


@inlined
def free(v, state, drivers, mind):
    """Acceleration [m/s²] of one whom nobody hinders."""
    speed = max(state[V_X, v], 0.0)
    return max(driver.free_acceleration(speed, mind[V_DESIRED, v], drivers[COMFORT, v], drivers[BRAKE_COMFORT, v]), 0.0)


@inlined
def top_speed(v, d, drivers, points, path_first, path_count, web, mind):
    """Speed [m/s] that v will drive in the middle of a way: its bend permits no more, nor does somebody who drives before it."""
    middle = min(web.drive[ENTER, d] + 0.5 * web.drive[END, d], (path_count - 1.001) * PATH_SPACING)
    permitted = drivers[SPEED_FACTOR, v] * interpolate(points, path_first, PATH_SPEED, middle)
    return max(min(permitted, mind[FOLLOW_SPEED, v]) if mind[FOLLOW_GAP, v] < LONG else permitted, CRAWL)


@inlined
def slow_arrival(v, distance, top, state, drivers, mind):
    """When v is `distance` [m] on at the latest [s], if it drives as slowly as its bend asks for already, once v has answered."""
    return arrival_below(distance, max(state[V_X, v], 0.0), free(v, state, drivers, mind), top) + drivers[EXPECTED, v]


@inlined
def comes_in(v, distance, state, drivers, mind):
    """When one is `distance` [m] on [s], if nobody hinders him."""
    return arrival(distance, max(state[V_X, v], 0.0), free(v, state, drivers, mind))


# -- two who meet ----------------------------------------------------------------------------------


@inlined
def meet(v, other, m, strand, own, there, to_line, top, inside, state, parameter, places, points, path_first, path_count, number, entity,
         web, drivers, mind):  # fmt: skip
    """What one who comes where two strands meet means for v; whether v has to wait for him before the line."""
    nose, its_nose = own + parameter[FRONT, v], there + parameter[FRONT, other]
    its_tail = its_nose - parameter[LENGTH, other]
    enter, its_enter, its_leave = web.span[OWN_ENTER, m], web.span[ITS_ENTER, m], web.span[ITS_LEAVE, m]
    if its_tail > its_leave or is_unseen(v, other, state, parameter, drivers):
        return False
    if its_nose < its_enter:
        is_seen = web.turn[m] == NONE or not is_hidden(m, enter - nose, its_enter - its_nose, web)
        return is_seen and nose < enter and lets_go(
            v, other, m, strand, enter - nose, its_enter - its_nose, its_nose, to_line, top, state, parameter, number, entity, web, drivers,
            mind,
        )  # fmt: skip
    if web.shape[m] == ALONG:
        mine, its = together(m, web)
        if its_nose - its > nose - mine:
            lead(
                v, other, its_tail - its - (nose - mine), state[V_X, other], state, parameter, places, points, path_first, path_count,
                number, drivers, mind,
            )  # fmt: skip
        return False
    if nose >= enter:
        if (
            web.turn[m] != NONE
            and is_less_far(v, other, nose - enter, its_nose - its_enter, entity)
            and not stands_aside(v, other, 0.0, parameter, places, points, path_first, path_count, mind)
        ):
            follow(v, number[other], 0.0, 0.0, state, drivers, mind)
        return False
    gone = leaves_in(other, its_leave - its_tail, state) + AFTER
    if gone < comes_in(v, enter - nose, state, drivers, mind):
        return False
    stands = state[V_X, other] < STANDING and mind[STOOD, other] > PATIENCE  # who sets off again may come in the way
    if stands and stands_aside(v, other, enter - nose, parameter, places, points, path_first, path_count, mind):
        return False
    let_across(v, other, enter - nose, gone, state, parameter, places, points, path_first, path_count, number, drivers, mind)
    return web.turn[m] != NONE and not inside


@inlined
def is_less_far(v, other, own_way, its_way, entity):
    """Whether v, of two who have come onto a place at once, has come less far onto it: then the other leaves first."""
    return own_way < its_way or (own_way == its_way and entity[v] > entity[other])


@inlined
def let_across(v, other, gap, gone, state, parameter, places, points, path_first, path_count, number, drivers, mind):
    """Somebody is on a place `gap` [m] ahead, and will be gone after so long [s]: v follows one who would be there just then."""
    follow(v, number[other], gap, gap / gone, state, drivers, mind)
    e = rear_offset(other, mind[STATION, v] + parameter[FRONT, v] + gap, places, points, path_first, path_count)
    if is_in_the_way(v, other, e, parameter):
        is_ahead(v, other, number[other], gap, 0.0, e, parameter, mind)


@inlined
def together(m, web):
    """A place [m] on either strand where they are one: where they part, else where they have run together."""
    if web.turn[m] == NONE:
        return web.span[OWN_ENTER, m], web.span[ITS_ENTER, m]
    return web.span[OWN_LEAVE, m], web.span[ITS_LEAVE, m]


@inlined
def lead(v, other, gap, speed, state, parameter, places, points, path_first, path_count, number, drivers, mind):
    """Somebody is ahead where strands meet: he is followed, and if he is in the way he is who is ahead. Who stands beside is passed."""
    rear = mind[STATION, v] + parameter[FRONT, v] + gap
    e = rear_offset(other, rear, places, points, path_first, path_count)
    is_in = is_in_the_way(v, other, e, parameter)
    if gap > 0.0 or is_in or state[V_X, other] > STANDING or not is_clear(
        v, other, rear + parameter[LENGTH, other], parameter, places, points, path_first, path_count
    ):  # fmt: skip
        follow(v, number[other], gap, speed, state, drivers, mind)
    if gap > 0.0 and is_in:
        is_ahead(v, other, number[other], gap, speed, e, parameter, mind)


@inlined
def is_clear(v, other, s_guess, parameter, places, points, path_first, path_count):
    """Whether the front of another leaves room for the own body."""
    x = places[REAR_X, other] + parameter[LENGTH, other] * places[COS, other]
    y = places[REAR_Y, other] + parameter[LENGTH, other] * places[SIN, other]
    _, e = project(points, path_first, path_count, x, y, s_guess)
    return abs(e) > 0.5 * (parameter[WIDTH, v] + parameter[WIDTH, other]) + ELBOW_ROOM


@inlined
def stands_aside(v, other, gap, parameter, places, points, path_first, path_count, mind):
    """Whether the whole body of another, who is on a place `gap` [m] ahead, is beside the strip that v will sweep, on one side of it."""
    guess, clear = mind[STATION, v] + parameter[FRONT, v] + gap, 0.5 * (parameter[WIDTH, v] + parameter[WIDTH, other]) + ELBOW_ROOM
    x, y = places[REAR_X, other], places[REAR_Y, other]
    ahead_x, ahead_y = x + parameter[LENGTH, other] * places[COS, other], y + parameter[LENGTH, other] * places[SIN, other]
    _, rear = project(points, path_first, path_count, x, y, guess)
    _, front = project(points, path_first, path_count, ahead_x, ahead_y, guess)
    return min(abs(rear), abs(front)) > clear and rear * front > 0.0


@inlined
def leaves_in(other, distance, state):
    """When somebody has left a place with as much as `distance` [m] to drive [s]."""
    return distance / max(state[V_X, other], STANDING)


@inlined
def lets_go(v, other, m, strand, to_enter, its_way, its_nose, to_line, top, state, parameter, number, entity, web, drivers, mind):
    """What one means who is not there yet, `its_way` [m] before it; whether v has to wait for him before the line."""
    red = mind[RED_STATION, other] - mind[STATION, other] - parameter[FRONT, other]
    turn, partner = web.turn[m], web.partner[m]
    is_committed = web.right[partner] == LANE or its_nose > 0.0
    if red <= its_way or (turn == TAKE and not is_committed):
        return False
    if turn == NONE:
        if sets_off_before(v, other, its_way, state, drivers, mind):
            follow(v, number[other], to_enter, 0.0, state, drivers, mind)
        return False
    its_time = mind[MISJUDGED, v] * comes_in(other, its_way, state, drivers, mind)
    at_light = web.right[strand] == SIGNAL
    is_late = decides_again(v, other, m, strand, to_enter, to_line, state, web)
    if turn == GIVE and (to_line >= 0.0 or at_light or is_late):
        if has_time(v, other, m, strand, to_enter, its_way, its_time, to_line, top, state, parameter, number, entity, web, drivers, mind):
            return False
        if is_late and is_gone(v, m, to_enter, its_time, state[V_X, other], top, state, parameter, web, drivers, mind):
            return False
        if at_light or is_late:
            follow(v, number[other], to_enter, 0.0, state, drivers, mind)
        return not (at_light or is_late)
    if web.right[strand] == ALL_WAY_STOP and to_line >= 0.0 and not is_committed:
        return state[V_X, other] < STANDING and has_stood_longer(other, v, entity, mind)
    return comes_first(v, other, m, to_enter, its_way, its_time, to_line, state, parameter, number, entity, web, drivers, mind)


@inlined
def decides_again(v, other, m, strand, to_enter, to_line, state, web):
    """Whether v, beyond its line, decides once more before it comes in somebody's way, where it can still stop: a corner has let it see
    no sooner, or it has come to a stand there behind somebody, and the other drives. Of two who stand there, none waits for the other."""
    may = has_corner(m, web) or state[V_X, v] < STANDING <= state[V_X, other]
    return to_line < 0.0 and web.right[strand] != LANE and may and driver.can_stop(state[V_X, v], to_enter - READY)


@inlined
def sets_off_before(v, other, its_way, state, drivers, mind):
    """Whether v stands, and one who comes would have to brake too hard if v set off into his way; who has waited for long does."""
    if state[V_X, v] >= STANDING or state[V_X, other] <= CRAWL or mind[STOOD, v] > PATIENT:
        return False
    then = driver.foreseen_speed(state[V_X, other], mind[GAINED, other])
    there = driver.foreseen_gap(its_way, state[V_X, other], mind[GAINED, other], 0.0, drivers[EXPECTED, other])
    return not driver.must_stop(then, there)


@inlined
def has_stood_longer(v, other, entity, mind):
    """Whether one has stood longer than another; of those who came to stand together it is the first by lot."""
    return mind[STOOD, v] > mind[STOOD, other] or (mind[STOOD, v] == mind[STOOD, other] and entity[v] < entity[other])


@inlined
def goes_before(v, other, entity, mind):
    """Of two who have stood a while, whether v has stood longer."""
    return mind[STOOD, other] > PATIENCE and has_stood_longer(v, other, entity, mind)


@inlined
def is_held_by(v, other, number, mind):
    """Whether another who has long had the right to go waits for v: v stands in his way, and is the one who has to go."""
    return mind[WAITED_FOR, other] == number[v] and min(mind[STOOD, v], mind[STOOD, other]) > FAIR


@inlined
def has_time(v, other, m, strand, to_enter, its_way, its_time, to_line, top, state, parameter, number, entity, web, drivers, mind):
    """Whether v may go before one who goes first: he is far enough, he will be gone, or he stands and lets v go."""
    if state[V_X, other] < STANDING and (goes_before(v, other, entity, mind) or is_held_by(v, other, number, mind)):
        return True
    if mind[STOOD, v] > FAIR and is_crawling(other, its_way, state):
        return True
    length = web.span[ITS_LEAVE, m] - web.span[ITS_ENTER, m] + parameter[LENGTH, other]
    if its_time + leaves_in(other, length, state) + AFTER < comes_in(v, to_enter, state, drivers, mind):
        return True
    own_time = slow_arrival(v, to_enter, top, state, drivers, mind)
    a, to_wait = free(v, state, drivers, mind), max(to_line - driver.STOP_CLOSE, 0.0)
    across = web.span[OWN_LEAVE, m] + parameter[LENGTH, v]
    lag = its_time - arrival_below(to_wait, max(state[V_X, v], 0.0), a, top)
    return is_enough(
        lag, wanted_gap(drivers[GAP_SHARE, v] * web.critical[strand], mind[STOOD, v]), across, state[V_X, v], drivers[COMFORT, v]
    ) and is_safe(v, m, to_enter, its_time, state[V_X, other], own_time, a, top, state, parameter, web, drivers)


@inlined
def is_safe(v, m, to_enter, its_time, its_speed, own_time, a, top, state, parameter, web, drivers):
    """Whether v has left before one comes; where lines run together, whether he need not brake hard behind v."""
    speed = max(state[V_X, v], 0.0)
    if web.shape[m] == ALONG:
        return its_time > own_time + merging_headway(its_speed, sqrt(speed * speed + 2.0 * a * max(to_enter, 0.0)))
    way = to_enter + web.span[OWN_LEAVE, m] - web.span[OWN_ENTER, m] + parameter[LENGTH, v]
    return its_time > arrival_below(way, speed, a, top) + drivers[EXPECTED, v] + AFTER


@inlined
def is_gone(v, m, to_enter, its_time, its_speed, top, state, parameter, web, drivers, mind):
    """The same of one who comes with a speed [m/s] and whom v does not let go before for his comfort."""
    own_time = slow_arrival(v, to_enter, top, state, drivers, mind)
    return is_safe(v, m, to_enter, its_time, its_speed, own_time, free(v, state, drivers, mind), top, state, parameter, web, drivers)


@inlined
def is_crawling(other, its_way, state):
    """Whether one drives so slowly, and is so far yet, that he lets somebody in who has waited for long."""
    speed = max(state[V_X, other], 0.0)
    return speed < CRAWL and its_way > NEAREST + speed * speed / (2.0 * GENTLE)


@inlined
def comes_first(v, other, m, to_enter, its_way, its_time, to_line, state, parameter, number, entity, web, drivers, mind):
    """Of two of whom none has to wait, who is there first goes first; whether v has to wait for the other before the line."""
    own_time = comes_in(v, to_enter, state, drivers, mind)
    is_first = state[V_X, other] <= STANDING or its_time > own_time or (its_time == own_time and entity[v] < entity[other])
    if is_first and not sets_off_before(v, other, its_way, state, drivers, mind):
        return False
    if web.shape[m] == ALONG:
        if web.turn[m] == EQUAL and state[V_X, v] < CRAWL:  # he moves up to where the ways run together, and takes his turn there
            follow(v, number[other], to_enter, 0.0, state, drivers, mind)
        else:
            let_in(v, number[other], to_enter - its_way - parameter[LENGTH, other], state[V_X, other], state, drivers, mind)
        return False
    length = web.span[ITS_LEAVE, m] - web.span[ITS_ENTER, m] + parameter[LENGTH, other]
    if its_time + leaves_in(other, length, state) + AFTER < own_time:
        return False
    if to_line < 0.0:
        follow(v, number[other], to_enter, 0.0, state, drivers, mind)
    return True


# -- changing lanes --------------------------------------------------------------------------------


@inlined
def lane_under(d, drive_first, web):
    """The drive on which one still is where another one begins beside it; below the first where there is none."""
    e = d - 1
    while e >= drive_first and web.drive[LEAVE, e] <= web.drive[ENTER, d]:
        e -= 1
    return e


@inlined
def lead_on(key, v, other, own, first, place, at):
    """How far [m] v, at a station, is ahead of another in a queue; not a number where he is not in it."""
    i, end = from_station(key, own - BEHIND, first, place, at)
    while i < end and place[KEY, i] == key and at[i] < own + BEHIND:
        if place[WHO, i] == other:
            return own - at[i]
        i += 1
    return nan


@inlined
def has_to_let_pass(v, own, enter, decided, key, here, own_here, state, parameter, number, entity, first, place, at, drivers, mind):
    """Whether v has to wait where it would change to a lane, since somebody there is beside it, or comes from behind too fast.

    Whoever is ahead there is followed as one who goes first; so is who is beside it, when it is too fast to stop. Of two who stand and
    would each come onto the lane of the other, in whose queue `here` he is, that one goes who is ahead on both lanes together: the
    stations of two lanes do not quite agree, and each may be ahead, or behind, on that of the other.
    """
    nose, tail, who = own + parameter[FRONT, v], own + parameter[FRONT, v] - parameter[LENGTH, v], NOBODY
    beside, lead = NOBODY, 0.0
    i, end = from_station(key, own - BEHIND, first, place, at)
    while i < end and place[KEY, i] == key:
        other, there, is_there, i = place[WHO, i], at[i], place[THERE, i], i + 1
        if other == v or is_there == 0:
            continue
        its_nose = there + parameter[FRONT, other]
        stand = min(mind[STOOD, v], mind[STOOD, other]) > PATIENCE and state[V_X, other] < STANDING
        lead_here = lead_on(here, v, other, own_here, first, place, at) if stand else nan
        if abs(lead_here) < parameter[LENGTH, v]:
            both = own - there + lead_here
            if both < 0.0 or (both == 0.0 and entity[v] > entity[other]):
                who = number[other]
            continue
        if there > own:
            gap = its_nose - parameter[LENGTH, other] - nose
            let_in(v, number[other], gap, state[V_X, other], state, drivers, mind)
            who = number[other] if gap < BESIDE else who
            break
        if stand:
            continue  # who stands there and is behind lets one in who has stood as well
        if tail - its_nose < BESIDE:
            who, beside, lead = number[other], other, its_nose - parameter[LENGTH, other] - nose
        elif behind(other, tail - its_nose, state[V_X, v], state, drivers, mind) < -SAFE:
            who = number[other]
    if who == NOBODY or is_held(v, who, enter, enter - mind[STATION, v] - parameter[FRONT, v], decided, state, drivers, mind):
        return who != NOBODY
    if beside != NOBODY:
        let_in(v, number[beside], lead, state[V_X, beside], state, drivers, mind)
    return False


@inlined
def is_none_to_follow(v, other, gap, is_over, state, parameter, places, points, path_first, path_count, number, entity, mind):
    """Whether v need not follow somebody beside it, whose rear is not ahead: the front of v is not yet on his lane, or he waits for v.

    Of two who have come onto the lanes of each other at once, and have stood for long, one goes where the other leaves room.
    """
    if gap >= 0.0:
        return False
    if (is_over and mind[STOOD, v] > PATIENCE) or is_held_by(v, other, number, mind):
        return True
    stand = min(mind[STOOD, v], mind[STOOD, other]) > WEARY and state[V_X, other] < STANDING
    front = mind[STATION, v] + parameter[FRONT, v] + gap + parameter[LENGTH, other]
    return stand and entity[v] < entity[other] and is_clear(v, other, front, parameter, places, points, path_first, path_count)
