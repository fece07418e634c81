"""Encroachment: two vehicles that pass the same piece of road one after the other on crossing ways.

PET = time from the moment at which the first one's rear leaves the conflict area to that at which the second one's front enters it
(B. L. Allen, B. T. Shin, P. J. Cooper, Analysis of traffic conflicts and collisions, Transportation Research Record 667 (1978) 67).
Negative: both were on it at the same time.

Where two ways cross at an angle φ, the strips of the widths w and w' that the bodies sweep overlap over this part of the first way, on
either side of the crossing point:

    e = (w'/2 + |cos φ| w/2)/|sin φ|
"""

from collections.abc import Iterator
from itertools import combinations
from typing import NamedTuple

import numpy as np

from studio.execution.record import Body, Record
from studio.kind.metric import Found

STEP = 2.0  # [m] length of the pieces that ways are cut into when crossings are looked for
CELL = 4.0  # [m] of the grid in which they are looked for
FASTEST = 100.0  # [m/s] nobody drives faster: who seems to was put elsewhere
CROSSING = 0.3  # [1] sine of the angle below which ways do not cross: they follow or merge


class Way(NamedTuple):
    """What a vehicle has driven: its places [m] float64[2, n], its driven way [m] and the times [s] there."""

    places: np.ndarray
    driven: np.ndarray
    time: np.ndarray


class Crossing(NamedTuple):
    """Where two ways cross: how far each had driven [m], and the sine and cosine of the angle between them."""

    first: float
    second: float
    sine: float
    cosine: float


def post_encroachment(leaves: float, enters: float) -> float:
    """PET [s] of one who leaves and another who enters."""
    return enters - leaves


def passes(driven: np.ndarray, time: np.ndarray, *, front: float, length: float, begin: float, end: float) -> tuple[float, float]:
    """When [s] the front of a vehicle enters, and its rear leaves, an area from `begin` to `end` [m] of its way; not a number for never.

    `driven` [m] is that of its centre of gravity, which the front is `front` [m] ahead of.
    """
    return moment_at(driven, time, begin - front), moment_at(driven, time, end - front + length)


def moment_at(driven: np.ndarray, time: np.ndarray, place: float) -> float:
    """When [s] a way was reached, by a straight line between two samples; not a number when it never was."""
    if not driven.size or not driven[0] <= place <= driven[-1]:
        return float("nan")
    i = max(int(np.searchsorted(driven, place)), 1)
    way = driven[i] - driven[i - 1]
    return float(time[i - 1] + (time[i] - time[i - 1]) * ((place - driven[i - 1]) / way if way > 0.0 else 0.0))


def reach(own: float, other: float, crossing: Crossing) -> float:
    """e [m] for the own and the other width."""
    return (0.5 * other + abs(crossing.cosine) * 0.5 * own) / abs(crossing.sine)


# -- in a record ---------------------------------------------------------------------------------------


def encroachments(record: Record) -> Iterator[Found]:
    """PET of every two recorded vehicles whose ways cross: the second one after the first one, when it enters."""
    ways = {name: way for i, name in enumerate(record.vehicles) if (way := way_of(record, i)).driven.size > 1}
    for a, b, crossing in crossings(ways):
        found = encroachment(a, ways[a], record.bodies[a], b, ways[b], record.bodies[b], crossing)
        if np.isfinite(found.value):
            yield found


def way_of(record: Record, row: int) -> Way:
    """What a vehicle of a record has driven, while it took part; until it was put elsewhere, as traffic is that comes in again."""
    places = np.array([record.channel("x")[row], record.channel("y")[row]])
    there = np.isfinite(places).all(axis=0)
    places, time = places[:, there], record.time[there]
    steps = np.hypot(*np.diff(places))
    jumps = np.flatnonzero(steps > FASTEST * np.diff(time))
    last = int(jumps[0]) + 1 if jumps.size else time.size
    return Way(places[:, :last], np.concatenate([[0.0], np.cumsum(steps)])[:last], time[:last])


def encroachment(a: str, way_a: Way, body_a: Body, b: str, way_b: Way, body_b: Body, crossing: Crossing) -> Found:
    """PET at one crossing; not a number when one of them has not passed it."""
    spans = [
        (name, passes(way.driven, way.time, front=body.front, length=body.length, begin=at - e, end=at + e))
        for name, way, body, at, e in (
            (a, way_a, body_a, crossing.first, reach(body_a.width, body_b.width, crossing)),
            (b, way_b, body_b, crossing.second, reach(body_b.width, body_a.width, crossing)),
        )
    ]
    (first, (_, leaves)), (second, (enters, _)) = sorted(spans, key=lambda each: each[1][0])
    return Found(post_encroachment(leaves, enters), (second, first), enters)


def crossings(ways: dict[str, Way]) -> Iterator[tuple[str, str, Crossing]]:
    """All crossings of the ways of different vehicles; of two that cross several times within a cell, one."""
    names = list(ways)
    pieces = [pieces_of(ways[name]) for name in names]
    for i, j, k, l in sorted(near(pieces)):
        crossing = crossing_of(pieces[i], k, pieces[j], l)
        if crossing is not None:
            yield names[i], names[j], crossing


def pieces_of(way: Way) -> np.ndarray:
    """A way in straight pieces of about STEP: x, y and driven way [m] at their ends, float64[3, m + 1]."""
    wanted = np.arange(way.driven[0], way.driven[-1], STEP)
    kept = np.unique(np.concatenate([np.searchsorted(way.driven, wanted), [way.driven.size - 1]]))
    return np.array([*way.places[:, kept], way.driven[kept]])


def near(pieces: list[np.ndarray]) -> set[tuple[int, int, int, int]]:
    """Pieces k of vehicle i and l of vehicle j > i that share a cell of the grid, as (i, j, k, l)."""
    cells: dict[tuple[int, int], list[tuple[int, int]]] = {}
    for i, each in enumerate(pieces):
        for k in range(each.shape[1] - 1):
            for cell in touched(each[:2, k : k + 2]):
                cells.setdefault(cell, []).append((i, k))
    shared = [pair for inside in cells.values() if len({i for i, _ in inside}) > 1 for pair in combinations(inside, 2)]
    return {(i, j, k, l) for (i, k), (j, l) in shared if i != j}


def touched(ends: np.ndarray) -> Iterator[tuple[int, int]]:
    """Cells that the box around a piece touches."""
    low, high = (np.floor(np.array([ends.min(axis=1), ends.max(axis=1)]) / CELL)).astype(int).tolist()
    return ((x, y) for x in range(low[0], high[0] + 1) for y in range(low[1], high[1] + 1))


def crossing_of(a: np.ndarray, k: int, b: np.ndarray, l: int) -> Crossing | None:
    """Where piece k of one way crosses piece l of another; None where they do not, or hardly."""
    (x, y, s), (u, v, t) = a[:, k], b[:, l]
    (dx, dy, ds), (du, dv, dt) = a[:, k + 1] - a[:, k], b[:, l + 1] - b[:, l]
    lengths = np.hypot(dx, dy) * np.hypot(du, dv)
    if lengths == 0.0 or abs(dx * dv - dy * du) < CROSSING * lengths:
        return None
    turned = dx * dv - dy * du
    p, q = ((u - x) * dv - (v - y) * du) / turned, ((u - x) * dy - (v - y) * dx) / turned
    if not (0.0 <= p < 1.0 and 0.0 <= q < 1.0):
        return None
    return Crossing(float(s + p * ds), float(t + q * dt), float(turned / lengths), float((dx * du + dy * dv) / lengths))
