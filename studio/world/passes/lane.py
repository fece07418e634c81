"""Lanes: who changes to another one, and how he goes over. Two passes: who goes over now, and who will want to at the next tick.

worth it     MOBIL (model/lane_change.py): at every `EVERY` a driver looks at the lanes beside his own that lead where he wants to go;
             outside towns the one nearer to the kerb is worth something by itself
in time      a lane that is left again, since it ends, leads elsewhere or is closed, is not taken within twice the `HORIZON` of that;
             within it who is on one goes back as soon as that is safe
somebody     who stands though nothing keeps him is passed: one keeps `ROOM` behind him, and goes over as soon as that is safe
going over   a driver is on his new line at once, and follows it at a distance that shrinks; until his body has left the old lane
             he stands in its queue too, and minds who is ahead there and in his way
then         for `REST` he stays
"""

from math import inf

from studio.compiled import inlined, lean
from studio.model.lane_change import DURATION, gone_over, incentive, left_over
from studio.road.ways.path import PATH_SPACING, project
from studio.vehicle.parameter import FRONT, LENGTH, WIDTH
from studio.vehicle.state import ACTIVE, V_X, X, Y
from studio.world.passes.junction import STANDING
from studio.world.passes.neighbour import REAR_X, REAR_Y
from studio.world.passes.queue import KEY, THERE, WHO, bucket_of, first_drive, from_station, station_on
from studio.world.passes.regard import behind, follow, is_unseen
from studio.world.table.lane import HERE_BACK, HERE_FROM, HERE_TO, STEP, THERE_BACK, THERE_FROM, THERE_TO, TO
from studio.world.table.mind import (
    ASIDE,
    ASIDE_FROM,
    AWAY,
    BESIDE,
    CHANGED,
    CHANGING,
    FOLLOWING,
    GAIN,
    GAP,
    IDLED,
    IMPOSED,
    KEEP_SIDE,
    LEFT_BY,
    MISJUDGED,
    OFFSET,
    OUT_BY,
    POLITENESS,
    RED_STATION,
    STATION,
    STOPPING,
    V_DESIRED,
    WAY_STATION,
    YIELDING,
)  # fmt: skip
from studio.world.table.street import (
    ACTING,
    LINE_COUNT,
    LINE_DRIVE,
    LINE_DRIVES,
    LINE_FIRST,
    LINE_OBJECT,
    LINE_OBJECTS,
    LINE_STOP,
    LINE_STOPS,
)  # fmt: skip
from studio.world.table.web import ENTER, LEAVE

EVERY = 0.5  # [s]
REST, SOON = 6.0, 2.0  # [s] after a change until one is worth it again; until one is needed
HORIZON, LEAST = 10.0, 60.0  # [s], [m] before a lane is left again
STAYING = 2.0  # times as far one wants to stay on it
AHEAD, LOOKING, BACK = 100.0, 2.0, 150.0  # [m], [m/s²], [m] others are looked for so far: AHEAD + v²/LOOKING, and behind
TOWN = 60.0 / 3.6  # [m/s] where no more is allowed, lanes are chosen freely (StVO § 7 (3))
OUT_OF = 0.8  # [m] from the new line, a body has left the old lane
BODY = 0.3  # [m] beside another that one passes in going over
NEAREST = 1.0  # [m] bumper to bumper, before and behind
ROOM, NEAR, SLOW = 9.0, 8.0, 3.0  # [m], [m], [m/s] what is kept behind one who stands; less is not enough to go over behind one so slow
LONG, GOES = 1.5, 0.3  # [s], [m/s²] who stands longer though he could drive on so is passed
PAST = 25.0  # [m] behind one who stands one may have to be back
APART = 60.0  # [m] of two who change near each other one waits
TURN = 5.0  # [m] a place on the other line is looked for so far


# -- going over --------------------------------------------------------------------------------------


