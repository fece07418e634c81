"""The ground under every wheel: its height and slope, by the vehicle's path, and its friction, by weather and by slippery
stretches of the roads. Two passes a tick.

A road has no slope across: under a wheel lies the plane that touches the path beside it.

A stretch is cut into pieces one metre long, across a width or one half of it; they count while their entry of the script acts. Where
stretches overlap, the later one of the file counts.
"""

from math import cos, sin

import numpy as np

from studio.compiled import inlined, lean
from studio.model import elementary
from studio.road.ways.path import (
    PATH_HEADING,
    PATH_HEIGHT,
    PATH_SLOPE,
    PATH_SPACING,
    PATH_X,
    PATH_Y,
)
from studio.road.ways.path import Path as RoadPath
from studio.vehicle.contact import HEIGHT, MU, SLOPE_X, SLOPE_Y
from studio.vehicle.corner import side_of
from studio.vehicle.parameter import L_F, L_R, TRACK_F, TRACK_R
from studio.vehicle.state import PSI, X, Y
from studio.world.effect import Slippery
from studio.world.passes.fetch import EARLY, fetch
from studio.world.table.street import (
    PIECE,
    PIECE_ACTS,
    PIECE_ENTRY,
    PIECE_FRICTION,
    PIECE_HEADING,
    PIECE_LEFT,
    PIECE_RIGHT,
    PIECE_WORLD,
    PIECE_X,
    PIECE_Y,
)  # fmt: skip

NEAR = 12.0  # [m] a piece farther from the centre of gravity is under no wheel
BEHIND, STRIDE, WINDOW = 4, 1, 10  # points behind a station from which on they are fetched, from one to the next, how many
MOST_NEAR = 1000  # pieces that are looked at for one vehicle


@inlined
def blend(points, row, column, f):
    """The value of a row at the share f of the way from a column to the next, as `interpolate` in studio/road/ways/path.py has it."""
    return points[row, column] if f == 0.0 else (1.0 - f) * points[row, column] + f * points[row, column + 1]


@inlined
def plane(s, points, first, count):
    """The plane that touches a path at station s [m], z = height + slope_x x + slope_y y: height, slope_x, slope_y.

    Most paths rise nowhere but on a bridge: there is no need to know where a level one leads.
    """
    at = min(max(s, 0.0), (count - 1.001) * PATH_SPACING)
    column, f = first + int(at), at - int(at)
    slope = blend(points, PATH_SLOPE, column, f)
    if slope == 0.0:
        return blend(points, PATH_HEIGHT, column, f), 0.0, 0.0
    heading = blend(points, PATH_HEADING, column, f)
    g_x, g_y = slope * elementary.cos(heading), slope * elementary.sin(heading)
    level = g_x * blend(points, PATH_X, column, f) + g_y * blend(points, PATH_Y, column, f)
    return blend(points, PATH_HEIGHT, column, f) - level, g_x, g_y


@inlined
def put(w, found, ground):
    """Lays a plane under one wheel."""
    ground[HEIGHT, w], ground[SLOPE_X, w], ground[SLOPE_Y, w] = found


@lean
def touch_all(v, n, s, points, first, count, ground):
    """The same plane under all wheels of one vehicle."""
    found = plane(s, points, first, count)
    for corner in range(4):
        put(corner * n + v, found, ground)


@lean
def rise(state, parameter, station, points, path_first, path_count, raised, ground):
    """First pass: height and slope of vehicles whose path is `raised`, one plane under an axle; the others' ground stays level."""
    n = state.shape[1]
    for v in range(n):
        if v + EARLY < n:
            bring(station[v + EARLY], points, path_first[v + EARLY])
        if raised[v] != 0:
            front = plane(station[v] + parameter[L_F, v], points, path_first[v], path_count[v])
            rear = plane(station[v] - parameter[L_R, v], points, path_first[v], path_count[v])
            for side in range(2):
                put(side * n + v, front, ground)
                put((2 + side) * n + v, rear, ground)


