"""Neighbours: who is near a place. Once a tick all vehicles are sorted into square cells; a question looks at a few cells only.

Cells without end in all directions are numbered world after world, and a cell's number decides its bucket, of which there are
about twice as many as vehicles. So neither the size of the map nor the number of worlds costs anything. Two cells may share a
bucket; the full number beside each vehicle tells them apart.

Vehicles that take no part are not in it. Neighbours come in the order of their numbers, whatever world or batch they are in.
Nothing of this is state: it is made anew at every tick.
"""

from dataclasses import dataclass
from math import cos, floor, sin, sqrt

import numpy as np

from studio.compiled import inlined, lean
from studio.rows import Role, Table
from studio.vehicle.parameter import FRONT, LENGTH
from studio.vehicle.state import ACTIVE, PSI, X, Y

CELL = 64.0  # [m]
SCATTER, HALF = np.uint64(0x9E3779B97F4A7C15), np.uint64(32)  # Knuth, The Art of Computer Programming 3, section 6.4
WORTH = 8  # vehicles that may be looked at instead of one cell
SPAN = 2**21  # cells from west to east until their numbers begin again
FIRST, ORDER, NUMBER, BUCKET = range(4)  # rows of a grid: where buckets begin, who is in them, in which cell; a vehicle's bucket

PLACE = Table("place", Role.SCRATCH, per="vehicle")
AT_X = PLACE.row("x", "m", "where the centre of gravity was when all were sorted")
AT_Y = PLACE.row("y", "m", "where the centre of gravity was when all were sorted")
COS = PLACE.row("cosine", "1", "of the heading")
SIN = PLACE.row("sine", "1", "of the heading")
REAR_X = PLACE.row("rear_x", "m", "middle of the rear bumper")
REAR_Y = PLACE.row("rear_y", "m", "middle of the rear bumper")
IN_X = PLACE.row("x_in_order", "m", "the same as x, of the vehicle that has this place among all that are sorted")
IN_Y = PLACE.row("y_in_order", "m", "the same as y, of the vehicle that has this place among all that are sorted")
IN_BOX = PLACE.row("in_box", "1", "1 for the vehicle that has this place when it is in the box that was asked for last")


@dataclass
class Neighbours:
    """The grid, int64[row, bucket or vehicle]; where everybody was, [row, vehicle]; room for the answer to one question."""

    grid: np.ndarray
    places: np.ndarray
    found: np.ndarray
    entered: np.ndarray  # vehicles that have come in since
    longest: float  # [m] no part of a vehicle is farther from its centre of gravity, along its length
    widest: float  # [m] half a body, and how far its middle is from its centre of gravity


def neighbours(parameter: np.ndarray) -> Neighbours:
    """Room for some vehicles; nobody is sorted yet."""
    n = parameter.shape[1]
    buckets = 2 ** int(np.ceil(np.log2(2 * n + 2)))
    longest = float(np.maximum(parameter[FRONT], parameter[LENGTH] - parameter[FRONT]).max(initial=0.0))
    half = 0.5 * parameter[LENGTH]
    return Neighbours(
        grid=np.zeros((4, buckets + 1), np.int64),
        places=np.zeros((len(PLACE), n)),
        found=np.zeros(n, np.int64),
        entered=np.zeros(n, np.int64),
        longest=longest,
        widest=float((half + np.abs(parameter[FRONT] - half)).max(initial=0.0)),
    )


# -- sorting -----------------------------------------------------------------------------------------


@inlined
def cell_of(place):
    """Column or row of the cells in which a coordinate [m] lies."""
    return int(floor(place / CELL))


@inlined
def cell_number(world, column, row):
    """The number of a cell."""
    return (world * SPAN + (column & (SPAN - 1))) * SPAN + (row & (SPAN - 1))


@inlined
def bucket_of(number, buckets):
    """Its bucket: a product with a large odd number scatters cells that lie side by side."""
    return int(np.uint64(number) * SCATTER >> HALF & np.uint64(buckets - 1))


@lean
def sort(state, parameter, world_of, grid, places):
    """Sorts all vehicles that take part, by counting: how many are in each bucket, then each into its place."""
    buckets = grid.shape[1] - 1
    grid[FIRST] = 0
    for v in range(state.shape[1]):
        put_down(v, state, parameter, places)
        if state[ACTIVE, v] > 0.0:
            bucket = bucket_of(cell_number(world_of[v], cell_of(state[X, v]), cell_of(state[Y, v])), buckets)
            grid[BUCKET, v] = bucket
            grid[FIRST, bucket] += 1
    for bucket in range(1, buckets + 1):
        grid[FIRST, bucket] += grid[FIRST, bucket - 1]
    fill(state, world_of, grid, places)


