"""Encroachment: two vehicles that pass the same piece of road one after the other on crossing ways.

PET = time from the moment at which the first one's rear leaves the conflict area to that at which the second one's front enters it
(B. L. Allen, B. T. Shin, P. J. Cooper, Analysis of traffic conflicts and collisions, Transportation Research Record 667 (1978) 67).
Negative: both were on it at the same time.

Where two ways cross at an angle φ, the strips of the widths w and w' that the bodies sweep overlap over this part of the first way, on
either side of the crossing point:

    e = (w'/2 + |cos φ| w/2)/|sin φ|

Who backs goes first with his rear, which is his front then. Where he turns round another way begins, so that whoever does so on a conflict
area has neither passed it nor entered it.
"""

from collections.abc import Iterator
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from studio.execution.record import Body, Record
from studio.kind.metric import Found

STEP = 2.0  # [m] length of the pieces that ways are cut into when crossings are looked for
CELL = 4.0  # [m] of the grid in which they are looked for, where pieces are not longer
WIDE = 1 << 24  # cells that a row of the grid has room for
FASTEST = 100.0  # [m/s] nobody drives faster: who seems to was put elsewhere
STANDING = 0.05  # [m/s] who is slower stands
CROSSING = 0.3  # [1] sine of the angle below which ways do not cross: they follow or merge


class Way(NamedTuple):
    """What a vehicle has driven in one direction: its places [m] float64[2, n], its driven way [m] and the times [s] there."""

    places: np.ndarray
    driven: np.ndarray
    time: np.ndarray
    vehicle: str
    body: Body
    front: float  # [m] of what goes first, ahead of its centre of gravity


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
    for a, b, crossing in crossings([way for row in range(len(record.vehicles)) for way in ways_of(record, row)]):
        found = encroachment(a, b, crossing)
        if np.isfinite(found.value):
            yield found


def ways_of(record: Record, row: int) -> list[Way]:
    """What a vehicle of a record has driven, while it took part; until it was put elsewhere, as traffic is that comes in again."""
    places = np.array([record.channel("x")[row], record.channel("y")[row]])
    there = np.isfinite(places).all(axis=0)
    places, time, speed = places[:, there], record.time[there], record.channel("speed")[row][there]
    steps = np.hypot(*np.diff(places))
    jumps = np.flatnonzero(steps > FASTEST * np.diff(time))
    last = int(jumps[0]) + 1 if jumps.size else time.size
    driven, name = np.concatenate([[0.0], np.cumsum(steps)])[:last], record.vehicles[row]
    body = record.bodies[name]
    return [
        Way(places[:, part], driven[part], time[part], name, body, body.length - body.front if backs else body.front)
        for part, backs in parts(speed[:last])
        if part.stop - part.start > 1
    ]


def parts(speed: np.ndarray) -> Iterator[tuple[slice, bool]]:
    """Samples in which somebody drives in one direction, and whether that is backwards; who stands goes on as he did before."""
    moves = np.flatnonzero(np.abs(speed) > STANDING)
    if not moves.size:
        return
    turns = moves[1:][np.diff(speed[moves] < 0.0)]
    for start, stop in pairwise([0, *turns.tolist(), speed.size]):
        yield slice(start, stop), bool(speed[max(start, moves[0])] < 0.0)


def encroachment(a: Way, b: Way, crossing: Crossing) -> Found:
    """PET at one crossing; not a number when one of them has not passed it."""
    spans = [
        (way.vehicle, passes(way.driven, way.time, front=way.front, length=way.body.length, begin=at - e, end=at + e))
        for way, at, e in (
            (a, crossing.first, reach(a.body.width, b.body.width, crossing)),
            (b, crossing.second, reach(b.body.width, a.body.width, crossing)),
        )
    ]
    (first, (came, leaves)), (second, (enters, _)) = sorted(spans, key=lambda each: each[1][0])
    if not came <= enters:  # one of them began on the area, of whom nobody knows when he came
        return Found(float("nan"))
    return Found(post_encroachment(leaves, enters), (second, first), enters)


def crossings(ways: list[Way]) -> Iterator[tuple[Way, Way, Crossing]]:
    """All crossings of the ways of different vehicles."""
    pieces = Pieces.of(ways)
    for a, b in candidates(pieces).tolist():
        crossing = crossing_of(pieces.ends[:, :, a], pieces.ends[:, :, b])
        if crossing is not None:
            yield ways[pieces.way[a]], ways[pieces.way[b]], crossing