@inlined
def bring(station, points, first):
    """Fetches what is known of the road around a station [m], from behind the own rear axle to before the front one."""
    for k in range(WINDOW):
        fetch(points, 0, first + int(station) - BEHIND + k * STRIDE)


def is_raised(path: RoadPath) -> bool:
    """Whether a path is not level at height 0 all along."""
    return bool(path.points[PATH_HEIGHT].any())


def pieces(effect: Slippery, path: RoadPath, world: int, entry: int) -> np.ndarray:
    """float64[PIECE, n] of a slippery stretch along its path."""
    stretch = effect.stretch
    stations = np.arange(stretch.start + 0.5 * PATH_SPACING, stretch.end, PATH_SPACING)
    grid = np.arange(path.points.shape[1]) * PATH_SPACING
    made = np.zeros((len(PIECE), stations.size))
    for row, source in ((PIECE_X, PATH_X), (PIECE_Y, PATH_Y), (PIECE_HEADING, PATH_HEADING)):
        made[row] = np.interp(stations, grid, path.points[source])
    made[PIECE_LEFT], made[PIECE_RIGHT] = effect.left, effect.right
    made[PIECE_FRICTION], made[PIECE_WORLD], made[PIECE_ENTRY] = effect.friction, world, entry
    return made


@lean
def covers(i, x, y, table):
    """Whether a piece lies under a point [m]."""
    c, s = cos(table[PIECE_HEADING, i]), sin(table[PIECE_HEADING, i])
    dx, dy = x - table[PIECE_X, i], y - table[PIECE_Y, i]
    forward, left = dx * c + dy * s, dy * c - dx * s
    return abs(forward) <= 0.5 * PATH_SPACING and -table[PIECE_RIGHT, i] <= left <= table[PIECE_LEFT, i]


@lean
def friction_at(x, y, friction, near, found, table):
    """Friction [1] at a point: the last of the pieces `near` it that cover it, else that of the weather."""
    for j in range(found):
        if covers(near[j], x, y, table):
            friction = table[PIECE_FRICTION, near[j]]
    return friction


@inlined
def friction_on(world, x, y, weather, table):
    """Friction [1] of the ground at any point of a world: of what acts there, the last of the file, else that of the weather."""
    friction = weather[world]
    for i in range(table.shape[1]):
        if table[PIECE_WORLD, i] == world and table[PIECE_ACTS, i] > 0.0 and covers(i, x, y, table):
            friction = table[PIECE_FRICTION, i]
    return friction


@lean
def near_pieces(v, world, state, table, near):
    """Fills `near` with the pieces around a vehicle that act; how many there are."""
    found = 0
    for i in range(table.shape[1]):
        dx, dy = table[PIECE_X, i] - state[X, v], table[PIECE_Y, i] - state[Y, v]
        is_near = table[PIECE_WORLD, i] == world and dx * dx + dy * dy < NEAR * NEAR
        if is_near and table[PIECE_ACTS, i] > 0.0 and found < near.size:
            near[found] = i
            found += 1
    return found


@lean
def lay(state, parameter, world_of, weather, table, near, ground):
    """Second pass: friction under all wheels; weather float64[world]."""
    n = state.shape[1]
    for v in range(n):
        found = near_pieces(v, world_of[v], state, table, near)
        if found == 0:
            for corner in range(4):
                ground[MU, corner * n + v] = weather[world_of[v]]
            continue
        c, s = cos(state[PSI, v]), sin(state[PSI, v])
        for corner in range(4):
            x = parameter[L_F, v] if corner < 2 else -parameter[L_R, v]
            y = 0.5 * side_of(corner) * (parameter[TRACK_F, v] if corner < 2 else parameter[TRACK_R, v])
            at_x, at_y = state[X, v] + x * c - y * s, state[Y, v] + x * s + y * c
            ground[MU, corner * n + v] = friction_at(at_x, at_y, weather[world_of[v]], near, found, table)
