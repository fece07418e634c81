"""Swings: where a line is sharper than a vehicle's lock it swings out and cuts in, as drivers do in narrow corners.

From a place on the line before the bend to one behind it, the shortest way of bounded curvature is made of arcs of the least radius R and
straights: arc, straight, arc or three arcs (L. E. Dubins, American Journal of Mathematics 79, 1957, theorem I). With headings θ, centres c
left of both ends, d from one centre to the other, and the same mirrored:

    left straight left      the straight has the course of d, and its length
    left straight right     2 R apart from both centres: course of d and arcsin(2 R/|d|), length √(d² - 4 R²)
    left right left         the middle circle touches both: its centre lies arccos(|d|/4 R) beside the course of d, 2 R away

Of the ways from some places before to some places behind, that one is taken which stays nearest to the line.
"""

from collections.abc import Iterator
from math import acos, asin, atan2, cos, hypot, pi, sin, sqrt
from typing import NamedTuple

import numpy as np

from studio.road.network import curve

FULL = 2.0 * pi
STEPS = (0.0, 4.0, 8.0, 12.0, 16.0, 20.0)  # [m] before and behind a bend a swing begins and ends
TOGETHER = 10.0  # [m] between bends over which one swings in one
EASED = 1.07  # [1] times the least radius of the vehicle, so that smoothing may sharpen it a little
LONGER = 1.6  # [1] times its line a swing is no longer than that: no loops
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
        best = best_swing(line, heading, low, high, done, EASED / lock, spacing)
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
    steps = [round(each / spacing) for each in STEPS]
    starts = sorted({max(first, low - each) for each in steps})
    ends = sorted({min(line.shape[1] - 1, high + each) for each in steps})
    found, least = None, np.inf
    for i in starts:
        for j in ends:
            along = line[:, max(first, i - steps[1]) : j + steps[1] : SPARSE]
            for made in swings(pose(line, heading, i), pose(line, heading, j), R, LONGER * (j - i) * spacing + R, spacing):
                off = float(curve.distances(made[:, ::SPARSE], along).max())
                if off < least - 1e-6:
                    found, least = (i, j, made), off
    return found


def pose(line: np.ndarray, heading: np.ndarray, i: int) -> Pose:
    """Place and heading at a point of a line."""
    return Pose(float(line[0, i]), float(line[1, i]), float(heading[i]))


def swings(start: Pose, end: Pose, R: float, longest: float, spacing: float) -> Iterator[np.ndarray]:
    """The lines of all ways between two poses with arcs of radius R [m] that are no longer than so much [m]."""
    for side in (1.0, -1.0):
        for parts in words(mirrored(start, side), mirrored(end, side), R):
            if sum(length for _, length in parts) <= longest:
                yield drawn(start, [(side * bend, length) for bend, length in parts], R, spacing)


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
    lengths = np.array([length for _, length in parts])
    ends = np.cumsum(lengths)
    count = max(2, round(float(ends[-1]) / spacing))
    step = float(ends[-1]) / count
    middle = (np.arange(count) + 0.5) * step
    bends = np.array([bend / R for bend, _ in parts])
    turned = np.array([np.clip(middle - (end - length), 0.0, length) for end, length in zip(ends, lengths, strict=True)])
    heading = start.heading + bends @ turned
    x, y = np.cumsum(np.cos(heading)) * step, np.cumsum(np.sin(heading)) * step
    return np.array([np.append(0.0, x) + start.x, np.append(0.0, y) + start.y])
