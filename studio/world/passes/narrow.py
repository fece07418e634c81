"""Narrow streets: two directions share the ground of one lane, and drivers pass it one after the other.

Who is outside waits before it begins

    for everybody who comes towards him on it
    and for who is the first of those that come towards him, and goes first:
        who can no longer stop before who still can
        who has stood long, or of two who stand, before who has stood less
        whom a sign gives the right, before the other
        who is there sooner, and of two at once the first by lot

Who follows another of his direction who is still on it goes on, until somebody on the other side has stood for long. All this hangs on what
everybody can see of the other at the tick's beginning and is the same from either side, so that never both go, and never neither.

Nobody goes on while there is no room for him behind it, so that who comes out of the next such street finds this one free; who waits for
that is not waited for.
"""

from math import inf

from studio.compiled import inlined
from studio.model import driver
from studio.model.passage import arrival
from studio.road.ways.conflict import SHARED, SHARED_FIRST
from studio.vehicle.parameter import FRONT, LENGTH
from studio.vehicle.state import V_X
from studio.world.passes.queue import KEY, THERE, WHO, from_station
from studio.world.passes.regard import follow, is_unseen
from studio.world.table.mind import (
    BRAKE_COMFORT,
    COMFORT,
    FIRST,
    STANDSTILL,
    STATION,
    STOOD,
    V_DESIRED,
    WAITED_FOR,
    WAY_STATION,
)  # fmt: skip
from studio.world.table.web import END, ITS_ENTER, ITS_LEAVE, OWN_ENTER, OWN_LEAVE, START

NOBODY = -1
STANDING, PATIENCE, LONG = 0.5, 2.0, 15.0  # [m/s], [s], [s] slower one stands; stood so long one is minded, and so long followers wait
FLOWING = 2.0  # [m/s] who drives so fast behind the ground makes room
NEAR_LINE = 4.0  # [m] who stands so near to the ground waits for it


@inlined
def waits_outside(v, d, last, m, own, world, state, parameter, number, entity, web, first, place, at, drivers, mind):
    """Whether a driver has to wait before ground that his lane shares with that of the other direction; if so, that is where he stops."""
    to_enter = web.span[OWN_ENTER, m] - own - parameter[FRONT, v]
    key, own_key = world * web.right.size + web.partner[m], world * web.right.size + web.strand[d]
    on_it, next_one, left = NOBODY, NOBODY, inf
    i, end = from_station(key, -inf, first, place, at)
    while i < end and place[KEY, i] == key:
        other, nose, there, i = place[WHO, i], at[i] + parameter[FRONT, place[WHO, i]], place[THERE, i], i + 1
        if other == v or nose - parameter[LENGTH, other] > web.span[ITS_LEAVE, m] or is_unseen(v, other, state, parameter, drivers):
            continue
        if nose >= web.span[ITS_ENTER, m]:
            on_it = other
            face(v, other, to_enter, nose, m, state, number, web, drivers, mind)
        elif there == 1 or state[V_X, other] > STANDING:  # who stands before the street stands there for somebody else
            next_one, left = other, web.span[ITS_ENTER, m] - nose
    if to_enter < 0.0:
        return False
    who = (
        number[on_it]
        if on_it != NOBODY
        else in_the_way_behind(v, d, last, m, own, world, state, parameter, number, web, first, place, at, drivers)
    )
    if who == NOBODY and next_one != NOBODY and is_first(
        v, next_one, m, own, own_key, to_enter, left, state, parameter, number, entity, web, first, place, at, drivers, mind
    ):  # fmt: skip
        who = number[next_one]
    if who != NOBODY:
        mind[WAY_STATION, v], mind[FIRST, v] = mind[STATION, v] + parameter[FRONT, v] + to_enter, who
    return who != NOBODY


@inlined
def is_first(v, other, m, own, own_key, to_enter, left, state, parameter, number, entity, web, first, place, at, drivers, mind):
    """Whether the first of those who come towards v goes first."""
    if goes_before(v, other, web.turn[m], to_enter, left, state, entity, drivers, mind):
        return False
    leader = led_on(v, m, own, own_key, parameter, web, first, place, at)
    waits_for = mind[WAITED_FOR, other]
    if (
        state[V_X, other] < STANDING
        and waits_for != NOBODY
        and waits_for != number[v]
        and (leader == NOBODY or waits_for != number[leader])
    ):
        return False
    return leader == NOBODY or (mind[STOOD, other] > LONG and can_stop(v, to_enter, state))


