"""What buildings hide: how much of a straight line lies in them, and how much of the sky they cover.

    walls    float64[4, w]   x0, y0, x1, y1 of all outlines and holes, building after building, the inside on the left
    bodies   float64[b, 6]   base and top [m]; the middle of the upright box around it, and half its extent to the east and north
    spans    int64[b, 6]     first wall and count; columns and rows of the grid that the building reaches over
    grid                     which buildings lie in a cell
    tops     float64[g]      of the cells of the grid, how high [m] the tallest of them rises above an eye
    sky      float64[c]      share of open sky + 1 where it has been asked for, else 0; cells of SKY_CELL within those of the grid
    mass     uint8[c]        of the same cells what stands there at the height of an eye: OPEN, PARTLY or wholly FULL of a building
    filled   int32[c]        of the same cells, row after row, how many that are not OPEN lie up to its column and its row (F. C. Crow,
                             Summed-area tables for texture mapping, SIGGRAPH 1984): four of these tell how many lie in any upright box

A line is looked at from its western end, so that both directions give the same bits. Several maps are joined like those of
an `Index`. Maps without buildings have no cells.
"""

from collections.abc import Iterator, Sequence
from math import cos, floor, inf, pi, sin, sqrt
from typing import NamedTuple

import numpy as np

from studio.compiled import inlined, lean
from studio.road import kept
from studio.road.network import Building, Lane, Network, curve, grid
from studio.road.network.grid import CELLS, COLUMNS, MARGIN, ROWS, SIZE, SOUTH, WEST, Grid, columns_passed, place, rows_passed
from studio.road.network.index import once

BASE, TOP, BOX_X, BOX_Y, HALF_X, HALF_Y = range(6)
WALL_FIRST, WALL_COUNT, COLUMN_LOW, COLUMN_HIGH, ROW_LOW, ROW_HIGH = range(6)

CELL = 32.0  # [m]
SKY_CELL = 4.0  # [m]
ASIDE = 1.0  # [m] from the middle of a lane, cars are mostly not farther
FINER = int(CELL / SKY_CELL)
SKY_REACH = 200.0  # [m] farther buildings hardly rise over nearer ones
AZIMUTHS = 24
EYE = 1.5  # [m] antennas and eyes of cars above the road
OPEN, PARTLY, FULL = range(3)


class Shadow(NamedTuple):
    """All buildings of one or several maps."""

    walls: np.ndarray
    bodies: np.ndarray
    spans: np.ndarray
    grid: Grid
    tops: np.ndarray  # per cell
    sky: np.ndarray
    mass: np.ndarray
    filled: np.ndarray


@once
def shadow_of(network: Network) -> Shadow:
    """The buildings of a map, and the sky over its lanes; kept on disk."""
    return kept.of_map(network.digest, "shadows", Shadow, lambda: made(network), *content(network.scenery.buildings), maker=__file__)


def content(buildings: Sequence[Building]) -> Iterator[bytes]:
    """All that is looked at of buildings."""
    for each in buildings:
        yield from (ring.tobytes() for ring in (each.outline, *each.holes))
        yield np.array([each.base, each.height]).tobytes()


def made(network: Network) -> Shadow:
    """The same, made anew."""
    found = shadow(network.scenery.buildings)
    for lane in network.lanes:
        look_up(found, *along(lane))
    return found


def along(lane: Lane) -> np.ndarray:
    """Places all along the middle of a lane and beside it, where cars are [m], float64[2, n]."""
    line = curve.resampled(lane.centre, 0.5 * ASIDE)
    to = np.gradient(line, axis=1)
    aside = ASIDE * np.array([-to[1], to[0]]) / np.hypot(*to)
    return np.concatenate([line - aside, line, line + aside], axis=1)


