"""The way of a car into a space and out again, found before it is driven.

into(deck, number, car)     along the aisle past the space, then by the shortest way of J. A. Reeds and L. A. Shepp backward into it, such
                            that no wall, pillar or car in any other space comes nearer than CLEARANCE; the shortest such way, a change
                            of direction counting as CHANGE
out_of(deck, number, car)   the same way back to the aisle, and along it through the gate

A way is a table of poses of the middle of the rear axle, STEP apart: that point of a car moves along the car's own heading, forward and
backward (curvature kappa, road wheels at atan(L kappa)).
"""

from functools import cache
from itertools import pairwise
from math import cos, sin
from typing import NamedTuple

import numpy as np
import shapely

from studio.garage import plan, reeds_shepp
from studio.garage.plan import Plan, Pose, box

STEP = 0.05  # [m]
CLEARANCE = 0.3  # [m] that a planned way keeps: 0.15 in the end, and 0.15 for what is not followed exactly
CHANGE = 4.0  # [m] that a change of direction is worth
PIECE = 0.5  # [m] that another piece is worth: at each the wheels turn while the car drives
CHECKED = 4  # every so many steps it is looked whether something is near
TRIED = np.arange(2.0, 9.0, 0.125)  # [m] beyond the space from where it is driven in


class Car(NamedTuple):
    """What a way depends on [m]."""

    wheelbase: float
    length: float
    width: float
    front: float  # front overhang
    radius: float  # that it turns with, of the rear axle's middle

    @property
    def rear(self) -> float:
        """Rear overhang."""
        return self.length - self.wheelbase - self.front

    @property
    def middle(self) -> float:
        """From the rear axle to the middle of the outline."""
        return self.length / 2.0 - self.rear


class Way(NamedTuple):
    """Poses of the rear axle [m], [rad], curvature [1/m] to the left, direction (1, -1) and distance driven [m] of each, [point]."""

    x: np.ndarray
    y: np.ndarray
    heading: np.ndarray
    bend: np.ndarray
    direction: np.ndarray
    driven: np.ndarray
    station: np.ndarray  # [m] along the deck

    @property
    def length(self) -> float:
        """Of all of it."""
        return float(self.driven[-1])


def straightened(deck: Plan, first: float, last: float) -> np.ndarray:
    """The aisle from station to station, [x y heading bend direction, point]."""
    stations = np.linspace(first, last, max(round((last - first) / STEP), 1) + 1)
    return np.array([(*plan.along(deck, s), plan.bend(deck, s), 1.0) for s in stations]).T


def drawn(start: Pose, word: reeds_shepp.Word, r: float) -> np.ndarray:
    """A word driven from a pose with a radius [m], [x y heading bend direction, point]."""
    rows, at = [], (0.0, 0.0, start.heading)
    for turn, s in word:
        sign = 1.0 if s > 0.0 else -1.0
        for share in np.linspace(0.0, 1.0, max(round(abs(s) * r / STEP), 1) + 1):
            x, y, psi = reeds_shepp.moved(*at, reeds_shepp.Piece(turn, float(s * share)))
            rows.append((start.x + r * x, start.y + r * y, psi, turn / r, sign))
        at = reeds_shepp.moved(*at, reeds_shepp.Piece(turn, s))
    return np.array(rows).T


def joined(deck: Plan, parts: list[np.ndarray]) -> Way:
    """Parts one after another."""
    x, y, heading, bend, direction = np.concatenate(parts, axis=1)
    driven = np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(x), np.diff(y)))])
    return Way(x, y, heading, bend, direction, driven, np.array([plan.station(deck, *at) for at in zip(x, y, strict=True)]))


def is_clear(rows: np.ndarray, car: Car, around: shapely.Geometry) -> bool:
    """Whether nothing comes near a car on its way."""
    at = rows[:, ::CHECKED]
    outlines = [box(Pose(*each[:3]), car.wheelbase + car.front, car.rear, car.width) for each in at.T]
    return not bool(np.any(shapely.dwithin(np.array(outlines), around, CLEARANCE)))


