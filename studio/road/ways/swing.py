"""Swings: where a line is sharper than a vehicle's lock it swings out and cuts in, as drivers do in narrow corners.

From a place on the line before the bend to one behind it, the shortest way of bounded curvature is made of arcs of the least radius R and
straights: arc, straight, arc or three arcs (L. E. Dubins, American Journal of Mathematics 79, 1957, theorem I). With headings θ, centres c
left of both ends, d from one centre to the other, and the same mirrored:

    left straight left      the straight has the course of d, and its length
    left straight right     2 R apart from both centres: course of d and arcsin(2 R/|d|), length √(d² - 4 R²)
    left right left         the middle circle touches both: its centre lies arccos(|d|/4 R) beside the course of d, 2 R away

Of the ways from some places before to some places behind, that one is taken which stays nearest to the line.
"""

from collections.abc import Iterable, Iterator
from itertools import product
from math import acos, asin, atan2, cos, hypot, pi, sin, sqrt
from typing import NamedTuple

import numpy as np

from studio.road.network import curve

FULL = 2.0 * pi
STEPS = (0.0, 8.0, 16.0)  # [m] before and behind a bend a swing begins and ends
FINER = (4.0, 2.0)  # [m] steps by which that is shifted afterwards, if it helps
ALL = (0.0, 4.0, 8.0, 12.0, 16.0, 20.0)  # [m] instead, where the first ones lead far aside
FAR = 0.8  # [m] aside
TOGETHER = 10.0  # [m] between bends over which one swings in one
EASED = 1.07  # [1] times the least radius of the vehicle, so that smoothing may sharpen it a little
LONGER = 1.6  # [1] times its line a swing is no longer than that: no loops
MARGIN = 4.0  # [m] of the line before and behind a swing it may come near to
SPARSE = 4  # of so many points one is looked at


class Pose(NamedTuple):
    """A place [m] and the heading there [rad]."""

    x: float
    y: float
    heading: float


Part = tuple[float, float]  # curvature in units of 1/R, left positive, and length [m]


def swung(line: np.ndarray, heading: np.ndarray, sharp: np.ndarray, lock: float) -> tuple[np.ndarray, np.ndarray]:
    """The line, float64[2, n] with points at equal distances, with a swing over every stretch that is sharper than the lock [1/m], and
    at which of its points each of the new ones lies, float64[m]."""
    spacing = curve.length(line) / (line.shape[1] - 1)
    own = np.arange(line.shape[1], dtype=float)
    pieces, at, done = [], [], 0
    for low, high in stretches(sharp, round(TOGETHER / spacing)):
        if high <= done:  # the swing before has taken this bend too
            continue
        best = best_swing(line, heading, max(low, done), high, done, EASED / lock, spacing)
        if best is not None:
            first, last, made = best
            pieces += [line[:, done:first], made]
            at += [own[done:first], np.linspace(first, last, made.shape[1])]
            done = last + 1
    return np.concatenate([*pieces, line[:, done:]], axis=1), np.concatenate([*at, own[done:]])


def stretches(sharp: np.ndarray, reach: int) -> list[tuple[int, int]]:
    """First and last sharp point of every bend; those within `reach` places of each other are one."""
    places = np.flatnonzero(sharp)
    parts = np.split(places, np.flatnonzero(np.diff(places) > reach) + 1)
    return [(int(part[0]), int(part[-1])) for part in parts if part.size]


def best_swing(line: np.ndarray, heading: np.ndarray, low: int, high: int, first: int, R: float, spacing: float):
    """From and to which point of a line one swings over the bend between two of its points, and how; None where there is no way."""
    tried: dict[tuple[int, int], tuple[float, list[Part]]] = {}

    def tries(starts: Iterable[float], ends: Iterable[float]) -> tuple[int, int]:
        """The best pair of points so far, these tried too."""
        for i, j in product((max(first, low - round(each / spacing)) for each in starts), ends):
            j = min(line.shape[1] - 1, high + round(j / spacing))
            if (i, j) not in tried:
                tried[i, j] = nearest_swing(line, heading, i, j, first, R, spacing)
        return min(tried, key=lambda pair: tried[pair][0])

    best = tries(STEPS, STEPS)
    best = tries(ALL, ALL) if tried[best][0] > FAR else best
    for step in FINER:
        before, behind = ((low - best[0]) * spacing, (best[1] - high) * spacing)
        best = tries((max(before - step, 0.0), before, before + step), (max(behind - step, 0.0), behind, behind + step))
    parts = tried[best][1]
    return (*best, drawn(pose(line, heading, best[0]), parts, R, spacing)) if parts else None