def shadow(buildings: Sequence[Building]) -> Shadow:
    """Buildings as arrays; what lies above an antenna hides nothing from it on the ground, but hides the sky."""
    walls = [walls_of(each) for each in buildings]
    counts = np.array([own.shape[1] for own in walls], dtype=np.int64)
    flat = np.concatenate([np.empty((4, 0)), *walls], axis=1)
    frame = grid.frame_around(flat[0], flat[1], size=CELL, margin=SKY_REACH)
    spans = np.zeros((len(walls), 6), dtype=np.int64)
    spans[:, WALL_FIRST], spans[:, WALL_COUNT] = np.cumsum(counts) - counts, counts
    for b, own in enumerate(walls):
        low = grid.place(frame, 0, own[0].min() - grid.MARGIN, own[1].min() - grid.MARGIN)
        high = grid.place(frame, 0, own[0].max() + grid.MARGIN, own[1].max() + grid.MARGIN)
        spans[b, [COLUMN_LOW, COLUMN_HIGH, ROW_LOW, ROW_HIGH]] = low[0], high[0], low[1], high[1]
    cells = int(frame[COLUMNS, 0] * frame[ROWS, 0]) * FINER**2
    bodies = bodies_of(buildings, walls)
    lists = grid.over_boxes(frame, spans[:, COLUMN_LOW:].T)
    made = Shadow(
        walls=flat,
        bodies=bodies,
        spans=spans,
        grid=lists,
        tops=tallest(bodies, lists),
        sky=np.zeros(cells),
        mass=np.zeros(cells, dtype=np.uint8),
        filled=np.zeros(cells, dtype=np.int32),
    )
    fill(made)
    made.filled[:] = summed(frame, made.mass)
    return made


def bodies_of(buildings: Sequence[Building], walls: Sequence[np.ndarray]) -> np.ndarray:
    """Heights and boxes of buildings."""
    low, high = (np.array([end(own[:2], axis=1) for own in walls]).reshape(-1, 2).T for end in (np.min, np.max))
    heights = np.array([(each.base, each.height) for each in buildings], dtype=float).reshape(-1, 2).T
    return np.concatenate([heights, 0.5 * (low + high), 0.5 * (high - low) + grid.MARGIN]).T.copy()


def tallest(bodies: np.ndarray, lists: Grid) -> np.ndarray:
    """How high [m] the tallest building of every cell rises above an eye; 0 where none does."""
    tops = np.zeros(lists.first.size - 1)
    np.maximum.at(tops, np.repeat(np.arange(tops.size), np.diff(lists.first)), bodies[lists.item, TOP] - EYE)
    return tops


def walls_of(building: Building) -> np.ndarray:
    """The walls of a building, the inside on the left of each."""
    rings = [turned(building.outline, left=True), *(turned(hole, left=False) for hole in building.holes)]
    return np.concatenate([np.concatenate([ring, np.roll(ring, -1, axis=1)]) for ring in rings], axis=1)


def turned(ring: np.ndarray, *, left: bool) -> np.ndarray:
    """An open ring, counter-clockwise if its inside is to be on the left."""
    x, y = ring
    area = float((x * np.roll(y, -1) - np.roll(x, -1) * y).sum())
    return ring if (area > 0.0) == left else ring[:, ::-1]


def joined(shadows: Sequence[Shadow]) -> Shadow:
    """The buildings of several maps; their order is the number of a map."""
    bodies, walls = (
        np.concatenate([[0], np.cumsum(sizes)[:-1]]).astype(np.int64)
        for sizes in np.array([(each.bodies.shape[0], each.walls.shape[1]) for each in shadows]).T
    )
    spans = [each.spans.copy() for each in shadows]
    for own, first in zip(spans, walls, strict=True):
        own[:, WALL_FIRST] += first
    return Shadow(
        walls=np.concatenate([each.walls for each in shadows], axis=1),
        bodies=np.concatenate([each.bodies for each in shadows]),
        spans=np.concatenate(spans),
        grid=grid.joined([each.grid for each in shadows], bodies.tolist()),
        tops=np.concatenate([each.tops for each in shadows]),
        sky=np.concatenate([each.sky for each in shadows]),
        mass=np.concatenate([each.mass for each in shadows]),
        filled=np.concatenate([each.filled for each in shadows]),
    )


# -- along a line ----------------------------------------------------------------------------------


