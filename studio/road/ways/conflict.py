"""Where two paths run close to each other: zones for following, merging and crossing."""

import numpy as np

from studio.compiled import compiled
from studio.road.ways.path import PATH_SPACING, PATH_X, PATH_Y

BLOCK = 32  # points that share one bounding box
MOST_ZONES = 64  # of one pair of paths
ALONG, ACROSS, AGAINST = range(3)  # how the other drives there: with oneself, crossing, towards oneself
GIVE, TAKE, EQUAL, NONE = range(4)  # who goes first where both come at once: the other, oneself, the first; they part, or follow each other
SHARED, SHARED_FIRST, SHARED_LAST = range(4, 7)  # lanes of both directions on one ground: who comes first, and by sign oneself, the other
ENTER_I, EXIT_I, ENTER_J, EXIT_J = range(4)


@compiled
def zones(points, first_i, count_i, first_j, count_j, width=2.4):
    """Intervals in which two paths run within `width` [m] of each other.

    A zone is a set of pairs (s_i, s_j) that hang together: a path that passes the other one twice makes two zones.

    Args:
        points: point array of all paths, float64[PATH_ROWS, total].
        first_i: column at which path i starts; `count_i` points follow. The same for j.

    Returns:
        float64[k, 4] of s_i enter, s_i exit, s_j enter, s_j exit [m], in the order of s_i enter.
    """
    found = np.empty((MOST_ZONES, 4))
    open_from = np.empty(MOST_ZONES, np.int64)  # columns j that the row before left open, by zone
    open_to = np.empty(MOST_ZONES, np.int64)
    open_row = np.full(MOST_ZONES, -9, np.int64)
    total = 0
    for block_i in range(0, count_i, BLOCK):
        end_i = min(block_i + BLOCK, count_i)
        low_x, high_x, low_y, high_y = box(points, first_i + block_i, first_i + end_i, width)
        low, high = reach(points, first_j, count_j, low_x, high_x, low_y, high_y)
        if low >= high:
            continue
        for i in range(block_i, end_i):
            x, y = points[PATH_X, first_i + i], points[PATH_Y, first_i + i]
            j = low
            while j < high:
                gap = hypotenuse(points[PATH_X, first_j + j] - x, points[PATH_Y, first_j + j] - y)
                if gap >= width:
                    j += max(1, int((gap - width) / PATH_SPACING))
                    continue
                start = j
                while j < high and hypotenuse(points[PATH_X, first_j + j] - x, points[PATH_Y, first_j + j] - y) < width:
                    j += 1
                total = extend(found, open_from, open_to, open_row, total, i, start, j - 1)
    for zone in range(total):
        sharpen(points, first_i, count_i, first_j, count_j, width, found, zone)
    return found[:total].copy()


@compiled
def hypotenuse(x, y):
    """Distance [m]; unlike np.hypot without care for overflow, and much faster."""
    return np.sqrt(x * x + y * y)


@compiled
def box(points, start, end, margin):
    """Bounding box of the points from column `start` to before `end`."""
    low_x, high_x, low_y, high_y = np.inf, -np.inf, np.inf, -np.inf
    for column in range(start, end):
        low_x, high_x = min(low_x, points[PATH_X, column]), max(high_x, points[PATH_X, column])
        low_y, high_y = min(low_y, points[PATH_Y, column]), max(high_y, points[PATH_Y, column])
    return low_x - margin, high_x + margin, low_y - margin, high_y + margin


@compiled
def reach(points, first, count, low_x, high_x, low_y, high_y):
    """The stretch of a path that holds all its points within a box, as two indices."""
    low, high = count, 0
    j = 0
    while j < count:
        x, y = points[PATH_X, first + j], points[PATH_Y, first + j]
        away = max(low_x - x, x - high_x, low_y - y, y - high_y)
        if away <= 0.0:
            low, high = min(low, j), j + 1
        j += max(1, int(away / PATH_SPACING))
    return low, high