@lean
def go_over(tick, state, asked, block, left_first, left_count, beside, phase, points, path_first, path_count, stop_first, stop_count,
            sweep_first, sweep_count, drive_first, drive_count, base, work, choice, mind):  # fmt: skip
    """Who wanted to change lanes takes the other line; who is on the way over goes on."""
    for v in range(state.shape[1]):
        if beside.home[v] < 0:
            continue
        mind[CHANGED, v] += tick
        shift(v, tick, state, left_count, mind)
        gate, asked[v] = asked[v], -1
        if state[ACTIVE, v] == 0.0:
            continue
        if gate < 0 and block[v] != beside.home[v]:
            gate = way_home(mind[STATION, v], block[v], beside)
        if gate < 0:
            continue
        if beside.gate[STEP, gate] != 0.0:
            left_first[v], left_count[v] = drive_first[v], drive_count[v]
        take(
            v, int(beside.gate[TO, gate]), block, beside, phase, path_first, path_count, stop_first, stop_count, sweep_first, sweep_count,
            drive_first, drive_count, base, work, choice,
        )  # fmt: skip
        begin(v, there(mind[STATION, v], gate, beside), state, points, path_first[v], path_count[v], mind)


@inlined
def way_home(station, b, beside):
    """The gate through which one is on the usual lanes, where the own line has come back to them; -1 where it has not."""
    for gate in range(beside.first[b], beside.first[b] + beside.count[b]):
        if beside.gate[STEP, gate] == 0.0 and beside.gate[HERE_FROM, gate] <= station <= beside.gate[HERE_TO, gate]:
            return gate
    return -1


@inlined
def shift(v, tick, state, left_count, mind):
    """A tick of the way over; the old lane is left once the body is out of it."""
    if mind[CHANGING, v] < 1.0:
        mind[CHANGING, v] = gone_over(mind[CHANGING, v], state[V_X, v], tick)
        mind[ASIDE, v] = mind[ASIDE_FROM, v] * left_over(mind[CHANGING, v])
    if mind[CHANGING, v] == 1.0 or abs(mind[OFFSET, v]) < OUT_OF:
        left_count[v] = 0


@inlined
def there(station, gate, beside):
    """A station [m] of the own line on the other one."""
    enter, leave = beside.gate[HERE_FROM, gate], beside.gate[HERE_TO, gate]
    its_enter, its_leave = beside.gate[THERE_FROM, gate], beside.gate[THERE_TO, gate]
    return its_enter + (station - enter) * (its_leave - its_enter) / (leave - enter)


@inlined
def line_of(b, beside, phase):
    """The line of a block that leads around all works that are there."""
    line = beside.line[b]
    for i in range(beside.work.shape[0]):
        if beside.work[i, b] >= 0 and phase[beside.work[i, b]] == ACTING:
            line += 1 << i
    return line


@lean
def take(v, b, block, beside, phase, path_first, path_count, stop_first, stop_count, sweep_first, sweep_count, drive_first, drive_count,
         base, work, choice):  # fmt: skip
    """v is on the line of a block."""
    line, j = line_of(b, beside, phase), beside.detour[v]
    block[v] = b
    path_first[v], path_count[v] = beside.lines[LINE_FIRST, line], beside.lines[LINE_COUNT, line]
    stop_first[v], stop_count[v] = beside.lines[LINE_STOP, line], beside.lines[LINE_STOPS, line]
    sweep_first[v], sweep_count[v] = beside.lines[LINE_OBJECT, line], beside.lines[LINE_OBJECTS, line]
    drive_first[v], drive_count[v] = beside.lines[LINE_DRIVE, line], beside.lines[LINE_DRIVES, line]
    if j >= 0:
        base[j], choice[j] = beside.line[b], line - beside.line[b]
        for i in range(work.shape[0]):
            work[i, j] = beside.work[i, b]


@lean
def begin(v, guess, state, points, first, count, mind):
    """v finds itself on its new line, beside it, and begins to go over."""
    best, station = inf, guess
    for i in range(-1, 2):
        s, e = project(points, first, count, state[X, v], state[Y, v], min(max(guess + i * TURN, 0.0), (count - 1.001) * PATH_SPACING))
        if abs(e) < abs(best):
            best, station = e, s
    by = mind[STATION, v] - station
    mind[LEFT_BY, v], mind[STATION, v] = by, station
    mind[RED_STATION, v] -= by
    mind[ASIDE_FROM, v] = mind[ASIDE, v] = best
    mind[CHANGING, v] = mind[CHANGED, v] = 0.0


