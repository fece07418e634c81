"""A parking deck drawn to the centimetre: one level of four rows on a one-way loop, with pillars, outer walls and a street.

The loop runs counter-clockwise: in from the street along the lower aisle, round the east end, back along the upper aisle,
then out again or round once more. The slab above is left out, so that one sees in. Sizes follow the German
recommendations for parking places (EAR 05): spaces of 5.00 m by 2.50 m, aisles of 6.00 m. A shape may have others, and rows of another
length; sixty spaces are drawn without one.
"""

from itertools import pairwise
from typing import NamedTuple

import numpy as np

from studio.road.drawn.drawing import Drawing

GAP, PILLAR = 0.5, 0.4  # [m] between two groups, and the side of the pillar there
SET_IN = 1.0  # [m] from the aisle to a pillar's middle
CLEAR, WALL = 2.8, 0.3  # [m] height of the level, and of walls and pillars
OPENING = 5.0  # [m] in the west wall, for each aisle
APRON, ARM = 32.0, 130.0  # [m] from the west wall to the street, and how far that leads to both sides
WALKING = {"highway": "service", "oneway": "yes", "maxspeed": "10", "width": "4"}


class Shape(NamedTuple):
    """What a deck is made by; the rest follows from it."""

    groups: int = 5  # of spaces in a row
    together: int = 3  # spaces between two pillars
    length: float = 5.0  # [m] of a space
    width: float = 2.5  # [m] of a space
    aisle: float = 6.0  # [m] between two rows

    @property
    def radius(self) -> float:
        """Of the bends at both ends [m]; the middles of the aisles are as far from that of the deck."""
        return self.length + self.aisle / 2.0

    @property
    def row(self) -> float:
        """Length of a row [m]."""
        return self.groups * self.together * self.width + (self.groups + 1) * GAP

    @property
    def end(self) -> float:
        """From the middle to the walls in the east and west [m]."""
        return self.row / 2.0 + self.radius + 5.0

    @property
    def side(self) -> float:
        """To those in the north and south [m]."""
        return 2.0 * self.length + self.aisle

    @property
    def street(self) -> float:
        """x of the street [m]."""
        return -(self.end + APRON)

    @property
    def spaces(self) -> int:
        """How many there are."""
        return 4 * self.groups * self.together

    @property
    def rows(self) -> tuple[float, float, float, float]:
        """Lower edges of the rows [m], from the south."""
        return -self.side, -self.length, 0.0, self.side - self.length

    def beside(self, group: int) -> float:
        """x of the middle between a group and the one before it [m]."""
        return -self.row / 2.0 + GAP / 2.0 + group * (self.together * self.width + GAP)

    def pillars(self) -> list[tuple[float, float]]:
        """Middles of all pillars [m]: beside every group of spaces in all four rows, and one within each bend."""
        places = [
            (self.beside(group), side * (self.radius + out * (self.aisle / 2.0 + SET_IN)))
            for group in range(self.groups + 1) for side in (-1.0, 1.0) for out in (-1.0, 1.0)
        ]  # fmt: skip
        return places + [(side * (self.row / 2.0 + self.radius / 2.0), 0.0) for side in (-1.0, 1.0)]


SIXTY = Shape()


def deck(shape: Shape = SIXTY) -> Drawing:
    """A deck and its street."""
    plan, end, side = Drawing(reach=ARM), shape.end, shape.side
    ways(plan, shape)
    plan.rectangle(-end, -side, end, side, amenity="parking", parking="surface", name="Parkdeck")
    for low in shape.rows:
        row(plan, shape, low)
    pillars(plan, shape)
    walls(plan, shape)
    surroundings(plan, shape)
    return plan


def ways(plan: Drawing, shape: Shape) -> None:
    """The street, the ways in and out, and the loop."""
    street, r, wall = shape.street, shape.radius, -shape.end
    corners = [(street, y) for y in (-ARM, -r, r, ARM)]
    for start, end in pairwise(corners):
        plan.way([start, end], highway="residential", maxspeed="30", lanes="2", name="Deckstraße")
    start, end = -shape.row / 2.0, shape.row / 2.0
    plan.way([(street, -r), (wall, -r), (start, -r)], **WALKING, service="driveway")
    plan.way(aisle(start, end, -r), **WALKING, service="parking_aisle")
    plan.way(bend(end, r, 1.0), **WALKING, service="parking_aisle")
    plan.way(aisle(end, start, r), **WALKING, service="parking_aisle")
    plan.way(bend(start, r, -1.0), **WALKING, service="parking_aisle")
    plan.way([(start, r), (wall, r), (street, r)], **WALKING, service="driveway")


def aisle(start: float, end: float, y: float) -> list[tuple[float, float]]:
    """A straight aisle, in pieces so short that the bends at its ends do not pull it out of line."""
    return [(x, y) for x in np.linspace(start, end, 21)]


def bend(x: float, r: float, side: float) -> list[tuple[float, float]]:
    """The half circle at the east (1) or west (-1) end, counter-clockwise."""
    angle = np.linspace(-np.pi / 2.0, np.pi / 2.0, 17)
    return [(x + side * r * np.cos(each), side * r * np.sin(each)) for each in angle]


def row(plan: Drawing, shape: Shape, low: float) -> None:
    """A row of spaces whose lower ends lie at y = `low` [m]."""
    for group in range(shape.groups):
        first = shape.beside(group) + GAP / 2.0
        for k in range(shape.together):
            plan.rectangle(
                first + k * shape.width, low, first + (k + 1) * shape.width, low + shape.length, amenity="parking_space"
            )  # fmt: skip


def pillars(plan: Drawing, shape: Shape) -> None:
    """All of them."""
    for x, y in shape.pillars():
        plan.rectangle(x - PILLAR / 2.0, y - PILLAR / 2.0, x + PILLAR / 2.0, y + PILLAR / 2.0, building__part="column", height=str(CLEAR))


def walls(plan: Drawing, shape: Shape) -> None:
    """The outer walls, open where one drives in and out."""
    x, y, half, r = shape.end + WALL / 2.0, shape.side + WALL / 2.0, OPENING / 2.0, shape.radius
    wall = {"barrier": "wall", "height": str(CLEAR)}
    plan.way([(-x, -r - half), (-x, -y), (x, -y), (x, y), (-x, y), (-x, r + half)], **wall)
    plan.way([(-x, -r + half), (-x, r - half)], **wall)


def surroundings(plan: Drawing, shape: Shape) -> None:
    """A stair house, lawns, trees and lamps."""
    end, side, street = shape.end, shape.side, shape.street
    plan.rectangle(end + 0.3, -3.0, end + 6.0, 3.0, building="yes", height="5")
    for sign in (-1.0, 1.0):
        low, high = sorted((sign * (side + 3.0), sign * (side + 30.0)))
        plan.rectangle(street + 8.0, low, end + 6.0, high, landuse="grass")
        for x in np.arange(street + 14.0, end, 12.0):
            plan.node((x, sign * (side + 8.0)), natural="tree")
    for y in np.arange(-ARM + 15.0, ARM, 25.0):
        plan.node((street - 5.0, y), highway="street_lamp")
