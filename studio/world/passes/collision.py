"""Collisions: oriented boxes of bodies and objects, tested pair by pair at every tick, each pair reported once.

Two convex boxes are apart exactly when one of their four edge directions separates them (S. Gottschalk, M. Lin,
D. Manocha, OBBTree, SIGGRAPH 1996). What happens after a contact is not claimed.
"""

from math import cos, sin, sqrt

from studio.compiled import inlined, lean
from studio.vehicle.parameter import FRONT, LENGTH, WIDTH
from studio.vehicle.state import ACTIVE, PSI, V_X, V_Y, X, Y, Z
from studio.world.passes.level import OTHER_LEVEL, is_thing_apart
from studio.world.passes.neighbour import AT_X, AT_Y, moved, within
from studio.world.table.street import HIT_FIRST, HIT_SECOND, HIT_SPEED, HIT_TIME, O_HEADING, O_LENGTH, O_SPEED, O_WIDTH, O_X, O_Y, OBJECT

NEAR = 2.0  # [m] two bodies are looked at when their middles are nearer than half of both lengths and this
ROUNDING = 1e-6  # [m] by which a bound gives way


@lean
def centre(v, state, parameter):
    """Middle of the body [m]."""
    ahead = parameter[FRONT, v] - 0.5 * parameter[LENGTH, v]
    return state[X, v] + ahead * cos(state[PSI, v]), state[Y, v] + ahead * sin(state[PSI, v])


@lean
def reach_along(angle, length, width):
    """Half extent [m] of a box along a direction at `angle` [rad] to its length."""
    return 0.5 * (length * abs(cos(angle)) + width * abs(sin(angle)))


@lean
def separated(axis, dx, dy, psi_a, length_a, width_a, psi_b, length_b, width_b):
    """Whether the direction `axis` [rad] has a gap between two boxes whose centres are (dx, dy) [m] apart."""
    distance = abs(dx * cos(axis) + dy * sin(axis))
    return distance > reach_along(psi_a - axis, length_a, width_a) + reach_along(psi_b - axis, length_b, width_b)


@lean
def overlap(dx, dy, psi_a, length_a, width_a, psi_b, length_b, width_b):
    """Whether two boxes whose centres are (dx, dy) [m] apart overlap."""
    quarter = 1.5707963267948966
    for axis in (psi_a, psi_a + quarter, psi_b, psi_b + quarter):
        if separated(axis, dx, dy, psi_a, length_a, width_a, psi_b, length_b, width_b):
            return False
    return True


@inlined
def half_and_offset(v, parameter):
    """Half the length of a body and how far its middle is from its centre of gravity [m]."""
    return 0.5 * parameter[LENGTH, v] + abs(parameter[FRONT, v] - 0.5 * parameter[LENGTH, v])


@inlined
def are_apart(a, b, state, parameter):
    """Whether two centres of gravity are too far from each other for the middles to be near; without an angle."""
    dx, dy = state[X, b] - state[X, a], state[Y, b] - state[Y, a]
    reach = half_and_offset(a, parameter) + half_and_offset(b, parameter) + NEAR + ROUNDING
    return dx * dx + dy * dy > reach * reach


@lean
def touching(a, b, state, parameter):
    """Whether the bodies of two cars overlap."""
    if are_apart(a, b, state, parameter) or abs(state[Z, a] - state[Z, b]) > OTHER_LEVEL:
        return False
    x_a, y_a = centre(a, state, parameter)
    x_b, y_b = centre(b, state, parameter)
    dx, dy = x_b - x_a, y_b - y_a
    if dx * dx + dy * dy > 0.25 * (parameter[LENGTH, a] + parameter[LENGTH, b] + 2.0 * NEAR) ** 2:
        return False
    return overlap(
        dx, dy, state[PSI, a], parameter[LENGTH, a], parameter[WIDTH, a], state[PSI, b], parameter[LENGTH, b], parameter[WIDTH, b]
    )