def pieces_of(way: Way) -> np.ndarray:
    """A way in straight pieces of about STEP: x, y and driven way [m] at both ends of each, float64[3, 2, m]."""
    wanted = np.arange(way.driven[0], way.driven[-1], STEP)
    kept = np.unique(np.concatenate([np.searchsorted(way.driven, wanted), [way.driven.size - 1]]))
    kept = kept[np.diff(way.driven[kept], prepend=-1.0) > 0.0]
    at = np.array([*way.places[:, kept], way.driven[kept]])
    return np.stack([at[:, :-1], at[:, 1:]], axis=1)


class Pieces(NamedTuple):
    """Pieces of all ways, those of one after those of another: float64[3, 2, piece], the number of the vehicle and of the way of each."""

    ends: np.ndarray
    vehicle: np.ndarray
    way: np.ndarray

    @classmethod
    def of(cls, ways: list[Way]) -> "Pieces":
        """All of them."""
        each = [pieces_of(way) for way in ways]
        way = np.repeat(np.arange(len(each)), [part.shape[2] for part in each])
        numbers = {name: number for number, name in enumerate(dict.fromkeys(way.vehicle for way in ways))}
        return cls(
            np.concatenate([np.zeros((3, 2, 0)), *each], axis=2), np.array([numbers[each.vehicle] for each in ways], dtype=int)[way], way
        )


def candidates(pieces: Pieces) -> np.ndarray:
    """Pieces of different vehicles that share a cell of a grid, int[pair, 2]; cells in which everybody drives alike have none."""
    cell, piece = touched(pieces.ends[:2])
    first = np.flatnonzero(np.diff(cell, prepend=-1))
    found = [np.zeros((0, 2), dtype=int)]
    for start, stop in pairwise([*first.tolist(), cell.size]):
        inside = piece[start:stop]
        if is_mixed(pieces, inside):
            pairs = inside[np.stack(np.triu_indices(inside.size, 1), axis=1)]
            found.append(pairs[pieces.vehicle[pairs[:, 0]] != pieces.vehicle[pairs[:, 1]]])
    return np.unique(np.sort(np.concatenate(found), axis=1), axis=0)


def touched(ends: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Numbers of cells and the pieces in them, cell after cell; a piece is no longer than a cell, and is in those of its corners."""
    size = max(CELL, float(np.hypot(*(ends[:, 1] - ends[:, 0])).max(initial=0.0)))
    low, high = (np.floor(edge / size).astype(np.int64) for edge in (ends.min(axis=1), ends.max(axis=1)))
    corners = [(x[0], y[1]) for x in (low, high) for y in (low, high)]
    pairs = np.concatenate([np.stack([x * WIDE + y, np.arange(x.size)], axis=1) for x, y in corners])
    pairs = np.unique(pairs, axis=0)
    return np.unique(pairs[:, 0], return_inverse=True)[1], pairs[:, 1]


def is_mixed(pieces: Pieces, inside: np.ndarray) -> bool:
    """Whether some pieces are of several vehicles, and not all in about the same direction or the opposite one."""
    if inside.size < 2 or (pieces.vehicle[inside] == pieces.vehicle[inside[0]]).all():
        return False
    east, north = pieces.ends[:2, 1, inside] - pieces.ends[:2, 0, inside]
    turned = np.abs(east * north[0] - north * east[0])
    return bool((turned > 0.5 * CROSSING * np.hypot(east, north) * np.hypot(east[0], north[0])).any())


def crossing_of(a: np.ndarray, b: np.ndarray) -> Crossing | None:
    """Where a piece of one way crosses a piece of another, float64[3, 2] each; None where they do not, or hardly."""
    (x, y, s), (u, v, t) = a[:, 0], b[:, 0]
    (dx, dy, ds), (du, dv, dt) = a[:, 1] - a[:, 0], b[:, 1] - b[:, 0]
    lengths = np.hypot(dx, dy) * np.hypot(du, dv)
    if lengths == 0.0 or abs(dx * dv - dy * du) < CROSSING * lengths:
        return None
    turned = dx * dv - dy * du
    p, q = ((u - x) * dv - (v - y) * du) / turned, ((u - x) * dy - (v - y) * dx) / turned
    if not (0.0 <= p < 1.0 and 0.0 <= q < 1.0):
        return None
    return Crossing(float(s + p * ds), float(t + q * dt), float(turned / lengths), float((dx * du + dy * dv) / lengths))