@compiled
def extend(found, open_from, open_to, open_row, total, i, start, end):
    """Adds the pairs (i, start to end) to the zones they touch, or begins one; zones that meet become one."""
    home = -1
    for zone in range(total):
        touches = open_row[zone] >= i - 1 and start <= open_to[zone] + 1 and end >= open_from[zone] - 1
        if touches and home < 0:
            home = zone
        elif touches:
            found[home, ENTER_I] = min(found[home, ENTER_I], found[zone, ENTER_I])
            found[home, ENTER_J] = min(found[home, ENTER_J], found[zone, ENTER_J])
            found[home, EXIT_J] = max(found[home, EXIT_J], found[zone, EXIT_J])
            total = remove(found, open_from, open_to, open_row, total, zone)
            break
    if home < 0:
        if total == MOST_ZONES:
            return total
        home, total = total, total + 1
        open_row[home] = -9
        found[home, ENTER_I] = i
        found[home, ENTER_J], found[home, EXIT_J] = start, end
    found[home, EXIT_I] = i
    found[home, ENTER_J] = min(found[home, ENTER_J], start)
    found[home, EXIT_J] = max(found[home, EXIT_J], end)
    if open_row[home] == i:
        start, end = min(start, open_from[home]), max(end, open_to[home])
    open_from[home], open_to[home], open_row[home] = start, end, i
    return total


@compiled
def remove(found, open_from, open_to, open_row, total, zone):
    """Takes a zone out of the list, keeping the order of the others."""
    for k in range(zone, total - 1):
        found[k] = found[k + 1]
        open_from[k], open_to[k], open_row[k] = open_from[k + 1], open_to[k + 1], open_row[k + 1]
    return total - 1


@compiled
def sharpen(points, first_i, count_i, first_j, count_j, width, found, zone):
    """Moves the ends of a zone from whole metres to where the distance is just `width`."""
    low_i, high_i = int(found[zone, ENTER_I]), int(found[zone, EXIT_I])
    low_j, high_j = int(found[zone, ENTER_J]), int(found[zone, EXIT_J])
    found[zone, ENTER_I] -= part(points, first_i, count_i, low_i, -1, first_j, count_j, low_j, high_j, width)
    found[zone, EXIT_I] += part(points, first_i, count_i, high_i, 1, first_j, count_j, low_j, high_j, width)
    found[zone, ENTER_J] -= part(points, first_j, count_j, low_j, -1, first_i, count_i, low_i, high_i, width)
    found[zone, EXIT_J] += part(points, first_j, count_j, high_j, 1, first_i, count_i, low_i, high_i, width)


@compiled
def part(points, first, count, at, step, first_other, count_other, low, high, width):
    """How much of the metre from point `at` in direction `step` is still within `width` of the other's stretch."""
    if at + step < 0 or at + step >= count:
        return 0.0
    inner = gap(points, first + at, first_other, count_other, low, high)
    outer = gap(points, first + at + step, first_other, count_other, low, high)
    if outer <= inner or inner >= width:
        return 0.0
    return min(1.0, (width - inner) / (outer - inner)) * PATH_SPACING


@compiled
def gap(points, column, first, count, low, high):
    """Distance of a point from the stretch of a path around the points low to high [m]."""
    best = np.inf
    for j in range(max(0, low - 2), min(count - 1, high + 2)):
        a_x, a_y = points[PATH_X, first + j], points[PATH_Y, first + j]
        t_x, t_y = points[PATH_X, first + j + 1] - a_x, points[PATH_Y, first + j + 1] - a_y
        d_x, d_y = points[PATH_X, column] - a_x, points[PATH_Y, column] - a_y
        u = min(1.0, max(0.0, (d_x * t_x + d_y * t_y) / (t_x * t_x + t_y * t_y)))
        best = min(best, hypotenuse(d_x - u * t_x, d_y - u * t_y))
    return best
