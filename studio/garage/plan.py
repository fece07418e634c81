"""The plan of a deck (studio/road/drawn/deck.py), as its garage knows it and hands it over with its orders.

The aisles are driven one way: in along the lower one, round the east end, back along the upper one and out. So one number says where on
the deck a car is: the station s [m] along this way, 0 at the gate in the west wall. Spaces are numbered row by row from the south.
"""

from functools import cache
from math import cos, pi, sin
from typing import Any, NamedTuple

import numpy as np
import shapely

from studio.road.drawn.deck import GAP, OPENING, PILLAR, WALL, Shape

CAR = (4.7, 1.9)  # [m] length and width of a car that stands in a space: most are smaller


class Pose(NamedTuple):
    """A place on the deck [m], and a heading [rad]."""

    x: float
    y: float
    heading: float


class Space(NamedTuple):
    """A space: its middle, the heading of a car that has driven in backward, and the aisle (0 lower, 1 upper) that it lies at."""

    x: float
    y: float
    heading: float
    aisle: int
    station: float  # [m] of the aisle beside its middle


class Plan(Shape):
    """A deck with its stations."""

    __slots__ = ()

    @property
    def gate(self) -> float:
        """From the middle to the gate [m], in the west."""
        return self.end

    @property
    def straight(self) -> float:
        """From the gate to the east bend [m]."""
        return self.gate + self.row / 2.0

    @property
    def around(self) -> float:
        """Of the bend [m]."""
        return pi * self.radius

    @property
    def whole(self) -> float:
        """From gate to gate [m]."""
        return 2.0 * self.straight + self.around

    @property
    def leaves(self) -> float:
        """Station at which the driver has a car back [m]."""
        return self.whole + 4.0


SIXTY = Plan()


@cache
def spaces(deck: Plan) -> tuple[Space, ...]:
    """All of them."""
    return tuple(space(deck, number) for number in range(deck.spaces))


def space(deck: Plan, number: int) -> Space:
    """One."""
    row, place = divmod(number, deck.groups * deck.together)
    group, k = divmod(place, deck.together)
    x = deck.beside(group) + GAP / 2.0 + (k + 0.5) * deck.width
    aisle = 0 if row < 2 else 1
    towards_aisle = 1.0 if row in (0, 2) else -1.0
    beside = x + deck.gate if aisle == 0 else deck.whole - deck.gate - x
    return Space(x, deck.rows[row] + deck.length / 2.0, towards_aisle * pi / 2.0, aisle, beside)


def along(deck: Plan, s: float) -> Pose:
    """The middle of the way at a station."""
    if s <= deck.straight:
        return Pose(s - deck.gate, -deck.radius, 0.0)
    if s >= deck.straight + deck.around:
        return Pose(deck.whole - deck.gate - s, deck.radius, pi)
    angle = (s - deck.straight) / deck.radius
    return Pose(deck.row / 2.0 + deck.radius * sin(angle), -deck.radius * cos(angle), angle)


def bend(deck: Plan, s: float) -> float:
    """Curvature [1/m] of the way at a station, to the left."""
    return 1.0 / deck.radius if deck.straight < s < deck.straight + deck.around else 0.0


def station(deck: Plan, x: float, y: float) -> float:
    """The station nearest to a place [m]."""
    if x >= deck.row / 2.0:
        return deck.straight + deck.radius * (np.arctan2(y, x - deck.row / 2.0) + pi / 2.0)
    return x + deck.gate if y < 0.0 else deck.whole - deck.gate - x


def box(at: Pose, ahead: float, behind: float, width: float) -> shapely.Polygon:
    """The outline of a car: so far ahead of and behind a point of it [m]."""
    corners = [(ahead, width / 2.0), (-behind, width / 2.0), (-behind, -width / 2.0), (ahead, -width / 2.0)]
    c, s = cos(at.heading), sin(at.heading)
    return shapely.Polygon([(at.x + u * c - v * s, at.y + u * s + v * c) for u, v in corners])


def standing(deck: Plan, number: int) -> shapely.Polygon:
    """A car in a space."""
    it = spaces(deck)[number]
    return box(Pose(it.x, it.y, it.heading), CAR[0] / 2.0, CAR[0] / 2.0, CAR[1])


@cache
def structure(deck: Plan) -> Any:
    """Pillars and outer walls, the gates open."""
    half, end, side = PILLAR / 2.0, deck.end, deck.side
    pillars = [shapely.box(x - half, y - half, x + half, y + half) for x, y in deck.pillars()]
    wall = shapely.box(-end - WALL, -side - WALL, end + WALL, side + WALL) - shapely.box(-end, -side, end, side)
    gates = [shapely.box(-end - 1.0, y - OPENING / 2.0, -end + 1.0, y + OPENING / 2.0) for y in (-deck.radius, deck.radius)]
    return shapely.union_all(pillars + [wall - shapely.union_all(gates)])


def full(deck: Plan, but: int) -> Any:
    """The deck with a car in every space but one."""
    return shapely.union_all([structure(deck), *(standing(deck, number) for number in range(deck.spaces) if number != but)])
