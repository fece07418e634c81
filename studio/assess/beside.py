"""Beside: where vehicles are to each other, whoever drives ahead of whom.

For two that drive in about the same direction, or in about opposite ones, in axes along and across the mean of their directions: the
distance between their outlines forwards and sideways, negative where they overlap, and their speeds. In bends this is right near by.
"""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from studio.assess.following import rows_ahead
from studio.execution.record import Body, Record

BLOCK = 1.0  # [s] that is looked at together when it is found out who was near whom
ABREAST = 15.0  # [m] to the side, farther than which nobody comes towards anybody
PARALLEL = 0.87  # [1] cosine of the angle up to which two drive in about the same direction


class Outlines(NamedTuple):
    """Two vehicles over some samples, all float64[n]: along and across their mean direction, the second as the first one sees it."""

    time: np.ndarray  # [s]
    forward: np.ndarray  # [m] between the middles, positive when the second is ahead
    left: np.ndarray  # [m] between the middles, positive when the second is to the left
    gap: np.ndarray  # [m] between the outlines, along; negative while they are side by side
    aside: np.ndarray  # [m] between the outlines, across; negative while one is behind the other
    speed: np.ndarray  # [m/s] of the first, along
    other_speed: np.ndarray  # [m/s] of the second, in the same direction
    drift: np.ndarray  # [m/s] of the first, to the left
    other_drift: np.ndarray  # [m/s] of the second, to the left
    alike: np.ndarray  # 1 in the same direction, -1 in opposite ones, 0 when neither


def neighbours(record: Record, reach: float, *, oncoming: bool = False) -> Iterator[tuple[int, int, np.ndarray]]:
    """Rows i < j of vehicles, with the samples at which they may have been within reach [m] of each other.

    Of oncoming ones only those that drive towards each other, or away from each other, near one line.
    """
    x, y, psi = (record.channel(name) for name in ("x", "y", "heading"))
    near: dict[tuple[int, int], list[np.ndarray]] = {}
    for samples in blocks(record.time):
        found = within(x[:, samples], y[:, samples], reach)
        if oncoming:
            found &= towards(*(each[:, samples[samples.size // 2]] for each in (x, y, psi)))
        for i, j in np.argwhere(np.triu(found, 1)).tolist():
            near.setdefault((i, j), []).append(samples)
    yield from ((i, j, np.concatenate(parts)) for (i, j), parts in sorted(near.items()))


def blocks(time: np.ndarray) -> Iterator[np.ndarray]:
    """The samples of one block after another."""
    count = max(round(BLOCK / (time[1] - time[0])), 1) if time.size > 1 else 1
    yield from (np.arange(first, min(first + count, time.size)) for first in range(0, time.size, count))


def towards(x: np.ndarray, y: np.ndarray, psi: np.ndarray) -> np.ndarray:
    """Whether two drive in opposite directions near one line, bool[vehicle, vehicle], at one moment."""
    left = (y - y[:, None]) * np.cos(psi)[:, None] - (x - x[:, None]) * np.sin(psi)[:, None]
    return (np.cos(psi - psi[:, None]) < 0.0) & (np.abs(left) < ABREAST)


def within(x: np.ndarray, y: np.ndarray, reach: float) -> np.ndarray:
    """Whether the boxes around all places of two, float64[vehicle, n], come within reach, bool[vehicle, vehicle]."""
    there = np.isfinite(x).any(axis=1)
    x, y = (np.where(np.isfinite(each), each, np.nan) for each in (x, y))
    low_x, high_x, low_y, high_y = np.full((4, x.shape[0]), np.nan)
    low_x[there], high_x[there] = np.nanmin(x[there], axis=1), np.nanmax(x[there], axis=1)
    low_y[there], high_y[there] = np.nanmin(y[there], axis=1), np.nanmax(y[there], axis=1)
    apart = np.maximum(low_x[:, None] - high_x, low_x - high_x[:, None]), np.maximum(low_y[:, None] - high_y, low_y - high_y[:, None])
    return (apart[0] < reach) & (apart[1] < reach)


def outlines(record: Record, i: int, j: int, samples: np.ndarray) -> Outlines:
    """Two rows of a record at some samples."""
    one, other = (middle(record, row, samples) for row in (i, j))
    psi, phi = (record.channel("heading")[row, samples] for row in (i, j))
    cosine = np.cos(psi - phi)
    alike = np.where(cosine > PARALLEL, 1.0, np.where(cosine < -PARALLEL, -1.0, 0.0))
    along = np.array([np.cos(psi) + alike * np.cos(phi), np.sin(psi) + alike * np.sin(phi)])
    along = along / np.hypot(*along)
    across = np.array([-along[1], along[0]])
    forward, left = ((each * (other - one)).sum(axis=0) for each in (along, across))
    a, b = (record.bodies[record.vehicles[row]] for row in (i, j))
    speeds = [record.channel("speed")[row, samples] * np.array([np.cos(angle), np.sin(angle)]) for row, angle in ((i, psi), (j, phi))]
    speed, other_speed, drift, other_drift = [(axis * each).sum(axis=0) for axis in (along, across) for each in speeds]
    gap, aside = np.abs(forward) - 0.5 * (a.length + b.length), np.abs(left) - 0.5 * (a.width + b.width)
    return Outlines(record.time[samples], forward, left, gap, aside, speed, other_speed, drift, other_drift, alike)


def way_aside(record: Record) -> np.ndarray:
    """How far [m] every vehicle would have to be aside to pass what is ahead on the nearer side, float64[vehicle, n].

    Not a number while nobody is ahead who was recorded.
    """
    found = np.full((len(record.vehicles), record.time.size), np.nan)
    row = rows_ahead(record)
    for i in range(found.shape[0]):
        for j in np.unique(row[i][row[i] >= 0]).tolist():
            samples = np.flatnonzero(row[i] == j)
            found[i, samples] = np.maximum(-outlines(record, i, j, samples).aside, 0.0)
    return found


def middle(record: Record, row: int, samples: np.ndarray) -> np.ndarray:
    """The middle of a body [m], float64[2, n]."""
    body: Body = record.bodies[record.vehicles[row]]
    psi, back = record.channel("heading")[row, samples], body.front - 0.5 * body.length
    x, y = record.channel("x")[row, samples], record.channel("y")[row, samples]
    return np.array([x + back * np.cos(psi), y + back * np.sin(psi)])
