"""Entry: cars come in where their ways begin, traffic that has arrived and those of flows that are due, as soon as there is room.

There is room when whoever is last on the first lane is as far ahead as a driver wants it (model/driver.py), at the speed with which one
comes in: the one that is permitted, so that one can stop in comfort at the end of that lane, and behind somebody that from which one comes
down to his speed with a gentle braking before one is at the wanted gap.
"""

from math import inf, sqrt

from studio.compiled import inlined, lean
from studio.model import driver
from studio.road.ways.path import PATH_HEADING, PATH_SPEED, PATH_X, PATH_Y
from studio.vehicle.parameter import FRONT, LENGTH
from studio.vehicle.shift import start
from studio.vehicle.state import ACTIVE, V_X
from studio.world.passes.ground import touch_all
from studio.world.passes.queue import KEY, THERE, WHO, from_station
from studio.world.table.mind import EXPECTED, HEADWAY, SPEED_FACTOR, STANDSTILL, STATION, STOOD
from studio.world.table.web import ENTER, ITS_ENTER, ITS_LEAVE, OWN_ENTER, START

COMFORT, GENTLE = 2.0, 1.0  # [m/s²] braking at the end of the first lane; behind somebody
MOMENT = 4.0  # [s]
FAR = 100.0  # [m] nobody beyond is minded
NOT_YET = -1.0  # [s] of one who has not come in


@lean
def let_in(returns, removed, column, cars, due_first, due, gone, came, points, path_first, path_count, raised, drive_first,
           drive_count, web, world_of, first, place, at, entered, drivers, state, wheels, ground, parameter, gears, mind, now):  # fmt: skip
    """Fifth pass: who has arrived comes in again, then who is due."""
    count = 0
    for v in range(returns.size):
        if returns[v] != 0 and state[ACTIVE, v] == 0.0:
            count += enter(
                v, count, points, path_first, path_count, raised, drive_first, drive_count, web, world_of, first, place, at, entered,
                drivers, state, wheels, ground, parameter, gears, mind,
            )  # fmt: skip
    for i in range(gone.size):
        if due_first[i] + gone[i] == due_first[i + 1] or due[due_first[i] + gone[i]] > now:
            continue
        v = outside(column[i], cars[i], gone[i], removed, state)
        if v >= 0 and enter(
            v, count, points, path_first, path_count, raised, drive_first, drive_count, web, world_of, first, place, at, entered, drivers,
            state, wheels, ground, parameter, gears, mind,
        ):  # fmt: skip
            came[v] = now - due[due_first[i] + gone[i]]
            gone[i] += 1
            count += 1


@inlined
def outside(first, count, turn, removed, state):
    """The car of a source that has been outside for longest, as they come in by turns; -1 when all are about."""
    for i in range(count):
        v = first + (turn + i) % count
        if state[ACTIVE, v] == 0.0 and removed[v] == 0:
            return v
    return -1


@lean
def enter(v, count, points, path_first, path_count, raised, drive_first, drive_count, web, world_of, first, place, at, entered, drivers,
          state, wheels, ground, parameter, gears, mind):  # fmt: skip
    """Whether v has come in, behind whoever is last there and has not come in just now."""
    queue = world_of[v] * web.right.size + web.strand[drive_first[v]]
    for i in range(count):
        if world_of[entered[i]] * web.right.size + web.strand[drive_first[entered[i]]] == queue:
            return False
    p = path_first[v]
    permitted = drivers[SPEED_FACTOR, v] * points[PATH_SPEED, p]
    gap, other = last_there(v, world_of[v], drive_first[v], drive_count[v], web, first, place, at, parameter)
    speed = min(permitted, lane_speed(v, drive_first[v], drive_count[v], web, parameter, drivers))
    if gap < inf:
        speed = min(speed, speed_behind(gap, max(state[V_X, other], 0.0), drivers[STANDSTILL, v], drivers[HEADWAY, v]))
    if speed < 0.0 or is_crossed(
        v, world_of[v], drive_first[v], drive_count[v], web, first, place, at, state, parameter, drivers[STANDSTILL, v]
    ):
        return False
    if raised[v] != 0:
        touch_all(v, state.shape[1], 0.0, points, p, path_count[v], ground)
    start(v, points[PATH_X, p], points[PATH_Y, p], points[PATH_HEADING, p], speed, state, wheels, ground, parameter, gears)
    mind[STATION, v] = mind[STOOD, v] = 0.0
    entered[count] = v
    return True


@inlined
def last_there(v, world, drive, count, web, first, place, at, parameter):
    """Gap [m] to the last who drives where v will, and who that is; infinite when there is nobody near."""
    for d in range(drive, drive + count):
        enter, queue = web.drive[ENTER, d], world * web.right.size + web.strand[d]
        if enter > FAR:
            break
        i, end = from_station(queue, -inf, first, place, at)
        while i < end and place[KEY, i] == queue:
            other, there, i = place[WHO, i], at[i] - web.drive[START, d], i + 1
            if other != v and place[THERE, i - 1] != 0:
                return enter + there + parameter[FRONT, other] - parameter[LENGTH, other] - parameter[FRONT, v], other
    return inf, v


@inlined
def is_crossed(v, world, drive, count, web, first, place, at, state, parameter, s_0):
    """Whether somebody is, or will be in a moment, where his way meets the place on which v would stand."""
    for d in range(drive, drive + count):
        if web.drive[ENTER, d] > parameter[LENGTH, v]:
            break
        for m in range(web.first[web.strand[d]], web.first[web.strand[d] + 1]):
            if web.drive[ENTER, d] + web.span[OWN_ENTER, m] > parameter[LENGTH, v]:
                continue
            queue = world * web.right.size + web.partner[m]
            i, end = from_station(queue, -inf, first, place, at)
            while i < end and place[KEY, i] == queue:
                other, nose, i = place[WHO, i], at[i] + parameter[FRONT, place[WHO, i]], i + 1
                comes = nose + s_0 + MOMENT * max(state[V_X, other], 0.0) > web.span[ITS_ENTER, m]
                if other != v and comes and nose - parameter[LENGTH, other] < web.span[ITS_LEAVE, m] + s_0:
                    return True
    return False


@inlined
def speed_behind(gap, v, s_0, T):
    """Speed u [m/s] with which one comes in behind somebody with v: u²= v² + 2 b (gap - s_0 - v T); below zero when there is no room."""
    room = gap - s_0 - v * T
    return sqrt(v * v + 2.0 * GENTLE * room) if room >= 0.0 else -1.0


@inlined
def lane_speed(v, d, count, web, parameter, drivers):
    """Speed [m/s] from which one can stop in comfort at the end of the first lane, once one has answered."""
    if count < 2:
        return inf
    t, room = drivers[EXPECTED, v], max(web.drive[ENTER, d + 1] - parameter[FRONT, v] - driver.STOP_CLOSE, 0.0)
    return COMFORT * (sqrt(t * t + 2.0 * room / COMFORT) - t)
