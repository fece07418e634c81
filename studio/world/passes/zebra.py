"""Zebra crossings: drivers let those cross who are on one, or want to be (StVO § 26 (1)).

    wants to     somebody on foot whose line leads over the stripes, from a few seconds before he steps on them
    is let       by everybody whose way he has still to cross, from the edge of the road on and in whichever lane he walks
    is seen      unless a building, another vehicle or a thing that is no cone is between the driver and his middle
    line         the near edge of the crossing. Who cannot stop before it any more goes on; then one who is in his way already is braked for
                 as everywhere

Where walkers have lights, these decide, and no more is minded than who is in one's way.
"""

from math import cos, inf, sin, sqrt

from studio.compiled import inlined, lean
from studio.model import driver
from studio.road.network.shadow import EYE, level, walls_between
from studio.road.ways.path import PATH_HEADING, PATH_HEIGHT, PATH_X, PATH_Y, interpolate, project
from studio.vehicle.parameter import FRONT, LENGTH, WIDTH
from studio.vehicle.state import ACTIVE, V_X, X, Y, Z
from studio.world.passes.junction import ELBOW_ROOM
from studio.world.passes.level import OTHER_LEVEL
from studio.world.passes.neighbour import COS, SIN
from studio.world.passes.traffic import LOOK, LOOKING, clip, yield_at_line
from studio.world.table.mind import FIRST, SIGHT, STATION, WAY_STATION
from studio.world.table.street import (
    CONE,
    O_ENTRY,
    O_HEADING,
    O_HEIGHT,
    O_KIND,
    O_LENGTH,
    O_WIDTH,
    O_X,
    O_Y,
    OBJECT,
    Z_FROM,
    Z_HEADING,
    Z_LENGTH,
    Z_TO,
    Z_WIDTH,
    Z_X,
    Z_Y,
)  # fmt: skip

WANTS = 4.0  # [s] so long before the first step one sees that somebody wants to cross: a car at 50 km/h stops comfortably in that
LEAST_TURN = 0.3  # sine of the angle between a path and a crossing; what is less runs beside it
ROUNDS = 3  # until the place where they cross is known: the first is near, the others mend what a bend makes wrong
ON_IT = 0.5  # [m]


@lean
def let_cross(state, parameter, points, path_first, path_count, table, standing, first_object, object_count, turned, mover, speed,
              zebra_first, zebra_count, zebra, world_of, places, place_of, shadow, drivers, mind, time):  # fmt: skip
    """Every driver minds everybody who crosses, or wants to, and whom he sees."""
    for j in range(mover.size):
        i = mover[j]
        k = wanted(speed[j], time - turned[0, int(table[O_ENTRY, i])], zebra_first[j], zebra_count[j], zebra)
        if standing[i] == 0 or k < 0:
            continue
        for v in range(state.shape[1]):
            w = world_of[v]
            first = first_object[w]
            if state[ACTIVE, v] == 0.0 or not first <= i < first + object_count[w]:
                continue
            line = edge_before(v, i, k, state, parameter, points, path_first[v], path_count[v], table, zebra, drivers, mind)
            if line < mind[WAY_STATION, v] and not is_hidden(
                v, i, state, parameter, places, world_of, place_of[w], shadow, table, standing, first, object_count[w]
            ):  # fmt: skip
                mind[WAY_STATION, v], mind[FIRST, v] = line, OBJECT - (i - first)
                yield_at_line(v, state, parameter, drivers, mind)


@inlined
def wanted(speed, walked, first, count, zebra):
    """The crossing that one who has walked for so long [s] is on, or wants to be on; -1 for none."""
    for k in range(first, first + count):
        if zebra[Z_FROM, k] - speed * WANTS <= speed * walked <= zebra[Z_TO, k]:
            return k
    return -1


@inlined
def edge_before(v, i, k, state, parameter, points, first, count, table, zebra, drivers, mind):
    """The station [m] at which a driver would wait for one who is on crossing k, or wants to be; infinite where he need not or cannot."""
    dx, dy, reach = table[O_X, i] - state[X, v], table[O_Y, i] - state[Y, v], drivers[SIGHT, v] + parameter[FRONT, v]
    if dx * dx + dy * dy > reach * reach:
        return inf
    own, turn = crossed(v, k, state, points, first, count, zebra, mind)
    if own < inf and abs(interpolate(points, first, PATH_HEIGHT, own) - table[O_HEIGHT, i]) > OTHER_LEVEL:
        return inf
    line = own - 0.5 * zebra[Z_WIDTH, k] / turn
    distance = line - mind[STATION, v] - parameter[FRONT, v]
    if not 0.0 <= distance < inf or not driver.can_stop(state[V_X, v], distance):
        return inf
    return line if has_still_to_cross(v, i, own, k, parameter, points, first, table, zebra) else inf