@lean
def walls_between(shadow, m, x0, y0, z0, x1, y1, z1):
    """Walls that a straight line on map m crosses, and the metres of it that lie inside buildings."""
    frame = shadow.grid.frame
    walls, inside = 0, 0.0
    if frame[COLUMNS, m] == 0.0:
        return walls, inside
    if x0 > x1 or (x0 == x1 and y0 > y1):
        x0, y0, z0, x1, y1, z1 = x1, y1, z1, x0, y0, z0
    low, high = columns_passed(frame, m, x0, x1)
    south, north = 0, -1  # rows that the line passes in the column before
    for column in range(low, high + 1):
        first, last = rows_passed(frame, m, column, x0, y0, x1, y1)
        for row in range(first, last + 1):
            cell = int(frame[CELLS, m]) + row * int(frame[COLUMNS, m]) + column
            for k in range(shadow.grid.first[cell], shadow.grid.first[cell + 1]):
                b = shadow.grid.item[k]
                if not is_passed_before(shadow.spans, b, column, row, first, low, south, north):
                    crossed, share = through(shadow, b, x0, y0, z0, x1, y1, z1)
                    walls, inside = walls + crossed, inside + share
        south, north = first, last
    length = sqrt((x1 - x0) * (x1 - x0) + (y1 - y0) * (y1 - y0) + (z1 - z0) * (z1 - z0))
    return walls, inside * length


@lean
def is_passed_before(spans, b, column, row, first, low, south, north):
    """Whether a line has met building b before this cell, in this column or in the one before, where it passed rows south to north.

    A building lies in a rectangle of cells, and the line leaves that only once.
    """
    if row > max(first, spans[b, ROW_LOW]):
        return True
    return column > max(low, spans[b, COLUMN_LOW]) and south <= spans[b, ROW_HIGH] and north >= spans[b, ROW_LOW]


@lean
def through(shadow, b, x0, y0, z0, x1, y1, z1):
    """Walls of building b that a line crosses, and the share of the line that lies inside it.

    Along the line, t from 0 to 1, the inside adds up to the sum of t where it is left minus that where it is entered, t held
    within the part of the line that is neither above nor below the building.
    """
    begin, end = level(z0, z1, shadow.bodies[b, BASE], shadow.bodies[b, TOP])
    if begin >= end:
        return 0, 0.0
    dx, dy = x1 - x0, y1 - y0
    crossed, balance, share, starts_inside = 0, 0, 0.0, False
    for i in range(shadow.spans[b, WALL_FIRST], shadow.spans[b, WALL_FIRST] + shadow.spans[b, WALL_COUNT]):
        a_x, a_y, b_x, b_y = shadow.walls[0, i] - x0, shadow.walls[1, i] - y0, shadow.walls[2, i] - x0, shadow.walls[3, i] - y0
        if (a_y > 0.0) != (b_y > 0.0) and (a_x * b_y - b_x * a_y > 0.0) == (b_y > a_y):
            starts_inside = not starts_inside
        side_a, side_b = dx * a_y - dy * a_x, dx * b_y - dy * b_x
        if (side_a > 0.0) == (side_b > 0.0):
            continue
        t = (a_x * (b_y - a_y) - a_y * (b_x - a_x)) / (side_b - side_a)
        if 0.0 <= t < 1.0:
            leaves = -1 if side_a > 0.0 else 1
            crossed += 1 if begin <= t <= end else 0
            balance += leaves
            share += leaves * min(max(t, begin), end)
    inside_before = 1 if starts_inside else 0
    return crossed, max(share + (inside_before - balance) * end - inside_before * begin, 0.0)


@lean
def level(z0, z1, base, top):
    """The part of a line from z0 to z1, as two shares of it, that lies between two heights [m]; begin >= end: none."""
    if z0 == z1:
        return (0.0, 1.0) if base <= z0 < top else (1.0, 0.0)
    a, b = (base - z0) / (z1 - z0), (top - z0) / (z1 - z0)
    return max(min(a, b), 0.0), min(max(a, b), 1.0)


# -- the sky ---------------------------------------------------------------------------------------


@lean
def look_up(shadow, xs, ys):
    """Works out the sky above places on the only map."""
    for i in range(xs.size):
        open_sky(shadow, 0, xs[i], ys[i])


