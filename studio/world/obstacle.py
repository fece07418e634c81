"""Objects on the road: cones and barriers, boxes at rest. Where they stand, and which of them lie in the way of a path.

Sizes: a traffic cone of 0.75 m, and a barrier board on its feet (Absperrschranke, German RSA 21).
"""

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from studio.compiled import lean
from studio.road.ways.detour import Work
from studio.road.ways.path import PATH_HEADING, PATH_SPACING, PATH_X, PATH_Y, Path
from studio.world.effect import Closing, Row
from studio.world.line import Lines, starts
from studio.world.setting import Setting
from studio.world.site import Site
from studio.world.table.street import ACTING, BARRIER, CONE, O_ENTRY, O_HEADING, O_LENGTH, O_WIDTH, O_X, O_Y, OBSTACLE, SWEEP
from studio.world.world import Obstacles

SIZES = {CONE: (0.3, 0.3), BARRIER: (1.5, 0.25)}  # [m] length and width
WORDS = {CONE: "cone", BARRIER: "barrier"}
CONE_SPACING, ROW_SPACING = 3.0, 6.0  # [m] on a taper, along a closed lane
CONE_INSET, ROW_INSET = 0.15, 0.35  # [m] from the edge of the ground that is left to the cars
NEAR = 3.0  # [m] an object farther from a path is in nobody's way
WIDEST = 1.6  # [m] half of the widest vehicle, with the distance that drivers keep


class Thing(NamedTuple):
    """One object: kind, place [m], heading [rad], and the number of the entry of the script that it belongs to."""

    kind: int
    x: float
    y: float
    heading: float
    entry: int


def things(sites: Sequence[Site]) -> Iterator[Thing]:
    """All objects of a script."""
    for number, site in enumerate(sites):
        for each in site.laid:
            if isinstance(each.effect, Row):
                yield from row(each.effect, each.line, number)
            elif isinstance(each.effect, Closing) and each.work:
                yield from fence(each.work, each.edges, number)


def row(effect: Row, line: Path, number: int) -> Iterator[Thing]:
    """Objects along a stretch."""
    kind = {"cones": CONE, "barriers": BARRIER}[effect.what]
    for station in np.arange(effect.stretch.start, effect.stretch.end + 1e-9, effect.spacing):
        yield beside(line, station, effect.offset, kind, number)


def fence(work: Work, edges: tuple[int, ...], number: int) -> Iterator[Thing]:
    """What a lane is closed with: cones on the taper, boards across both ends, a row of them along its open sides."""
    for end, inwards in ((work.start, 1.0), (work.end, -1.0)):
        for aside in (-1.0, 1.0):
            offset = aside * 0.26 * work.width
            yield beside(work.line, end + inwards, offset, BARRIER, number, turned=0.5 * np.pi)
    for side in edges:
        for station in np.arange(work.start + ROW_SPACING, work.end - 0.5 * ROW_SPACING, ROW_SPACING):
            yield beside(work.line, station, side * (0.5 * work.width - ROW_INSET), BARRIER, number)
    if work.target is not None and work.side in edges:
        stations = np.arange(work.start - work.taper, work.start, CONE_SPACING)
        for station, edge in zip(stations, work.edge(stations), strict=True):
            yield beside(work.line, station, edge - work.side * CONE_INSET, CONE, number)


def beside(line: Path, station: float, offset: float, kind: int, entry: int, *, turned: float = 0.0) -> Thing:
    """An object at a station of a line, `offset` [m] to its left, its length along the line or `turned` [rad] from it."""
    grid = np.arange(line.points.shape[1]) * PATH_SPACING
    x, y, heading = (float(np.interp(station, grid, line.points[row])) for row in (PATH_X, PATH_Y, PATH_HEADING))
    return Thing(kind, x - offset * np.sin(heading), y + offset * np.cos(heading), heading + turned, entry)


def obstacles_of(settings: Sequence[Setting], lines: Lines) -> Obstacles:
    """The objects of all worlds, none standing yet."""
    found = [list(things(each.sites)) for each in settings]
    counts = np.array([len(each) for each in found])
    first, base = starts(counts), starts(np.array([len(each.sites) for each in settings]))
    rows = [
        (each.x, each.y, each.heading, *SIZES[each.kind], each.kind, base[w] + each.entry) for w, some in enumerate(found) for each in some
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
        names=tuple(name for each, some in zip(settings, found, strict=True) for name in names(each.sites, some)),
    )


def names(sites: Sequence[Site], found: list[Thing]) -> Iterator[str]:
    """What each is called: barrier_3 of roadworks."""
    seen: dict[tuple[int, int], int] = {}
    for each in found:
        key = (each.entry, each.kind)
        seen[key] = seen.get(key, 0) + 1
        yield f"{WORDS[each.kind]}_{seen[key]} of {sites[each.entry].name}"


def sweep(path: Path, table: np.ndarray, first: int, count: int) -> np.ndarray:
    """float64[SWEEP, n] of the objects that a vehicle on a path may run into, in the order in which it comes to them.

    A path that passes an object twice has it twice.
    """
    met = []
    for i in range(first, first + count):
        apart = table[[O_X, O_Y], i, None] - path.points[[PATH_X, PATH_Y]]
        near = np.flatnonzero(np.hypot(*apart) < NEAR)
        for run in np.split(near, np.flatnonzero(np.diff(near) > 1) + 1):
            if run.size:
                k = run[np.hypot(*apart[:, run]).argmin()]
                met.append((*passed(apart[:, k], path.points[PATH_HEADING, k], k * PATH_SPACING, table[:, i]), i))
    inside = sorted(each for each in met if each[1] < WIDEST)
    return np.array(inside).reshape(-1, len(SWEEP)).T.copy()


def passed(apart: np.ndarray, heading: float, station: float, row: np.ndarray) -> tuple[float, float]:
    """Station [m] at which a path comes to an object that is `apart` from its point, and how far aside its edge stays [m]."""
    forward = apart[0] * np.cos(heading) + apart[1] * np.sin(heading)
    left = apart[1] * np.cos(heading) - apart[0] * np.sin(heading)
    c, s = abs(np.cos(row[O_HEADING] - heading)), abs(np.sin(row[O_HEADING] - heading))
    along, across = 0.5 * (row[O_LENGTH] * c + row[O_WIDTH] * s), 0.5 * (row[O_LENGTH] * s + row[O_WIDTH] * c)
    return float(station + forward - along), float(abs(left) - across)


@lean
def put_up(table, phase, held, standing):
    """Objects stand while their entry of the script acts; those of a closed lane are put up once the last car has left it."""
    for i in range(standing.size):
        entry = int(table[O_ENTRY, i])
        acts = phase[entry] == ACTING
        standing[i] = 1 if acts and (standing[i] == 1 or held[entry] == 0) else 0
