"""Things: what the script brings to the road, cones and barriers at rest and whoever moves. Where they stand at first.

Sizes: a traffic cone of 0.75 m, and a barrier board on its feet (Absperrschranke, German RSA 21).
"""

from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from studio.road.ways.detour import Work
from studio.road.ways.floor import GROUND, Tread
from studio.road.ways.path import Path
from studio.world.effect import Closing, Row, Walk, beside
from studio.world.site import Laid, Site, Walked
from studio.world.table.street import BARRIER, BOX, CONE, CYCLIST, PEDESTRIAN

SIZES = {CONE: (0.3, 0.3), BARRIER: (1.5, 0.25)}  # [m] length and width
WORDS = {CONE: "cone", BARRIER: "barrier", PEDESTRIAN: "pedestrian", CYCLIST: "cyclist", BOX: "box"}
KINDS = {"pedestrian": PEDESTRIAN, "cyclist": CYCLIST, "cone": CONE, "barrier": BARRIER}  # all others are boxes to everybody
CONE_SPACING, ROW_SPACING = 3.0, 6.0  # [m] on a taper, along a closed lane
CONE_INSET, ROW_INSET = 0.15, 0.35  # [m] from the edge of the ground that is left to the cars


class Thing(NamedTuple):
    """One object: kind, place [m], heading [rad], the entry of the script that it belongs to, its size [m], how it moves, if at all, and
    what is under it: where it stands, or all along its line."""

    kind: int
    x: float
    y: float
    heading: float
    entry: int
    length: float
    width: float
    walk: Walk | None = None
    tread: Tread = GROUND

    @property
    def looks(self) -> str:
        """What it looks like, in a word."""
        return self.walk.who if self.walk is not None else WORDS[self.kind]


def things(sites: Sequence[Site]) -> Iterator[Thing]:
    """All objects of a script."""
    for number, site in enumerate(sites):
        yield from (moving(each, number) for each in site.walked)
        for each in site.laid:
            if isinstance(each.effect, Row):
                yield from row(each.effect, each, number)
            elif isinstance(each.effect, Closing) and each.work:
                yield from fence(each.work, each, number)


def row(effect: Row, laid: Laid, number: int) -> Iterator[Thing]:
    """Objects along a stretch."""
    kind = {"cones": CONE, "barriers": BARRIER}[effect.what]
    for station in np.arange(effect.stretch.start, effect.stretch.end + 1e-9, effect.spacing):
        yield at(laid.line, station, effect.offset, kind, number, laid.tread)


def fence(work: Work, laid: Laid, number: int) -> Iterator[Thing]:
    """What a lane is closed with: cones on the taper, boards across both ends, a row of them along its open sides."""
    edges, tread = laid.edges, laid.tread
    for end, inwards in ((work.start, 1.0), (work.end, -1.0)):
        for aside in (-1.0, 1.0):
            offset = aside * 0.26 * work.width
            yield at(work.line, end + inwards, offset, BARRIER, number, tread, turned=0.5 * np.pi)
    for side in edges:
        for station in np.arange(work.start + ROW_SPACING, work.end - 0.5 * ROW_SPACING, ROW_SPACING):
            yield at(work.line, station, side * (0.5 * work.width - ROW_INSET), BARRIER, number, tread)
    if work.target is not None and work.side in edges:
        stations = np.arange(work.start - work.taper, work.start, CONE_SPACING)
        for station, edge in zip(stations, work.edge(stations), strict=True):
            yield at(work.line, station, edge - work.side * CONE_INSET, CONE, number, tread)


def at(line: Path, station: float, offset: float, kind: int, entry: int, tread: Tread, *, turned: float = 0.0) -> Thing:
    """An object at a station of a line, `offset` [m] to its left, its length along the line or `turned` [rad] from it."""
    x, y, heading = beside(line, station, offset)
    floor = tread.at(float(station))
    return Thing(kind, x, y, heading + turned, entry, *SIZES[kind], tread=Tread(*np.array([[0.0, *floor]]).T))


def moving(walked: Walked, number: int) -> Thing:
    """Somebody at the beginning of his line."""
    walk = walked.walk
    (x, y), *_ = walk.line
    return Thing(KINDS.get(walk.who, BOX), x, y, headings(walk.line)[0], number, *walk.size, walk, walked.tread)


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
