"""Places on lanes: arc length s [m] along a centre line and offset d [m] to its left, from and to the world.

Beside a straight piece from A to B of direction T and left normal N, with length L and u = 0 at A, u = 1 at B, lies

    P = A + T (u L + d ((1 - u) k_A - u k_B)) + N d          k = tan(half the corner's angle)

Lines of constant u are turned so that two neighbouring pieces meet on the bisector (mitre) of their corner. So d is the
distance from the piece, s and d are continuous over corners, and the way back is closed:

    d = N · (P - A),     u = (T · (P - A) - d k_A) / (L - d (k_A + k_B))

On the inner side of a bend the lines meet where the denominator is 0; beyond it there are no coordinates of this piece.
Before its start and behind its end a lane goes on straight.
"""

from math import copysign, cos, inf, isnan, nan, sin, sqrt
from typing import NamedTuple

from studio.compiled import compiled
from studio.road.network import Network, grid
from studio.road.network.grid import CELLS, COLUMNS, ROWS, SIZE, SOUTH, WEST
from studio.road.network.index import (
    LANE_LENGTH,
    NONE,
    P_EAST,
    P_HEADING,
    P_MITRE,
    P_NORTH,
    P_S,
    P_X,
    P_Y,
    POINT_COUNT,
    POINT_FIRST,
    index_of,
)

EDGE = 1e-9  # [1] two pieces that meet overlap by this, so that rounding leaves no gap between them
FARTHEST = 1e7  # [m] a position beyond it is none
USUAL_REACH = 50.0  # [m]


class Place(NamedTuple):
    """A place on a lane: `s` [m] from its start, `d` [m] to the left of its centre line."""

    lane: int
    s: float
    d: float


class Pose(NamedTuple):
    """A place in the world, and the lane's direction there [rad]."""

    x: float
    y: float
    heading: float


def nearest(network: Network, x: float, y: float, *, heading: float = nan, reach: float = USUAL_REACH) -> Place | None:
    """The place on the nearest lane, or None when there is none.

    Args:
        network: the map.
        x, y: position [m].
        heading: only lanes whose direction is within 90° of it are looked at [rad]; left out, all.
        reach: how far away the lane may be [m].
    """
    found = nearest_lane(index_of(network), 0, float(x), float(y), float(heading), float(reach))
    return None if found[0] == NONE else Place(*found)


def to_world(network: Network, place: Place) -> Pose:
    """Position and direction of a place on a lane."""
    return Pose(*world_place(index_of(network), place.lane, float(place.s), float(place.d)))


def to_lane(network: Network, lane: int, x: float, y: float) -> Place:
    """A position [m] seen from a lane; before its start s is negative, behind its end longer than the lane."""
    return Place(lane, *lane_place(index_of(network), lane, float(x), float(y)))


# -- compiled --------------------------------------------------------------------------------------


@compiled
def piece_at(points, first, count, s):
    """Column of the piece of a centre line on which arc length s [m] lies."""
    low, high = first, first + count - 2
    while low < high:
        middle = (low + high + 1) // 2
        if points[P_S, middle] <= s:
            low = middle
        else:
            high = middle - 1
    return low


@compiled
def world_place(index, lane, s, d):
    """x, y [m] and heading [rad], continuous along the lane, of a place on it."""
    points = index.points
    i = piece_at(points, index.spans[POINT_FIRST, lane], index.spans[POINT_COUNT, lane], s)
    along = s - points[P_S, i]
    u = min(max(along / (points[P_S, i + 1] - points[P_S, i]), 0.0), 1.0)
    t = along + d * ((1.0 - u) * points[P_MITRE, i] - u * points[P_MITRE, i + 1])
    x = points[P_X, i] + t * points[P_EAST, i] - d * points[P_NORTH, i]
    y = points[P_Y, i] + t * points[P_NORTH, i] + d * points[P_EAST, i]
    return x, y, (1.0 - u) * points[P_HEADING, i] + u * points[P_HEADING, i + 1]


@compiled
def lane_place(index, lane, x, y):
    """s and d [m] of a position seen from a lane."""
    points, first, count = index.points, index.spans[POINT_FIRST, lane], index.spans[POINT_COUNT, lane]
    last = first + count - 2
    best, best_s, best_d = inf, nan, nan
    for i in range(first, last + 1):
        dx, dy = x - points[P_X, i], y - points[P_Y, i]
        t = dx * points[P_EAST, i] + dy * points[P_NORTH, i]
        d = dy * points[P_EAST, i] - dx * points[P_NORTH, i]
        length = points[P_S, i + 1] - points[P_S, i]
        if i == first and t < 0.0:
            along, beyond = t, t
        elif i == last and t > length:
            along, beyond = t, t - length
        else:
            room = length - d * (points[P_MITRE, i] + points[P_MITRE, i + 1])
            u = (t - d * points[P_MITRE, i]) / room if room > 0.0 else -1.0
            if u < -EDGE or u > 1.0 + EDGE:
                continue
            along, beyond = min(max(u, 0.0), 1.0) * length, 0.0
        apart = d * d + beyond * beyond
        if apart < best:
            best, best_s, best_d = apart, points[P_S, i] + along, d
    return (best_s, best_d) if best < inf else foot(points, first, last, x, y)


