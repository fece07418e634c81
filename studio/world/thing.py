"""Things: cones and barriers that the script puts on the road, boxes at rest. Where they stand.

Sizes: a traffic cone of 0.75 m, and a barrier board on its feet (Absperrschranke, German RSA 21).
"""

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from studio.road.ways.detour import Work
from studio.road.ways.path import PATH_HEADING, PATH_SPACING, PATH_X, PATH_Y, Path
from studio.world.effect import Closing, Row
from studio.world.site import Site
from studio.world.table.street import BARRIER, CONE

SIZES = {CONE: (0.3, 0.3), BARRIER: (1.5, 0.25)}  # [m] length and width
WORDS = {CONE: "cone", BARRIER: "barrier"}
MOVERS = ()
CONE_SPACING, ROW_SPACING = 3.0, 6.0  # [m] on a taper, along a closed lane
CONE_INSET, ROW_INSET = 0.15, 0.35  # [m] from the edge of the ground that is left to the cars


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


def names(sites: Sequence[Site], found: list[Thing]) -> Iterator[str]:
    """What each is called: barrier_3 of roadworks."""
    seen: dict[tuple[int, int], int] = {}
    for each in found:
        key = (each.entry, each.kind)
        seen[key] = seen.get(key, 0) + 1
        yield f"{WORDS[each.kind]}_{seen[key]} of {sites[each.entry].name}"
