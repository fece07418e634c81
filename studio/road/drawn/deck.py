"""A parking deck drawn to the centimetre: one level of sixty spaces on a one-way loop, with pillars, outer walls and a street.

The loop runs counter-clockwise: in from the street along the lower aisle, round the east end, back along the upper aisle,
then out again or round once more. The slab above is left out, so that one sees in. Sizes follow the German
recommendations for parking places (EAR 05): spaces of 5.00 m by 2.50 m, aisles of 6.00 m.
"""

from itertools import pairwise

import numpy as np

from studio.road.drawn.drawing import Drawing

LENGTH, WIDTH = 5.0, 2.5  # [m] of a space
AISLE = 6.0  # [m] between two rows
GROUPS, TOGETHER = 5, 3  # groups of spaces in a row, and spaces between two pillars
GAP, PILLAR = 0.5, 0.4  # [m] between two groups, and the side of the pillar there
SET_IN = 1.0  # [m] from the aisle to a pillar's middle
CLEAR, WALL = 2.8, 0.3  # [m] height of the level, and of walls and pillars
RADIUS = LENGTH + AISLE / 2.0  # [m] of the bends at both ends
ROW = GROUPS * TOGETHER * WIDTH + (GROUPS + 1) * GAP  # [m]
END = ROW / 2.0 + RADIUS + 5.0  # [m] from the middle to the walls in the east and west
SIDE = 2.0 * LENGTH + AISLE  # [m] to those in the north and south
OPENING = 5.0  # [m] in the west wall, for each aisle
STREET, ARM = -(END + 32.0), 130.0  # [m] x of the street, and how far it leads to both sides
WALKING = {"highway": "service", "oneway": "yes", "maxspeed": "10", "width": "4"}


def deck() -> Drawing:
    """The deck and its street."""
    plan = Drawing(reach=ARM)
    ways(plan)
    plan.rectangle(-END, -SIDE, END, SIDE, amenity="parking", parking="surface", name="Parkdeck")
    for low in (-SIDE, -LENGTH, 0.0, SIDE - LENGTH):
        row(plan, low)
    pillars(plan)
    walls(plan)
    surroundings(plan)
    return plan


def ways(plan: Drawing) -> None:
    """The street, the ways in and out, and the loop."""
    corners = [(STREET, y) for y in (-ARM, -RADIUS, RADIUS, ARM)]
    for start, end in pairwise(corners):
        plan.way([start, end], highway="residential", maxspeed="30", lanes="2", name="Deckstraße")
    start, end = -ROW / 2.0, ROW / 2.0
    plan.way([(STREET, -RADIUS), (-END, -RADIUS), (start, -RADIUS)], **WALKING, service="driveway")
    plan.way(aisle(start, end, -RADIUS), **WALKING, service="parking_aisle")
    plan.way(bend(end, 1.0), **WALKING, service="parking_aisle")
    plan.way(aisle(end, start, RADIUS), **WALKING, service="parking_aisle")
    plan.way(bend(start, -1.0), **WALKING, service="parking_aisle")
    plan.way([(start, RADIUS), (-END, RADIUS), (STREET, RADIUS)], **WALKING, service="driveway")


def aisle(start: float, end: float, y: float) -> list[tuple[float, float]]:
    """A straight aisle, in pieces so short that the bends at its ends do not pull it out of line."""
    return [(x, y) for x in np.linspace(start, end, 21)]


def bend(x: float, side: float) -> list[tuple[float, float]]:
    """The half circle at the east (1) or west (-1) end, counter-clockwise."""
    angle = np.linspace(-np.pi / 2.0, np.pi / 2.0, 17)
    return [(x + side * RADIUS * np.cos(each), side * RADIUS * np.sin(each)) for each in angle]


def row(plan: Drawing, low: float) -> None:
    """A row of spaces whose lower ends lie at y = `low` [m]."""
    for group in range(GROUPS):
        first = -ROW / 2.0 + GAP + group * (TOGETHER * WIDTH + GAP)
        for k in range(TOGETHER):
            plan.rectangle(first + k * WIDTH, low, first + (k + 1) * WIDTH, low + LENGTH, amenity="parking_space")


def pillars(plan: Drawing) -> None:
    """A pillar beside every group of spaces, in all four rows, and one within each bend."""
    places = [
        (-ROW / 2.0 + GAP / 2.0 + group * (TOGETHER * WIDTH + GAP), side * (RADIUS + out * (AISLE / 2.0 + SET_IN)))
        for group in range(GROUPS + 1) for side in (-1.0, 1.0) for out in (-1.0, 1.0)
    ]  # fmt: skip
    places += [(side * (ROW / 2.0 + RADIUS / 2.0), 0.0) for side in (-1.0, 1.0)]
    for x, y in places:
        plan.rectangle(x - PILLAR / 2.0, y - PILLAR / 2.0, x + PILLAR / 2.0, y + PILLAR / 2.0, building__part="column", height=str(CLEAR))


def walls(plan: Drawing) -> None:
    """The outer walls, open where one drives in and out."""
    x, y, half = END + WALL / 2.0, SIDE + WALL / 2.0, OPENING / 2.0
    wall = {"barrier": "wall", "height": str(CLEAR)}
    plan.way([(-x, -RADIUS - half), (-x, -y), (x, -y), (x, y), (-x, y), (-x, RADIUS + half)], **wall)
    plan.way([(-x, -RADIUS + half), (-x, RADIUS - half)], **wall)


def surroundings(plan: Drawing) -> None:
    """A stair house, lawns, trees and lamps."""
    plan.rectangle(END + 0.3, -3.0, END + 6.0, 3.0, building="yes", height="5")
    for sign in (-1.0, 1.0):
        low, high = sorted((sign * (SIDE + 3.0), sign * (SIDE + 30.0)))
        plan.rectangle(STREET + 8.0, low, END + 6.0, high, landuse="grass")
        for x in np.arange(STREET + 14.0, END, 12.0):
            plan.node((x, sign * (SIDE + 8.0)), natural="tree")
    for y in np.arange(-ARM + 15.0, ARM, 25.0):
        plan.node((STREET - 5.0, y), highway="street_lamp")
