"""The plan of the drawn deck (studio/road/drawn/deck.py), as its garage knows it and hands it over at the entry.

The aisles are driven one way: in along the lower one, round the east end, back along the upper one and out. So one number says where on
the deck a car is: the station s [m] along this way, 0 at the gate in the west wall. Spaces are numbered row by row from the south, 0 to 59.
"""

from functools import cache
from math import cos, pi, sin
from typing import Any, NamedTuple

import numpy as np
import shapely

from studio.road.drawn import deck
from studio.road.drawn.deck import AISLE, GAP, GROUPS, LENGTH, PILLAR, RADIUS, ROW, SET_IN, SIDE, TOGETHER, WALL, WIDTH

GATE = deck.END  # [m] from the middle to the gate, in the west
STRAIGHT = GATE + ROW / 2.0  # [m] from the gate to the east bend
ROUND = pi * RADIUS  # [m] of the bend
WHOLE = 2.0 * STRAIGHT + ROUND  # [m] from gate to gate
CAR = (4.7, 1.9)  # [m] length and width of a car that stands in a space: most are smaller
ROWS = (-SIDE, -LENGTH, 0.0, SIDE - LENGTH)  # [m] lower edges of the four rows
SPACES = len(ROWS) * GROUPS * TOGETHER


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


@cache
def spaces() -> tuple[Space, ...]:
    """All of them."""
    return tuple(space(number) for number in range(SPACES))


def space(number: int) -> Space:
    """One."""
    row, place = divmod(number, GROUPS * TOGETHER)
    group, k = divmod(place, TOGETHER)
    x = -ROW / 2.0 + GAP + group * (TOGETHER * WIDTH + GAP) + (k + 0.5) * WIDTH
    aisle = 0 if row < 2 else 1
    towards_aisle = 1.0 if row in (0, 2) else -1.0
    return Space(x, ROWS[row] + LENGTH / 2.0, towards_aisle * pi / 2.0, aisle, x + GATE if aisle == 0 else WHOLE - GATE - x)


def along(s: float) -> Pose:
    """The middle of the way at a station."""
    if s <= STRAIGHT:
        return Pose(s - GATE, -RADIUS, 0.0)
    if s >= STRAIGHT + ROUND:
        return Pose(WHOLE - GATE - s, RADIUS, pi)
    angle = (s - STRAIGHT) / RADIUS
    return Pose(ROW / 2.0 + RADIUS * sin(angle), -RADIUS * cos(angle), angle)


def bend(s: float) -> float:
    """Curvature [1/m] of the way at a station, to the left."""
    return 1.0 / RADIUS if STRAIGHT < s < STRAIGHT + ROUND else 0.0


def station(x: float, y: float) -> float:
    """The station nearest to a place [m]."""
    if x >= ROW / 2.0:
        return STRAIGHT + RADIUS * (np.arctan2(y, x - ROW / 2.0) + pi / 2.0)
    return x + GATE if y < 0.0 else WHOLE - GATE - x


def box(at: Pose, ahead: float, behind: float, width: float) -> shapely.Polygon:
    """The outline of a car: so far ahead of and behind a point of it [m]."""
    corners = [(ahead, width / 2.0), (-behind, width / 2.0), (-behind, -width / 2.0), (ahead, -width / 2.0)]
    c, s = cos(at.heading), sin(at.heading)
    return shapely.Polygon([(at.x + u * c - v * s, at.y + u * s + v * c) for u, v in corners])


def standing(number: int) -> shapely.Polygon:
    """A car in a space."""
    it = spaces()[number]
    return box(Pose(it.x, it.y, it.heading), CAR[0] / 2.0, CAR[0] / 2.0, CAR[1])


@cache
def structure() -> Any:
    """Pillars and outer walls, the gates open."""
    half = PILLAR / 2.0
    middles = [
        (-ROW / 2.0 + GAP / 2.0 + group * (TOGETHER * WIDTH + GAP), side * (RADIUS + out * (AISLE / 2.0 + SET_IN)))
        for group in range(GROUPS + 1) for side in (-1.0, 1.0) for out in (-1.0, 1.0)
    ]  # fmt: skip
    middles += [(side * (ROW / 2.0 + RADIUS / 2.0), 0.0) for side in (-1.0, 1.0)]
    pillars = [shapely.box(x - half, y - half, x + half, y + half) for x, y in middles]
    wall = shapely.box(-GATE - WALL, -SIDE - WALL, GATE + WALL, SIDE + WALL) - shapely.box(-GATE, -SIDE, GATE, SIDE)
    gates = [shapely.box(-GATE - 1.0, y - deck.OPENING / 2.0, -GATE + 1.0, y + deck.OPENING / 2.0) for y in (-RADIUS, RADIUS)]
    return shapely.union_all(pillars + [wall - shapely.union_all(gates)])


def full(but: int) -> Any:
    """The deck with a car in every space but one."""
    return shapely.union_all([structure(), *(standing(number) for number in range(SPACES) if number != but)])