@inlined
def face(v, other, to_enter, its_nose, m, state, number, web, drivers, mind):
    """Two who are on it together, since they began there: they stop before each other."""
    gap = web.span[OWN_LEAVE, m] - web.span[OWN_ENTER, m] + to_enter - (its_nose - web.span[ITS_ENTER, m])
    if to_enter < 0.0 < gap:
        follow(v, number[other], 0.5 * gap, 0.0, state, drivers, mind)


@inlined
def led_on(v, m, own, own_key, parameter, web, first, place, at):
    """Who of the own direction drives ahead and is still on the ground."""
    i, end = from_station(own_key, own, first, place, at)
    while i < end and place[KEY, i] == own_key:
        leader, nose, is_there, i = place[WHO, i], at[i] + parameter[FRONT, place[WHO, i]], place[THERE, i], i + 1
        if leader != v and is_there == 1 and nose - parameter[LENGTH, leader] <= web.span[OWN_LEAVE, m]:
            return leader if nose >= web.span[OWN_ENTER, m] else NOBODY
    return NOBODY


@inlined
def in_the_way_behind(v, d, last, m, own, world, state, parameter, number, web, first, place, at, drivers):
    """Who leaves no room behind the ground for v and those before him, by his number; who drives there makes room."""
    room, needed = web.drive[END, d] - web.span[OWN_LEAVE, m], parameter[LENGTH, v] + drivers[STANDSTILL, v]
    key = world * web.right.size + web.strand[d]
    i, end = from_station(key, own, first, place, at)
    while i < end and place[KEY, i] == key:
        other, nose, i = place[WHO, i], at[i] + parameter[FRONT, place[WHO, i]], i + 1
        if other != v and nose < web.drive[END, d]:
            needed += parameter[LENGTH, other] + drivers[STANDSTILL, other]
    for e in range(d + 1, last):
        if room >= needed:
            return NOBODY
        key = world * web.right.size + web.strand[e]
        i, end = from_station(key, -inf, first, place, at)
        while i < end and place[KEY, i] == key:
            other, nose, i = place[WHO, i], at[i] + parameter[FRONT, place[WHO, i]], i + 1
            if other != v and nose >= 0.0:
                return NOBODY if state[V_X, other] >= FLOWING or room + nose - parameter[LENGTH, other] >= needed else number[other]
        room += web.drive[END, e] - web.drive[START, e]
    return NOBODY


@inlined
def can_stop(v, distance, state):
    """Whether one can still stop before a place without braking hard."""
    return driver.must_stop(max(state[V_X, v], 0.0), distance)


@inlined
def goes_before(v, other, turn, own_way, its_way, state, entity, drivers, mind):
    """Whether v goes first of two who are as far as this from ground that they share [m]."""
    mine, its = can_stop(v, own_way, state), can_stop(other, its_way, state)
    if mine != its:
        return its
    stood, its_stood = waited(v, own_way, mind), waited(other, its_way, mind)
    if stood != its_stood and (min(stood, its_stood) > PATIENCE or max(stood, its_stood) > LONG):
        return stood > its_stood
    if turn != SHARED:
        return turn == SHARED_FIRST
    own_time, its_time = comes(v, own_way, state, drivers, mind), comes(other, its_way, state, drivers, mind)
    return own_time < its_time or (own_time == its_time and entity[v] < entity[other])


@inlined
def waited(v, way, mind):
    """How long one has stood before the ground [s]; elsewhere he stands for something else."""
    return mind[STOOD, v] if way < NEAR_LINE else 0.0


@inlined
def comes(v, distance, state, drivers, mind):
    """When one is there [s], if nobody hinders him."""
    speed = max(state[V_X, v], 0.0)
    free = driver.free_acceleration(speed, mind[V_DESIRED, v], drivers[COMFORT, v], drivers[BRAKE_COMFORT, v])
    return arrival(distance, speed, max(free, 0.0))