# -- wanting to --------------------------------------------------------------------------------------


@lean
def idle(tick, state, watched, mind):
    """How long everybody has stood for nothing, in worlds in which somebody changes lanes."""
    for v in range(state.shape[1]):
        if watched[v] != 0:
            mind[IDLED, v] = mind[IDLED, v] + tick if idles(v, state, mind) else 0.0


@lean
def choose(every, state, parameter, places, points, path_first, path_count, world_of, number, entity, asked, block, left_first,
           left_count, beside, phase, stop_first, stop_count, sweep_first, sweep_count, drive_first, drive_count, base, work, choice, web,
           first, place, at, found, drivers, mind, k):  # fmt: skip
    """Who wants to change lanes; who has arrived is on his usual ones again."""
    count = 0
    for v in range(state.shape[1]):
        if beside.home[v] < 0:
            continue
        if state[ACTIVE, v] == 0.0:
            if block[v] != beside.home[v]:
                take(
                    v, beside.home[v], block, beside, phase, path_first, path_count, stop_first, stop_count, sweep_first, sweep_count,
                    drive_first, drive_count, base, work, choice,
                )  # fmt: skip
                mind[OFFSET, v] = 0.0
            left_count[v], mind[CHANGING, v], mind[ASIDE, v], mind[CHANGED, v] = 0, 1.0, 0.0, REST
            continue
        mind[BESIDE, v] = beside.aside[block[v]]
        if left_count[v] > 0:
            mind_old_lane(
                v, state, parameter, places, points, path_first[v], path_count[v], world_of[v], number, left_first[v], left_count[v], web,
                first, place, at, drivers, mind,
            )  # fmt: skip
        is_asked = (k + entity[v]) % every == 0 and mind[CHANGING, v] == 1.0 and left_count[v] == 0 and mind[AWAY, v] == 0.0
        is_asked = is_asked and mind[OUT_BY, v] == 0.0
        if not (is_asked or mind[GAP, v] < AHEAD):
            continue
        other, gap = ahead_on(
            v, mind[STATION, v], drive_first[v], drive_count[v], world_of[v], state, parameter, drivers, web, first, place, at
        )
        stander = other >= 0 and left_count[v] == 0 and mind[IDLED, other] > LONG
        if stander and gap > NEAR and is_passable(v, gap + parameter[LENGTH, other] + PAST, block[v], beside, mind):
            follow(v, number[other], max(gap - ROOM, NEAREST), 0.0, state, drivers, mind)
        if not is_asked:
            continue
        asked[v] = best_gate(
            v, other, gap, stander, state, parameter, world_of[v], block[v], beside, phase, drive_first[v], drive_count[v], web, first,
            place, at, drivers, mind,
        )  # fmt: skip
        if asked[v] >= 0:
            if is_near_another(v, count, world_of, places, state, found):
                asked[v] = -1
            else:
                found[count] = v
                count += 1


@inlined
def is_near_another(v, count, world_of, places, state, found):
    """Whether somebody near has begun to change at this tick."""
    for i in range(count):
        dx, dy = state[X, found[i]] - state[X, v], state[Y, found[i]] - state[Y, v]
        if world_of[found[i]] == world_of[v] and dx * dx + dy * dy < APART * APART:
            return True
    return False


@lean
def mind_old_lane(v, state, parameter, places, points, path_first, path_count, world, number, drive, count, web, first, place, at, drivers,
                  mind):  # fmt: skip
    """Who is ahead on the lane that is being left is followed while he is in the way."""
    other, gap = ahead_on(v, mind[STATION, v] + mind[LEFT_BY, v], drive, count, world, state, parameter, drivers, web, first, place, at)
    if other < 0:
        return
    guess = mind[STATION, v] + parameter[FRONT, v] + gap
    _, e = project(points, path_first, path_count, places[REAR_X, other], places[REAR_Y, other], guess)
    if abs(e - mind[OFFSET, v]) < 0.5 * (parameter[WIDTH, v] + parameter[WIDTH, other]) + BODY:
        follow(v, number[other], gap, state[V_X, other], state, drivers, mind)