def goal(deck: Plan, number: int, car: Car) -> Pose:
    """Where the rear axle is of a car that stands in the middle of a space."""
    it = plan.spaces(deck)[number]
    return Pose(it.x - car.middle * cos(it.heading), it.y - car.middle * sin(it.heading), it.heading)


def swings(word: reeds_shepp.Word) -> bool:
    """Whether the wheels would have to turn from one side to the other without a stop between."""
    return any(a.turn * b.turn < 0 and a.length * b.length > 0.0 for a, b in pairwise(word))


def candidates(deck: Plan, number: int, car: Car):
    """Ways in: cost [m], station from which the aisle is left, and the word."""
    to = goal(deck, number, car)
    for past in TRIED:
        s = plan.spaces(deck)[number].station + float(past)
        start = plan.along(deck, s)
        dx, dy, c, d = to.x - start.x, to.y - start.y, cos(start.heading), sin(start.heading)
        local = ((dx * c + dy * d) / car.radius, (dy * c - dx * d) / car.radius, reeds_shepp.wrapped(to.heading - start.heading))
        for word in reeds_shepp.words(*local):
            word = tuple(piece for piece in word if abs(piece.length) * car.radius > 1e-3)
            if word and not swings(word):
                turns = reeds_shepp.changes(word) + 2 * (word[0].length > 0.0)  # who begins forward turns back once more on its way out
                yield past + car.radius * reeds_shepp.length(word) + CHANGE * turns + PIECE * len(word), s, word


@cache
def turning_in(deck: Plan, number: int, car: Car) -> tuple[float, reeds_shepp.Word]:
    """From which station [m] a car drives into a space, and how; raises ValueError where it cannot."""
    around = plan.full(deck, number)
    around = around.intersection(plan.box(Pose(*plan.spaces(deck)[number][:3]), 14.0, 4.0, 36.0))
    shapely.prepare(around)
    for _, s, word in sorted(candidates(deck, number, car), key=lambda each: each[0]):
        if is_clear(drawn(plan.along(deck, s), word, car.radius), car, around):
            return s, word
    raise ValueError(f"a car of {car.length:g} m by {car.width:g} m that turns with {car.radius:g} m does not get into space {number}")


@cache
def fits(deck: Plan, number: int, car: Car) -> bool:
    """Whether there is a way for a car into a space."""
    try:
        return bool(turning_in(deck, number, car)[1])
    except ValueError:
        return False


@cache
def into(deck: Plan, number: int, car: Car, first: float = -14.0) -> Way:
    """From the gate, or a station [m] before it, into a space."""
    s, word = turning_in(deck, number, car)
    return joined(deck, [straightened(deck, first, s), drawn(plan.along(deck, s), word, car.radius)])


@cache
def out_of(deck: Plan, number: int, car: Car) -> Way:
    """From a space through the gate."""
    s, word = turning_in(deck, number, car)
    back = drawn(plan.along(deck, s), word, car.radius)[:, ::-1].copy()
    back[4] *= -1.0
    return joined(deck, [back, straightened(deck, s, deck.leaves)])


def nearest(way: Way, x: float, y: float, near: int, reach: int = 60) -> int:
    """The point of a way nearest to a place [m], among those next to the last one and of its direction."""
    low, high = max(near - reach, 0), min(near + reach + 1, way.x.size)
    away = np.hypot(way.x[low:high] - x, way.y[low:high] - y)
    away[way.direction[low:high] != way.direction[near]] = np.inf
    return low + int(np.argmin(away))


def error(way: Way, k: int, x: float, y: float, heading: float) -> tuple[float, float]:
    """How far a car is to the left of the way [m], and turned to its left [rad], at a point of it."""
    dx, dy, psi = x - way.x[k], y - way.y[k], way.heading[k]
    return float(dy * cos(psi) - dx * sin(psi)), reeds_shepp.wrapped(heading - float(psi))
