"""Things: what the script brings to the road, cones and barriers at rest and whoever moves. Where they stand at first.

Sizes: a traffic cone of 0.75 m, and a barrier board on its feet (Absperrschranke, German RSA 21).
"""

from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from studio.road.ways.detour import Work
from studio.road.ways.path import Path
from studio.road.ways.relief import height_at
from studio.world.effect import Closing, Row, Walk, beside
from studio.world.site import Site
from studio.world.table.street import BARRIER, BOX, CONE, CYCLIST, PEDESTRIAN

SIZES = {CONE: (0.3, 0.3), BARRIER: (1.5, 0.25)}  # [m] length and width
WORDS = {CONE: "cone", BARRIER: "barrier", PEDESTRIAN: "pedestrian", CYCLIST: "cyclist", BOX: "box"}
KINDS = {"pedestrian": PEDESTRIAN, "cyclist": CYCLIST, "cone": CONE, "barrier": BARRIER}  # all others are boxes to everybody
CONE_SPACING, ROW_SPACING = 3.0, 6.0  # [m] on a taper, along a closed lane
CONE_INSET, ROW_INSET = 0.15, 0.35  # [m] from the edge of the ground that is left to the cars


class Thing(NamedTuple):
    """One object: kind, place [m], heading [rad], the entry of the script that it belongs to, its size [m], how it moves, if at all, and
    the height of the road where it stands [m], 0 for one that moves."""

    kind: int
    x: float
    y: float
    heading: float
    entry: int
    length: float
    width: float
    walk: Walk | None = None
    height: float = 0.0

    @property
    def looks(self) -> str:
        """What it looks like, in a word."""
        return self.walk.who if self.walk is not None else WORDS[self.kind]


def things(sites: Sequence[Site]) -> Iterator[Thing]:
    """All objects of a script."""
    for number, site in enumerate(sites):
        yield from (moving(each, number) for each in site.effects if isinstance(each, Walk))
        for each in site.laid:
            if isinstance(each.effect, Row):
                yield from row(each.effect, each.line, number)
            elif isinstance(each.effect, Closing) and each.work:
                yield from fence(each.work, each.edges, number)


def row(effect: Row, line: Path, number: int) -> Iterator[Thing]:
    """Objects along a stretch."""
    kind = {"cones": CONE, "barriers": BARRIER}[effect.what]
    for station in np.arange(effect.stretch.start, effect.stretch.end + 1e-9, effect.spacing):
        yield at(line, station, effect.offset, kind, number)


def fence(work: Work, edges: tuple[int, ...], number: int) -> Iterator[Thing]:
    """What a lane is closed with: cones on the taper, boards across both ends, a row of them along its open sides."""
    for end, inwards in ((work.start, 1.0), (work.end, -1.0)):
        for aside in (-1.0, 1.0):
            offset = aside * 0.26 * work.width
            yield at(work.line, end + inwards, offset, BARRIER, number, turned=0.5 * np.pi)
    for side in edges:
        for station in np.arange(work.start + ROW_SPACING, work.end - 0.5 * ROW_SPACING, ROW_SPACING):
            yield at(work.line, station, side * (0.5 * work.width - ROW_INSET), BARRIER, number)
    if work.target is not None and work.side in edges:
        stations = np.arange(work.start - work.taper, work.start, CONE_SPACING)
        for station, edge in zip(stations, work.edge(stations), strict=True):
            yield at(work.line, station, edge - work.side * CONE_INSET, CONE, number)


def at(line: Path, station: float, offset: float, kind: int, entry: int, *, turned: float = 0.0) -> Thing:
    """An object at a station of a line, `offset` [m] to its left, its length along the line or `turned` [rad] from it."""
    x, y, heading = beside(line, station, offset)
    return Thing(kind, x, y, heading + turned, entry, *SIZES[kind], height=float(height_at(line, np.array(station))))


def moving(walk: Walk, number: int) -> Thing:
    """Somebody at the beginning of his line."""
    (x, y), *_ = walk.line
    return Thing(KINDS.get(walk.who, BOX), x, y, headings(walk.line)[0], number, *walk.size, walk)


def headings(line: Sequence[tuple[float, float]]) -> list[float]:
    """Of every leg of a line [rad]; of one that has none, east."""
    return [float(np.arctan2(d - b, c - a)) for (a, b), (c, d) in pairwise(line)] or [0.0]


def names(sites: Sequence[Site], found: list[Thing]) -> Iterator[str]:
    """What each is called: barrier_3 of roadworks; whoever moves has the name of the entry."""
    seen: dict[tuple[int, int], int] = {}
    for each in found:
        if each.walk is not None:
            yield sites[each.entry].name
            continue
        key = (each.entry, each.kind)
        seen[key] = seen.get(key, 0) + 1
        yield f"{WORDS[each.kind]}_{seen[key]} of {sites[each.entry].name}"
