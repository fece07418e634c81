"""Objects on the road: all things of all worlds, and which of them lie in the way of a path."""

from collections.abc import Iterator, Sequence
from itertools import pairwise
from math import cos, sin

import numpy as np
import shapely

from studio.compiled import inlined, lean
from studio.road.network import Crossing
from studio.road.network.plane import lines
from studio.road.ways.path import PATH_HEADING, PATH_HEIGHT, PATH_SPACING, PATH_X, PATH_Y, Path
from studio.world.effect import Walk
from studio.world.line import Lines, starts
from studio.world.passes.level import OTHER_LEVEL
from studio.world.setting import Setting
from studio.world.table.street import (
    ACTING,
    BARRIER,
    CONE,
    O_ENTRY,
    O_HEADING,
    O_HEIGHT,
    O_KIND,
    O_LENGTH,
    O_LEVEL,
    O_LIFT,
    O_SPEED,
    O_WIDTH,
    O_X,
    O_Y,
    OBSTACLE,
    SWEEP,
    ZEBRA,
)
from studio.world.thing import Thing, headings, names, things
from studio.world.world import Movers, Obstacles

NEAR = 3.0  # [m] an object farther from a path is in nobody's way
FLOOR = 1  # rows of what is under a line: the station along it [m], then the floor there as `Floor` names it
EAST, NORTH, AT, ALONG = range(4)  # rows of corners: place [m], station along the line [m], heading of the leg from there on [rad]
WIDEST = 1.6  # [m] half of the widest vehicle, with the distance that drivers keep


def obstacles_of(settings: Sequence[Setting], lines: Lines) -> Obstacles:
    """The objects of all worlds, none standing yet."""
    found, painted = [list(things(each.sites)) for each in settings], [each.network.scenery.crossings for each in settings]
    counts = np.array([len(each) for each in found])
    first, base = starts(counts), starts(np.array([len(each.sites) for each in settings]))
    rows = [
        (each.x, each.y, each.heading, each.length, each.width, each.kind, base[w] + each.entry, 0.0, *each.tread.at(0.0))
        for w, some in enumerate(found)
        for each in some
    ]
    table = np.array(rows).reshape(-1, len(OBSTACLE)).T.copy()
    swept = [sweep(each.path, table, first[each.world], counts[each.world]) for each in lines.laid]
    lengths = np.array([each.shape[1] for each in swept])
    return Obstacles(
        table=table,
        first=first,
        count=counts,
        standing=np.zeros(table.shape[1], dtype=np.int64),
        sweep=np.concatenate([np.zeros((len(SWEEP), 0)), *swept], axis=1),
        counts=lengths,
        sweep_first=starts(lengths)[lines.base],
        sweep_count=lengths[lines.base],
        movers=movers_of([(each, crossings) for some, crossings in zip(found, painted, strict=True) for each in some]),
        names=tuple(name for each, some in zip(settings, found, strict=True) for name in names(each.sites, some)),
    )


def movers_of(found: Sequence[tuple[Thing, tuple[Crossing, ...]]]) -> Movers:
    """Everything that moves among the crossings of its map: the corners of all lines, and the zebra crossings on them."""
    moving = [(i, each.walk, crossings) for i, (each, crossings) in enumerate(found) if each.walk is not None]
    tread, tread_first, tread_count = treads_of([each for each, _ in found if each.walk is not None])
    corners = [corner for _, walk, _ in moving for corner in corners_of(walk)]
    counts = np.array([len(walk.line) for _, walk, _ in moving], dtype=np.int64)
    zebras = [sorted(zebras_on(walk, crossings)) for _, walk, crossings in moving]
    crossed = np.array([len(each) for each in zebras], dtype=np.int64)
    return Movers(
        object=np.array([i for i, _, _ in moving], dtype=np.int64),
        first=np.cumsum(counts) - counts,
        count=counts,
        corner=np.array(corners).reshape(-1, 4).T.copy(),
        speed=np.array([walk.speed for _, walk, _ in moving]),
        stays=np.array([int(walk.stays) for _, walk, _ in moving], dtype=np.int64),
        tread=tread,
        tread_first=tread_first,
        tread_count=tread_count,
        zebra=np.array([row for each in zebras for row in each]).reshape(-1, len(ZEBRA)).T.copy(),
        zebra_first=np.cumsum(crossed) - crossed,
        zebra_count=crossed,
    )


def zebras_on(walk: Walk, crossings: Sequence[Crossing]) -> Iterator[tuple[float, ...]]:
    """float64[ZEBRA] of every zebra crossing without lights over which the line of somebody on foot leads."""
    if walk.who != "pedestrian" or len(walk.line) < 2:
        return
    line = shapely.LineString(walk.line)
    for each in (crossing for crossing in crossings if crossing.marking == "zebra" and not crossing.signalled):
        (x, y), (dx, dy) = each.line.mean(axis=1), np.diff(each.line)[:, 0]
        ground = shapely.LineString(each.line.T).buffer(0.5 * each.width, cap_style="flat")
        for piece in lines(shapely.line_merge(line.intersection(ground))):
            at = shapely.line_locate_point(line, shapely.points(piece[:, [0, -1]].T))
            yield *map(float, sorted(at)), float(x), float(y), float(np.arctan2(dy, dx)), float(np.hypot(dx, dy)), each.width


