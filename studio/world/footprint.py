"""Footprints: the outlines of bodies at the start, and how far they reach into each other.

overlaps(footprints)   →  Overlap, ...     pairs that share ground, in the order of the list
"""

from collections.abc import Iterator, Sequence
from math import cos, hypot, inf, pi, sin
from typing import NamedTuple

from studio.world.passes.level import OTHER_LEVEL


class Footprint(NamedTuple):
    """A box on the road: whose, its middle [m], its heading [rad], its length and width [m], and the height of the road [m]."""

    name: str
    x: float
    y: float
    heading: float
    length: float
    width: float
    height: float = 0.0

    def reach(self, axis: float) -> float:
        """Half its extent [m] along a direction [rad]."""
        return 0.5 * (self.length * abs(cos(self.heading - axis)) + self.width * abs(sin(self.heading - axis)))


class Overlap(NamedTuple):
    """Two that share ground, and the shortest way [m] that one of them has to be moved."""

    one: Footprint
    other: Footprint
    depth: float


def depth(one: Footprint, other: Footprint) -> float:
    """How far [m] one must be moved so that both are apart; zero or less when they are.

    Two convex boxes are apart exactly when one of their four edge directions separates them, and when one is on a bridge.
    """
    if abs(one.height - other.height) > OTHER_LEVEL:
        return -inf
    dx, dy = other.x - one.x, other.y - one.y
    axes = (one.heading, one.heading + 0.5 * pi, other.heading, other.heading + 0.5 * pi)
    return min(one.reach(axis) + other.reach(axis) - abs(dx * cos(axis) + dy * sin(axis)) for axis in axes)


def overlaps(footprints: Sequence[Footprint]) -> Iterator[Overlap]:
    """Each with those before it. They are sorted into square cells as large as the longest of them."""
    size = max((hypot(each.length, each.width) for each in footprints), default=1.0)
    cells: dict[tuple[int, int], list[Footprint]] = {}
    for each in footprints:
        column, row = int(each.x // size), int(each.y // size)
        for other in (other for i in (-1, 0, 1) for j in (-1, 0, 1) for other in cells.get((column + i, row + j), [])):
            if (deep := depth(each, other)) > 0.0:
                yield Overlap(each, other, deep)
        cells.setdefault((column, row), []).append(each)