@lean
def idles(v, state, mind):
    """Whether somebody stands though no line, light, car or object that could be seen keeps him from driving."""
    if state[ACTIVE, v] == 0.0 or abs(state[V_X, v]) > STANDING:
        return False
    is_free = min(min(mind[FOLLOWING, v], mind[YIELDING, v]), mind[STOPPING, v]) > GOES
    return is_free and mind[RED_STATION, v] == inf and mind[WAY_STATION, v] == inf


@inlined
def is_passable(v, way, b, beside, mind):
    """Whether so many metres on there is another lane beside."""
    for gate in range(beside.first[b], beside.first[b] + beside.count[b]):
        station = mind[STATION, v]
        if beside.gate[STEP, gate] != 0.0 and beside.gate[HERE_FROM, gate] <= station and station + way <= beside.gate[HERE_TO, gate]:
            return True
    return False


@inlined
def to_work(b, station, beside, phase):
    """How far [m] it is along a block's line to the next work that is there; less than nothing within one."""
    left, line = inf, beside.line[b]
    for i in range(beside.work.shape[0]):
        if beside.work[i, b] >= 0 and phase[beside.work[i, b]] == ACTING and station < beside.span[2 * i + 1, line]:
            left = min(left, beside.span[2 * i, line] - station)
    return left


@lean
def best_gate(v, ahead, gap, stander, state, parameter, world, b, beside, phase, drive, count, web, first, place, at, drivers, mind):
    """The gate through which a change is wanted most and safe; -1 for none."""
    station, best, most = mind[STATION, v], -1, 0.0
    speed = max(state[V_X, v], 0.0)
    is_close = ahead >= 0 and gap < NEAR and state[V_X, ahead] < SLOW
    if is_close or to_work(b, station, beside, phase) < speed * DURATION + ROOM:
        return -1
    now = free_or_behind(v, ahead, gap, state, drivers, mind)
    follower, its_gap = behind_on(v, station, drive, count, world, state, parameter, web, first, place, at)
    for gate in range(beside.first[b], beside.first[b] + beside.count[b]):
        if beside.gate[STEP, gate] == 0.0 or not beside.gate[HERE_FROM, gate] <= station < beside.gate[HERE_TO, gate] - speed * DURATION:
            continue
        to = int(beside.gate[TO, gate])
        other_station = there(station, gate, beside)
        here = min(beside.gate[HERE_BACK, gate] - station, to_work(b, station, beside, phase))
        beyond = min(beside.gate[THERE_BACK, gate] - other_station, to_work(to, other_station, beside, phase))
        reach = LEAST + HORIZON * speed
        is_home = abs(beside.aside[to]) < abs(beside.aside[b])
        needed = here < reach * max(abs(beside.aside[b]), 1) and (is_home or beyond > here) and beyond > 0.0
        passes = stander and beyond > gap + parameter[LENGTH, ahead] + PAST
        is_long = beyond >= STAYING * reach * max(abs(beside.aside[to]), 1)
        if mind[CHANGED, v] < (SOON if needed or passes else REST) or not (needed or passes or is_long):
            continue
        worth = worth_of(
            v, to, other_station, now, ahead, gap, follower, its_gap, beside, phase, world, state, parameter, web, first, place, at,
            drivers, mind,
        )  # fmt: skip
        if worth == -inf:
            continue
        if needed or passes:
            return gate
        bias = -beside.gate[STEP, gate] * drivers[KEEP_SIDE, v] if mind[V_DESIRED, v] > TOWN else 0.0
        if worth + bias > max(drivers[GAIN, v], most):
            best, most = gate, worth + bias
    return best