@compiled
def foot(points, first, last, x, y):
    """s and d [m] of a position by the nearest point of the centre line: where there are no coordinates."""
    best, best_s, best_d = inf, nan, nan
    for i in range(first, last + 1):
        apart, along, d = beside(points, i, x, y)
        if apart < best:
            best, best_s, best_d = apart, points[P_S, i] + along, copysign(sqrt(apart), d)
    return best_s, best_d


@compiled
def beside(points, i, x, y):
    """Square of the distance from a piece [m²], where on it the nearest point lies [m], offset from its line [m]."""
    dx, dy = x - points[P_X, i], y - points[P_Y, i]
    t = dx * points[P_EAST, i] + dy * points[P_NORTH, i]
    d = dy * points[P_EAST, i] - dx * points[P_NORTH, i]
    along = min(max(t, 0.0), points[P_S, i + 1] - points[P_S, i])
    return d * d + (t - along) * (t - along), along, d


@compiled
def nearest_lane(index, m, x, y, heading, reach):
    """Lane, s and d [m] of the place nearest to a position on map m, within `reach` [m]; lane NONE when there is none.

    Only lanes whose direction is within 90° of `heading` [rad] are looked at, all if that is not a number.
    """
    i, _ = nearest_piece(index, m, x, y, heading, reach)
    if i < 0:
        return NONE, nan, nan
    lane = index.point_lane[i]
    s, d = lane_place(index, lane, x, y)
    return lane, min(max(s, 0.0), index.lanes[LANE_LENGTH, lane]), d


@compiled
def nearest_piece(index, m, x, y, heading, reach):
    """Column of the nearest piece of a centre line and its distance [m]; of equally near ones the first.

    Cells are looked through in square rings about the position, until no nearer piece can be in the next one.
    """
    frame = index.grid.frame
    columns, rows = int(frame[COLUMNS, m]), int(frame[ROWS, m])
    if columns == 0 or not (abs(x) < FARTHEST and abs(y) < FARTHEST):
        return NONE, inf
    column, row = grid.place(frame, m, x, y)
    inner = margin(frame, m, column, row, x, y)
    best, found = reach * reach, NONE
    east, north, least = (0.0, 0.0, -inf) if isnan(heading) else (cos(heading), sin(heading), 0.0)
    nearest_ring = max(0, max(max(-column, column - columns + 1), max(-row, row - rows + 1)))
    farthest_ring = max(max(column, columns - 1 - column), max(row, rows - 1 - row))
    for ring in range(nearest_ring, farthest_ring + 1):
        gap = (ring - 1) * frame[SIZE, m] + inner
        if ring > 0 and gap * gap > best:
            break
        for j in range(max(row - ring, 0), min(row + ring, rows - 1) + 1):
            whole = j == row - ring or j == row + ring
            for i in range(column - ring, column + ring + 1, 1 if whole or ring == 0 else 2 * ring):
                if 0 <= i < columns:
                    best, found = nearest_in_cell(index, m, j * columns + i, x, y, east, north, least, best, found)
    return found, sqrt(best)


@compiled
def margin(frame, m, column, row, x, y):
    """Distance from a position to the nearest edge of its cell [m]."""
    size = frame[SIZE, m]
    east = x - frame[WEST, m] - column * size
    north = y - frame[SOUTH, m] - row * size
    return max(min(min(east, size - east), min(north, size - north)), 0.0)


@compiled
def nearest_in_cell(index, m, cell, x, y, east, north, least, best, found):
    """The best square of a distance [m²] and its piece, with those of one more cell that lead more than `least` that way."""
    points, cells = index.points, index.grid
    number = int(cells.frame[CELLS, m]) + cell
    for k in range(cells.first[number], cells.first[number + 1]):
        i = cells.item[k]
        if east * points[P_EAST, i] + north * points[P_NORTH, i] <= least:
            continue
        apart, _, _ = beside(points, i, x, y)
        if apart < best or (apart == best and (found == NONE or i < found)):
            best, found = apart, i
    return best, found