@inlined
def put_down(v, state, parameter, places):
    """Where a vehicle is, and its rear."""
    c, s = cos(state[PSI, v]), sin(state[PSI, v])
    back = parameter[LENGTH, v] - parameter[FRONT, v]
    places[AT_X, v], places[AT_Y, v] = state[X, v], state[Y, v]
    places[COS, v], places[SIN, v] = c, s
    places[REAR_X, v], places[REAR_Y, v] = state[X, v] - back * c, state[Y, v] - back * s


@lean
def fill(state, world_of, grid, places):
    """Everybody takes the last free place of his bucket, the last vehicle first, so that each bucket is in order."""
    for v in range(state.shape[1] - 1, -1, -1):
        if state[ACTIVE, v] > 0.0:
            bucket = grid[BUCKET, v]
            grid[FIRST, bucket] -= 1
            place = grid[FIRST, bucket]
            grid[ORDER, place] = v
            places[IN_X, place], places[IN_Y, place] = state[X, v], state[Y, v]
            grid[NUMBER, place] = cell_number(world_of[v], cell_of(state[X, v]), cell_of(state[Y, v]))


# -- asking ------------------------------------------------------------------------------------------


@inlined
def within(world, x, y, c, s, back, ahead, right, left, grid, places, found):
    """Fills `found` with the vehicles of a world whose centre of gravity was in a box, in order; how many.

    The box is given from a place x, y [m] in a direction with the cosine c and the sine s: from `back` to `ahead` along it, from
    `right` to `left` across [m].
    """
    middle, half_length = 0.5 * (back + ahead), 0.5 * (ahead - back)
    aside, half_width = 0.5 * (right + left), 0.5 * (left - right)
    x, y = x + middle * c - aside * s, y + middle * s + aside * c
    half_x, half_y = half_length * abs(c) + half_width * abs(s), half_length * abs(s) + half_width * abs(c)
    low, high, bottom, top = cell_of(x - half_x), cell_of(x + half_x), cell_of(y - half_y), cell_of(y + half_y)
    if (high - low + 1) * (top - bottom + 1) * WORTH > grid[FIRST, grid.shape[1] - 1]:
        return within_all(world, x, y, c, s, half_length, half_width, grid, places, found)
    margin, count = 0.5 * CELL * (abs(c) + abs(s)), 0
    for column in range(low, high + 1):
        for row in range(bottom, top + 1):
            dx, dy = (column + 0.5) * CELL - x, (row + 0.5) * CELL - y
            if is_inside(dx, dy, c, s, half_length + margin, half_width + margin):
                count = in_cell(cell_number(world, column, row), x, y, c, s, half_length, half_width, grid, places, found, count)
    return count


@inlined
def in_cell(number, x, y, c, s, half_length, half_width, grid, places, found, count):
    """Adds those of one cell."""
    bucket = bucket_of(number, grid.shape[1] - 1)
    for place in range(grid[FIRST, bucket], grid[FIRST, bucket + 1]):
        dx, dy = places[IN_X, place] - x, places[IN_Y, place] - y
        if grid[NUMBER, place] == number and is_inside(dx, dy, c, s, half_length, half_width):
            count = insert(grid[ORDER, place], count, found)
    return count


@lean
def within_all(world, x, y, c, s, half_length, half_width, grid, places, found):
    """The same for boxes of many cells: everybody is looked at, first without a branch, as nobody can tell who will be in it."""
    count, sorted_ = 0, grid[FIRST, grid.shape[1] - 1]
    for place in range(sorted_):
        dx, dy = places[IN_X, place] - x, places[IN_Y, place] - y
        is_of_world = grid[NUMBER, place] // (SPAN * SPAN) == world
        is_in = is_of_world & (abs(dx * c + dy * s) <= half_length) & (abs(dy * c - dx * s) <= half_width)
        places[IN_BOX, place] = 1.0 if is_in else 0.0
    for place in range(sorted_):
        if places[IN_BOX, place] > 0.0:
            count = insert(grid[ORDER, place], count, found)
    return count


@inlined
def is_inside(dx, dy, c, s, half_length, half_width):
    """Whether a place that is (dx, dy) [m] from the middle of a box lies in it."""
    return abs(dx * c + dy * s) <= half_length and abs(dy * c - dx * s) <= half_width


@inlined
def insert(v, count, found):
    """Puts a number among those found, which stay in order; how many there are now."""
    i = count
    while i > 0 and found[i - 1] > v:
        found[i] = found[i - 1]
        i -= 1
    found[i] = v
    return count + 1


@lean
def moved(state, places):
    """How far [m] the vehicle that has gone farthest has gone since all were sorted."""
    most = 0.0
    for v in range(state.shape[1]):
        dx, dy = state[X, v] - places[AT_X, v], state[Y, v] - places[AT_Y, v]
        most = max(most, dx * dx + dy * dy)
    return sqrt(most)