@lean
def open_sky(shadow, m, x, y):
    """Share of the sky that is open above a place on map m, to the size of a cell; worked out when first asked for."""
    frame = shadow.grid.frame
    columns, rows = int(frame[COLUMNS, m]) * FINER, int(frame[ROWS, m]) * FINER
    east, north = (x - frame[WEST, m]) / SKY_CELL, (y - frame[SOUTH, m]) / SKY_CELL
    if not (0.0 <= east < columns and 0.0 <= north < rows):
        return 1.0
    i, j = int(east), int(north)
    cell = fine(frame, m, i, j)
    if shadow.sky[cell] == 0.0:
        middle_x, middle_y = frame[WEST, m] + (i + 0.5) * SKY_CELL, frame[SOUTH, m] + (j + 0.5) * SKY_CELL
        shadow.sky[cell] = 1.0 + sky_above(shadow, m, middle_x, middle_y)
    return shadow.sky[cell] - 1.0


@lean
def sky_above(shadow, m, x, y):
    """Share of the hemisphere above a place that no building hides: the mean of 1 - sin(horizon) over all azimuths.

    Above the elevation e lies the share 1 - sin(e) of a sector of the hemisphere. Under a building there is no sky, and below
    one that hangs in the air none is counted.
    """
    if is_under_roof(shadow, m, x, y):
        return 0.0
    hidden = 0.0
    for k in range(AZIMUTHS):
        angle = 2.0 * pi * (k + 0.5) / AZIMUTHS
        rise = steepest(shadow, m, x, y, SKY_REACH * cos(angle), SKY_REACH * sin(angle))
        hidden += rise / sqrt(1.0 + rise * rise)
    return 1.0 - hidden / AZIMUTHS


@lean
def is_under_roof(shadow, m, x, y):
    """Whether a place lies in a building, or below one, that is higher than an eye."""
    column, row = place(shadow.grid.frame, m, x, y)
    at = cell_of(shadow.grid.frame, m, column, row)
    for k in range(shadow.grid.first[at], shadow.grid.first[at + 1]) if at >= 0 else range(0):
        b = shadow.grid.item[k]
        if shadow.bodies[b, TOP] > EYE and is_within(shadow, b, x, y):
            return True
    return False


@inlined
def cell_of(frame, m, column, row):
    """The number of a cell; -1 for one that is not in the grid."""
    columns = int(frame[COLUMNS, m])
    if 0 <= column < columns and 0 <= row < int(frame[ROWS, m]):
        return int(frame[CELLS, m]) + row * columns + column
    return -1