def treads_of(found: Sequence[Thing]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """What is under the lines of those who move, float64[row, place], and the first and the number of these for each."""
    counts = np.array([each.tread.station.size for each in found], dtype=np.int64)
    rows = np.concatenate([np.zeros((4, 0)), *(np.array(each.tread) for each in found)], axis=1)
    return rows, np.cumsum(counts) - counts, counts


def corners_of(walk: Walk) -> Iterator[tuple[float, float, float, float]]:
    """Place, station and heading from there on of every corner of a line; the last keeps the heading of the leg before it."""
    legs = headings(walk.line)
    stations = np.concatenate([[0.0], np.cumsum([np.hypot(c - a, d - b) for (a, b), (c, d) in pairwise(walk.line)])])
    for (x, y), station, heading in zip(walk.line, stations, [*legs, legs[-1]], strict=False):
        yield x, y, float(station), heading


def movers(settings: Sequence[Setting], first: np.ndarray) -> list[dict[str, int]]:
    """For each world the numbers of what moves among all objects, by the entries of the script that bring it."""
    return [
        {each.sites[thing.entry].name: int(first[w]) + i for i, thing in enumerate(things(each.sites)) if thing.walk is not None}
        for w, each in enumerate(settings)
    ]


def sweep(path: Path, table: np.ndarray, first: int, count: int) -> np.ndarray:
    """float64[SWEEP, n] of the objects that a vehicle on a path may run into, in the order in which it comes to them.

    A path that passes an object twice has it twice.
    """
    met = []
    for i in (i for i in range(first, first + count) if table[O_KIND, i] in (CONE, BARRIER)):  # movers are looked for at every tick
        apart = table[[O_X, O_Y], i, None] - path.points[[PATH_X, PATH_Y]]
        near = np.flatnonzero((np.hypot(*apart) < NEAR) & (np.abs(path.points[PATH_HEIGHT] - table[O_HEIGHT, i]) <= OTHER_LEVEL))
        for run in np.split(near, np.flatnonzero(np.diff(near) > 1) + 1):
            if run.size:
                k = run[np.hypot(*apart[:, run]).argmin()]
                met.append((*passed(apart[:, k], path.points[PATH_HEADING, k], k * PATH_SPACING, table[:, i]), i))
    inside = sorted(each for each in met if each[1] < WIDEST)
    return np.array(inside).reshape(-1, len(SWEEP)).T.copy()


def passed(apart: np.ndarray, heading: float, station: float, row: np.ndarray) -> tuple[float, float, float]:
    """Station [m] at which a path comes to an object that is `apart` from its point, how far aside its edge is, and left its middle."""
    forward = apart[0] * np.cos(heading) + apart[1] * np.sin(heading)
    left = apart[1] * np.cos(heading) - apart[0] * np.sin(heading)
    c, s = abs(np.cos(row[O_HEADING] - heading)), abs(np.sin(row[O_HEADING] - heading))
    along, across = 0.5 * (row[O_LENGTH] * c + row[O_WIDTH] * s), 0.5 * (row[O_LENGTH] * s + row[O_WIDTH] * c)
    return float(station + forward - along), float(abs(left) - across), float(left)


@lean
def put_up(table, phase, held, standing):
    """Objects stand while their entry of the script acts; those of a closed lane are put up once the last car has left it."""
    for i in range(standing.size):
        entry = int(table[O_ENTRY, i])
        acts = phase[entry] == ACTING
        standing[i] = 1 if acts and (standing[i] == 1 or held[entry] == 0) else 0


@lean
def walk(time, turned, mover, first, count, corner, speed, stays, tread, tread_first, tread_count, table, standing):
    """Whoever moves is where he has come since his entry began; one who does not stay is gone at the end of his line."""
    for j in range(mover.size):
        i, last = mover[j], first[j] + count[j] - 1
        if standing[i] == 0:
            continue
        s, k = speed[j] * (time - turned[0, int(table[O_ENTRY, i])]), first[j]
        while k < last and corner[AT, k + 1] <= s:
            k += 1
        beyond = s - corner[AT, k] if k < last else 0.0
        table[O_X, i] = corner[EAST, k] + beyond * cos(corner[ALONG, k])
        table[O_Y, i] = corner[NORTH, k] + beyond * sin(corner[ALONG, k])
        table[O_HEADING, i] = corner[ALONG, k]
        table[O_SPEED, i] = speed[j] if k < last else 0.0
        rise(i, corner[AT, k] + beyond, tread, tread_first[j], tread_first[j] + tread_count[j] - 1, table)
        if k == last and stays[j] == 0 and count[j] > 1:
            standing[i] = 0


@inlined
def rise(i, s, tread, first, last, table):
    """Object i stands on what is under its line at a station [m]; `first` and `last` are the ends of that."""
    k = first
    while k < last - 1 and tread[0, k + 1] <= s:
        k += 1
    share, after = 0.0, min(k + 1, last)
    if after > k and tread[0, after] > tread[0, k]:
        share = min(max((s - tread[0, k]) / (tread[0, after] - tread[0, k]), 0.0), 1.0)
    table[O_HEIGHT, i] = tread[FLOOR, k] + share * (tread[FLOOR, after] - tread[FLOOR, k])
    table[O_LEVEL, i] = tread[FLOOR + 1, k] + share * (tread[FLOOR + 1, after] - tread[FLOOR + 1, k])
    table[O_LIFT, i] = tread[FLOOR + 2, k] + share * (tread[FLOOR + 2, after] - tread[FLOOR + 2, k])