@lean
def striking(v, i, state, parameter, table):
    """Whether the body of a car overlaps object i."""
    x, y = centre(v, state, parameter)
    dx, dy = table[O_X, i] - x, table[O_Y, i] - y
    if dx * dx + dy * dy > 0.25 * (parameter[LENGTH, v] + table[O_LENGTH, i] + 2.0 * NEAR) ** 2:
        return False
    if is_thing_apart(v, i, state, parameter, table):
        return False
    return overlap(
        dx, dy, state[PSI, v], parameter[LENGTH, v], parameter[WIDTH, v], table[O_HEADING, i], table[O_LENGTH, i], table[O_WIDTH, i]
    )


@lean
def relative_speed(a, b, state):
    """Speed [m/s] of one body as seen from the other."""
    east = state[V_X, a] * cos(state[PSI, a]) - state[V_X, b] * cos(state[PSI, b])
    north = state[V_X, a] * sin(state[PSI, a]) - state[V_X, b] * sin(state[PSI, b])
    return sqrt(east * east + north * north)


@lean
def speed_against(v, i, state, table):
    """Speed [m/s] of a car as seen from object i."""
    turned = table[O_HEADING, i] - state[PSI, v]
    ahead, left = state[V_X, v] - table[O_SPEED, i] * cos(turned), state[V_Y, v] - table[O_SPEED, i] * sin(turned)
    return sqrt(ahead * ahead + left * left)


@lean
def is_known(a, b, first, last, hits):
    """Whether this pair stands in the columns from `first` to before `last`."""
    for i in range(first, last):
        if hits[HIT_FIRST, i] == a and hits[HIT_SECOND, i] == b:
            return True
    return False


@lean
def report(time, a, b, speed, column, hits):
    """Writes a collision at a relative speed [m/s]."""
    hits[HIT_TIME, column] = time
    hits[HIT_FIRST, column] = a
    hits[HIT_SECOND, column] = b
    hits[HIT_SPEED, column] = speed


@lean
def contacts(tick, widest, state, parameter, world_of, number, grid, places, found, first, count, table, first_object, object_count,
             standing, hits, total, time):  # fmt: skip
    """All contacts at the end of the tick that begins at a time [s]; how many of them found no room."""
    end = time + tick
    left = collide(widest, state, parameter, world_of, number, grid, places, found, hits, total, end)
    return left + strike(state, parameter, first, count, table, first_object, object_count, standing, hits, total, end)


@lean
def collide(widest, state, parameter, world_of, number, grid, places, found, hits, total, time):
    """Adds new contacts to `hits` and counts them in `total`, vehicle by vehicle, each with those of higher numbers.

    Gives how many of them found no room.
    """
    share, far, left = hits.shape[1] // total.size, 2.0 * moved(state, places) + widest + NEAR + ROUNDING, 0
    for a in range(state.shape[1]):
        w = world_of[a]
        if state[ACTIVE, a] == 0.0:
            continue
        reach = half_and_offset(a, parameter) + far
        for i in range(within(w, places[AT_X, a], places[AT_Y, a], 1.0, 0.0, -reach, reach, -reach, reach, grid, places, found)):
            b = found[i]
            if b > a and state[ACTIVE, b] > 0.0 and touching(a, b, state, parameter):
                left += add(time, number[a], number[b], relative_speed(a, b, state), w, share, hits, total)
    return left


@lean
def add(time, a, b, speed, w, share, hits, total):
    """A contact of a pair that has not been reported; 1 when there is no room for it."""
    first = w * share
    if is_known(a, b, first, first + total[w], hits):
        return 0
    if total[w] == share:
        return 1
    report(time, a, b, speed, first + total[w], hits)
    total[w] += 1
    return 0


@lean
def strike(state, parameter, first, count, table, first_object, object_count, standing, hits, total, time):
    """The same for cars and the objects that stand on the road; object i is OBJECT - i."""
    share, left = hits.shape[1] // first.size, 0
    for w in range(first.size):
        for v in range(first[w], first[w] + count[w]):
            for i in range(first_object[w], first_object[w] + object_count[w]):
                if state[ACTIVE, v] > 0.0 and standing[i] != 0 and striking(v, i, state, parameter, table):
                    speed = speed_against(v, i, state, table)
                    left += add(time, v - first[w], OBJECT - (i - first_object[w]), speed, w, share, hits, total)
    return left