@inlined
def fine(frame, m, i, j):
    """The number of a cell of SKY_CELL by its column and row: those of one cell of the grid stand together, as lines pass them."""
    cell = int(frame[CELLS, m]) + (j // FINER) * int(frame[COLUMNS, m]) + i // FINER
    return (cell * FINER + j % FINER) * FINER + i % FINER


@inlined
def steepest(shadow, m, x, y, dx, dy):
    """Greatest rise [1] from an eye at x, y to the top of a building on a line of SKY_REACH (dx, dy) from there.

    The line is walked outwards from cell to cell, as in `walk`: where the tallest building is too low to rise over what is nearer, none is
    looked at.
    """
    frame, rise, far = shadow.grid.frame, 0.0, 0.0
    size = frame[SIZE, m]
    column, row = place(frame, m, x, y)
    last_column, last_row = -1, -1
    along_x, along_y = passing(x - frame[WEST, m], column, dx, size), passing(y - frame[SOUTH, m], row, dy, size)
    while far <= 1.0:
        at = cell_of(frame, m, column, row)
        if at >= 0 and shadow.tops[at] > rise * (far * SKY_REACH - MARGIN):
            rise = steepest_in(shadow, at, last_column, last_row, rise, x, y, dx, dy)
        far, last_column, last_row = min(along_x, along_y), column, row
        if along_x < along_y:
            column, along_x = column + (1 if dx > 0.0 else -1), along_x + size / abs(dx)
        else:
            row, along_y = row + (1 if dy > 0.0 else -1), along_y + size / abs(dy)
    return rise


@inlined
def passing(begin, at, step, size):
    """The share of a line at which it leaves its first cell; `begin` [m] from the first edge of all, `step` [m] its length that way."""
    return ((at + 1 if step > 0.0 else at) * size - begin) / step if step != 0.0 else inf


@inlined
def steepest_in(shadow, at, last_column, last_row, rise, x, y, dx, dy):
    """The same with the buildings of one cell that do not reach into the cell before, where they have been looked at."""
    for k in range(shadow.grid.first[at], shadow.grid.first[at + 1]):
        b = shadow.grid.item[k]
        height = shadow.bodies[b, TOP] - EYE
        if height > 0.0 and may_rise(shadow, b, height, rise, x, y, dx, dy) and not is_over(shadow.spans, b, last_column, last_row):
            rise = max(rise, rise_of(shadow, b, height, x, y, dx, dy))
    return rise


@inlined
def is_over(spans, b, column, row):
    """Whether building b reaches over a cell."""
    return spans[b, COLUMN_LOW] <= column <= spans[b, COLUMN_HIGH] and spans[b, ROW_LOW] <= row <= spans[b, ROW_HIGH]


@inlined
def may_rise(shadow, b, height, rise, x, y, dx, dy):
    """Whether a line from an eye meets the box around building b, and its top could rise higher there than `rise`."""
    east, north = shadow.bodies[b, BOX_X] - x, shadow.bodies[b, BOX_Y] - y
    if misses(shadow.bodies, b, east, north, dx, dy):
        return False
    aside, ahead = max(abs(east) - shadow.bodies[b, HALF_X], 0.0), max(abs(north) - shadow.bodies[b, HALF_Y], 0.0)
    return height * height > rise * rise * (aside * aside + ahead * ahead)


@inlined
def misses(bodies, b, east, north, dx, dy):
    """Whether the straight line (dx, dy) misses the box around building b, whose middle is so far [m] from a place on it."""
    return abs(dx * north - dy * east) > abs(dx) * bodies[b, HALF_Y] + abs(dy) * bodies[b, HALF_X]


@inlined
def rise_of(shadow, b, height, x, y, dx, dy):
    """Rise [1] from an eye to the top of building b, so high [m] above it, over its nearest wall on a line."""
    nearest = inf
    for i in range(shadow.spans[b, WALL_FIRST], shadow.spans[b, WALL_FIRST] + shadow.spans[b, WALL_COUNT]):
        a_x, a_y, b_x, b_y = shadow.walls[0, i] - x, shadow.walls[1, i] - y, shadow.walls[2, i] - x, shadow.walls[3, i] - y
        side_a, side_b = dx * a_y - dy * a_x, dx * b_y - dy * b_x
        if (side_a > 0.0) != (side_b > 0.0):
            t = (a_x * (b_y - a_y) - a_y * (b_x - a_x)) / (side_b - side_a)
            if 0.0 <= t < nearest:
                nearest = t
    return height / max(nearest * SKY_REACH, 1e-9) if nearest < 1.0 else 0.0


# -- at the height of an eye -----------------------------------------------------------------------


@lean
def is_at_eye(shadow, b):
    """Whether building b stands at the height of an eye."""
    return shadow.bodies[b, BASE] < EYE < shadow.bodies[b, TOP]


@lean
def fill(shadow):
    """Notes of the cells of one map what stands there: first the cells within buildings, then those that walls pass."""
    frame = shadow.grid.frame
    for b in range(shadow.bodies.shape[0]):
        if is_at_eye(shadow, b):
            fill_within(shadow, b, frame[WEST, 0], frame[SOUTH, 0])
    for b in range(shadow.bodies.shape[0]):
        if is_at_eye(shadow, b):
            for i in range(shadow.spans[b, WALL_FIRST], shadow.spans[b, WALL_FIRST] + shadow.spans[b, WALL_COUNT]):
                x0, y0, x1, y1 = shadow.walls[0, i], shadow.walls[1, i], shadow.walls[2, i], shadow.walls[3, i]
                walk(frame, shadow.mass, 0, x0, y0, x1, y1, True)


def summed(frame: np.ndarray, mass: np.ndarray) -> np.ndarray:
    """`filled` of one map."""
    rows, columns = int(frame[ROWS, 0]), int(frame[COLUMNS, 0])
    cells = mass.reshape(rows, columns, FINER, FINER) != OPEN
    in_rows = cells.transpose(0, 2, 1, 3).reshape(rows * FINER, columns * FINER)
    return in_rows.cumsum(axis=0, dtype=np.int32).cumsum(axis=1, dtype=np.int32).ravel()


@inlined
def is_clear(frame, filled, m, west, south, east, north):
    """Whether no cell that an upright box on map m [m] reaches into has a building at the height of an eye."""
    columns, rows = int(frame[COLUMNS, m]) * FINER, int(frame[ROWS, m]) * FINER
    first, last = int(floor((west - frame[WEST, m]) / SKY_CELL)) - 1, int(floor((east - frame[WEST, m]) / SKY_CELL))
    below, top = int(floor((south - frame[SOUTH, m]) / SKY_CELL)) - 1, int(floor((north - frame[SOUTH, m]) / SKY_CELL))
    last, top = min(last, columns - 1), min(top, rows - 1)
    if last < 0 or top < 0:
        return True
    cell = int(frame[CELLS, m]) * FINER * FINER
    found = filled[cell + top * columns + last]
    if found == 0:
        return True
    first, below = min(first, last), min(below, top)
    if first >= 0:
        found -= filled[cell + top * columns + first]
    if below >= 0:
        found -= filled[cell + below * columns + last]
    if first >= 0 and below >= 0:
        found += filled[cell + below * columns + first]
    return found == 0


@lean
def fill_within(shadow, b, west, south):
    """Marks the cells whose middle lies in building b as full of it."""
    for j in range(shadow.spans[b, ROW_LOW] * FINER, (shadow.spans[b, ROW_HIGH] + 1) * FINER):
        for i in range(shadow.spans[b, COLUMN_LOW] * FINER, (shadow.spans[b, COLUMN_HIGH] + 1) * FINER):
            if is_within(shadow, b, west + (i + 0.5) * SKY_CELL, south + (j + 0.5) * SKY_CELL):
                shadow.mass[fine(shadow.grid.frame, 0, i, j)] = FULL


@inlined
def is_within(shadow, b, x, y):
    """Whether a place lies in building b: a line from it to the east crosses an odd number of walls."""
    inside = False
    for i in range(shadow.spans[b, WALL_FIRST], shadow.spans[b, WALL_FIRST] + shadow.spans[b, WALL_COUNT]):
        a_x, a_y, b_x, b_y = shadow.walls[0, i] - x, shadow.walls[1, i] - y, shadow.walls[2, i] - x, shadow.walls[3, i] - y
        if (a_y > 0.0) != (b_y > 0.0) and (a_x * b_y - b_x * a_y > 0.0) == (b_y > a_y):
            inside = not inside
    return inside


@lean
def walk(frame, mass, m, x0, y0, x1, y1, marks):
    """Goes along a line on map m from cell to cell: what stands in the fullest of them; `marks` them as PARTLY full instead.

    From cell to cell as in J. Amanatides, A. Woo, A fast voxel traversal algorithm for ray tracing, Eurographics 1987.
    """
    columns, rows = int(frame[COLUMNS, m]) * FINER, int(frame[ROWS, m]) * FINER
    u, v = (x0 - frame[WEST, m]) / SKY_CELL, (y0 - frame[SOUTH, m]) / SKY_CELL
    du, dv = (x1 - x0) / SKY_CELL, (y1 - y0) / SKY_CELL
    i, j = int(floor(u)), int(floor(v))
    steps = abs(int(floor(u + du)) - i) + abs(int(floor(v + dv)) - j)
    next_u = (i + (1.0 if du > 0.0 else 0.0) - u) / du if du != 0.0 else inf
    next_v = (j + (1.0 if dv > 0.0 else 0.0) - v) / dv if dv != 0.0 else inf
    most = OPEN
    for k in range(steps + 1):
        if 0 <= i < columns and 0 <= j < rows:
            cell = fine(frame, m, i, j)
            if marks:
                mass[cell] = PARTLY
            most = max(most, int(mass[cell]))
        if most == FULL or k == steps:
            return most
        if next_u < next_v:
            i, next_u = i + (1 if du > 0.0 else -1), next_u + abs(1.0 / du)
        else:
            j, next_v = j + (1 if dv > 0.0 else -1), next_v + abs(1.0 / dv)
    return most