def nearest_swing(line: np.ndarray, heading: np.ndarray, i: int, j: int, first: int, R: float, spacing: float) -> tuple[float, list[Part]]:
    """Of the ways between two points of a line the one that stays nearest to it: how far it leaves it [m], and its parts."""
    margin = round(MARGIN / spacing)
    along, start = line[:, max(first, i - margin) : j + margin : SPARSE], pose(line, heading, i)
    found: tuple[float, list[Part]] = np.inf, []
    for parts in swings(start, pose(line, heading, j), R, LONGER * (j - i) * spacing + R) if i < j else ():
        off = float(curve.distances(drawn(start, parts, R, SPARSE * spacing), along).max())
        if off < found[0] - 1e-6:
            found = off, parts
    return found


def pose(line: np.ndarray, heading: np.ndarray, i: int) -> Pose:
    """Place and heading at a point of a line."""
    return Pose(float(line[0, i]), float(line[1, i]), float(heading[i]))


def swings(start: Pose, end: Pose, R: float, longest: float) -> Iterator[list[Part]]:
    """All ways between two poses with arcs of radius R [m] that are no longer than so much [m]."""
    for side in (1.0, -1.0):
        for parts in words(mirrored(start, side), mirrored(end, side), R):
            if sum(length for _, length in parts) <= longest:
                yield [(side * bend, length) for bend, length in parts]


def mirrored(at: Pose, side: float) -> Pose:
    """The same, on the other side of the x axis where `side` is -1."""
    return Pose(at.x, side * at.y, side * at.heading)


def words(start: Pose, end: Pose, R: float) -> Iterator[list[Part]]:
    """The ways that begin to the left."""
    a = start.x - R * sin(start.heading), start.y + R * cos(start.heading)
    left = end.x - R * sin(end.heading) - a[0], end.y + R * cos(end.heading) - a[1]
    right = end.x + R * sin(end.heading) - a[0], end.y - R * cos(end.heading) - a[1]
    far, course = hypot(*left), atan2(left[1], left[0])
    yield [(1.0, R * ((course - start.heading) % FULL)), (0.0, far), (1.0, R * ((end.heading - course) % FULL))]
    across = hypot(*right)
    if across >= 2.0 * R:
        course = atan2(right[1], right[0]) + asin(2.0 * R / across)
        straight = sqrt(across**2 - 4.0 * R**2)
        yield [(1.0, R * ((course - start.heading) % FULL)), (0.0, straight), (-1.0, R * ((course - end.heading) % FULL))]
    if far <= 4.0 * R:
        yield from (between(start, end, R, left, beside) for beside in (acos(far / (4.0 * R)), -acos(far / (4.0 * R))))


def between(start: Pose, end: Pose, R: float, apart: tuple[float, float], beside: float) -> list[Part]:
    """Left, right, left; `beside` is the angle by which the middle circle lies beside the line between the outer ones."""
    towards = atan2(apart[1], apart[0]) + beside
    onward = atan2(apart[1] - 2.0 * R * sin(towards), apart[0] - 2.0 * R * cos(towards))
    over, off = towards + 0.5 * pi, onward - 0.5 * pi  # headings where the circles touch
    return [(1.0, R * ((over - start.heading) % FULL)), (-1.0, R * ((over - off) % FULL)), (1.0, R * ((end.heading - off) % FULL))]


def drawn(start: Pose, parts: list[Part], R: float, spacing: float) -> np.ndarray:
    """The points of a way, float64[2, n], by the middles of its steps."""
    ends = np.cumsum([length for _, length in parts])
    count = max(2, round(float(ends[-1]) / spacing))
    step = float(ends[-1]) / count
    bends = np.array([bend / R for bend, _ in parts])
    at = np.append(0.0, ends)
    heading = start.heading + np.interp((np.arange(count) + 0.5) * step, at, np.append(0.0, np.cumsum(bends * np.diff(at))))
    points = np.empty((2, count + 1))
    points[:, 0] = start.x, start.y
    points[0, 1:], points[1, 1:] = np.cos(heading), np.sin(heading)
    points[:, 1:] *= step
    return np.cumsum(points, axis=1)