@lean
def worth_of(v, to, station, now, ahead, gap, follower, its_gap, beside, phase, world, state, parameter, web, first, place, at, drivers,
             mind):  # fmt: skip
    """What a change to another block's line is worth [m/s²]; less than anything when it is not safe."""
    line, speed, length = line_of(to, beside, phase), state[V_X, v], parameter[LENGTH, v]
    drive, count = beside.lines[LINE_DRIVE, line], beside.lines[LINE_DRIVES, line]
    new_ahead, new_gap = ahead_on(v, station, drive, count, world, state, parameter, drivers, web, first, place, at)
    new, its_new_gap = behind_on(v, station, drive, count, world, state, parameter, web, first, place, at)
    then = free_or_behind(v, new_ahead, mind[MISJUDGED, v] * new_gap, state, drivers, mind)
    if new_gap < NEAREST or its_new_gap < NEAREST or then < -drivers[IMPOSED, v]:
        return -inf
    its_now = its_then = old_now = old_then = 0.0
    if new >= 0:
        its_then = behind(new, mind[MISJUDGED, v] * its_new_gap, speed, state, drivers, mind)
        its_now = free_or_behind(new, new_ahead, its_new_gap + length + new_gap, state, drivers, mind)
        if its_then < -drivers[IMPOSED, v]:
            return -inf
    if follower >= 0:
        old_now = behind(follower, its_gap, speed, state, drivers, mind)
        old_then = free_or_behind(follower, ahead, its_gap + length + gap, state, drivers, mind)
    return incentive(now, then, its_now, its_then, old_now, old_then, drivers[POLITENESS, v])


@inlined
def free_or_behind(v, ahead, gap, state, drivers, mind):
    """Acceleration [m/s²] of v behind somebody, or on an empty road."""
    if ahead < 0:
        return behind(v, inf, 0.0, state, drivers, mind)
    return behind(v, gap, state[V_X, ahead], state, drivers, mind)


# -- looking up --------------------------------------------------------------------------------------


@lean
def ahead_on(v, station, drive, count, world, state, parameter, drivers, web, first, place, at):
    """The first who drives ahead on a line, from a station [m] on, and the gap [m] to him; -1 and infinite for nobody."""
    nose = station + parameter[FRONT, v]
    far = nose + AHEAD + state[V_X, v] * state[V_X, v] / LOOKING
    for d in range(first_drive(station, drive, count, web), drive + count):
        if web.drive[ENTER, d] > far:
            break
        if web.drive[LEAVE, d] <= station:
            continue
        key, own = world * web.right.size + web.strand[d], station_on(d, station, web)
        i, end = from_station(key, max(own, 0.0), first, place, at)
        while i < end and place[KEY, i] == key:
            other, its, i = place[WHO, i], at[i], i + 1
            if other != v and (place[THERE, i - 1] != 0 or its > 0.0):
                if is_unseen(v, other, state, parameter, drivers):
                    return -1, inf
                return other, its - own + parameter[FRONT, other] - parameter[LENGTH, other] - parameter[FRONT, v]
    return -1, inf


@lean
def behind_on(v, station, drive, count, world, state, parameter, web, first, place, at):
    """The first who drives behind on a line, and the gap [m] to him; -1 and infinite for nobody."""
    rear = parameter[LENGTH, v] - parameter[FRONT, v]
    last = first_drive(station, drive, count, web)
    while last < drive + count and web.drive[ENTER, last] <= station:
        last += 1
    for d in range(last - 1, drive - 1, -1):
        if web.drive[LEAVE, d] < station - BACK:
            break
        key, own = world * web.right.size + web.strand[d], station_on(d, station, web)
        i = from_station(key, own, first, place, at)[0] - 1
        while i >= first[bucket_of(key, first.size - 1)] and place[KEY, i] == key:
            other, its, i = place[WHO, i], at[i], i - 1
            if other != v and (place[THERE, i + 1] != 0 or its > 0.0):
                return other, own - its - rear - parameter[FRONT, other]
    return -1, inf