@inlined
def crossed(v, k, state, points, first, count, zebra, mind):
    """Where a path and the middle line of a crossing meet [m], infinite where they do not; and the sine of the angle between them."""
    dx, dy = zebra[Z_X, k] - state[X, v], zebra[Z_Y, k] - state[Y, v]
    away, speed = sqrt(dx * dx + dy * dy), state[V_X, v]
    if away > LOOK + speed * speed / LOOKING + 0.5 * zebra[Z_LENGTH, k]:
        return inf, 1.0
    s, _ = project(points, first, count, zebra[Z_X, k], zebra[Z_Y, k], mind[STATION, v] + away)
    c, b, turn, aside = cos(zebra[Z_HEADING, k]), sin(zebra[Z_HEADING, k]), 1.0, 0.0
    for _ in range(ROUNDS):
        s = clip(s + aside / turn, count)
        dx, dy = zebra[Z_X, k] - interpolate(points, first, PATH_X, s), zebra[Z_Y, k] - interpolate(points, first, PATH_Y, s)
        turn, aside = sin(zebra[Z_HEADING, k] - interpolate(points, first, PATH_HEADING, s)), dx * b - dy * c
        if abs(turn) < LEAST_TURN:
            return inf, 1.0
    is_met = abs(aside) < ON_IT and abs(dx * c + dy * b) < 0.5 * zebra[Z_LENGTH, k]
    return (s if is_met else inf), abs(turn)


@inlined
def has_still_to_cross(v, i, own, k, parameter, points, first, table, zebra):
    """Whether somebody on foot has not left yet, along a crossing, the strip that v will sweep at a station of its path [m]."""
    c, b = cos(zebra[Z_HEADING, k]), sin(zebra[Z_HEADING, k])
    dx, dy = interpolate(points, first, PATH_X, own) - table[O_X, i], interpolate(points, first, PATH_Y, own) - table[O_Y, i]
    left = dx * c + dy * b if cos(table[O_HEADING, i] - zebra[Z_HEADING, k]) >= 0.0 else -(dx * c + dy * b)
    return left > -0.5 * (parameter[WIDTH, v] + table[O_LENGTH, i]) - ELBOW_ROOM


# -- what hides him --------------------------------------------------------------------------------


@lean
def is_hidden(v, i, state, parameter, places, world_of, place, shadow, table, standing, first, count):
    """Whether a driver does not see the middle of somebody, past buildings, vehicles and the objects of his world."""
    x, y = state[X, v], state[Y, v]
    dx, dy = table[O_X, i] - x, table[O_Y, i] - y
    if walls_between(shadow, place, x, y, EYE, table[O_X, i], table[O_Y, i], EYE)[0] > 0:
        return True
    for w in range(state.shape[1]):
        if w != v and world_of[w] == world_of[v] and state[ACTIVE, w] != 0.0 and abs(state[Z, w] - state[Z, v]) <= OTHER_LEVEL:
            c, b, length = places[COS, w], places[SIN, w], parameter[LENGTH, w]
            ahead = parameter[FRONT, w] - 0.5 * length
            if covers(dx, dy, state[X, w] + ahead * c - x, state[Y, w] + ahead * b - y, c, b, length, parameter[WIDTH, w]):
                return True
    for o in range(first, first + count):
        if o != i and standing[o] != 0 and table[O_KIND, o] != CONE and abs(table[O_HEIGHT, o] - table[O_HEIGHT, i]) <= OTHER_LEVEL:
            c, b = cos(table[O_HEADING, o]), sin(table[O_HEADING, o])
            if covers(dx, dy, table[O_X, o] - x, table[O_Y, o] - y, c, b, table[O_LENGTH, o], table[O_WIDTH, o]):
                return True
    return False


@inlined
def covers(dx, dy, x, y, c, b, length, width):
    """Whether a line from the eye to a place dx, dy crosses an outline with its middle at x, y and a heading of cosine c and sine b."""
    along, aside = -(x * c + y * b), x * b - y * c  # of the eye, seen from the middle of the outline
    enter, leave = level(along, along + dx * c + dy * b, -0.5 * length, 0.5 * length)
    begin, end = level(aside, aside + dy * c - dx * b, -0.5 * width, 0.5 * width)
    return max(enter, begin) < min(leave, end)
