"""Floors: the roads that lie above each other at a place, the land beside them, and which of them a line on the map follows.

floors_at(network, x, y)                      →  Floor, ...   who may stand there, on what: what one means first is the first
followed(network, line, level, height)        →  Tread        the floor under a line, all along it

At the beginning of a line the floor is the one of a level or a height that is told; else the land, or what is nearest to it. From there on
it is always the one that is nearest in height to that before: up a ramp one comes onto the bridge, and below it one stays below.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from studio.road.network import Network
from studio.road.network.index import once
from studio.road.ways.relief import APART, SPACING, Relief, along, levels, relief_of, slopes, stationed, tree_of

PAVEMENT = 4.0  # [m] beside a lane one is still on its deck


class Floor(NamedTuple):
    """What one stands on: its height [m], on which level of the map, and how high above the land [m]."""

    height: float
    level: float
    lift: float


class Tread(NamedTuple):
    """The floor under a line: float64[n] stations [m] along it, and height [m], level [1] and lift [m] there."""

    station: np.ndarray
    height: np.ndarray
    level: np.ndarray
    lift: np.ndarray

    def at(self, s: float) -> Floor:
        """The floor at a station [m]."""
        return Floor(*(float(np.interp(s, self.station, row)) for row in self[1:]))


GROUND = Tread(*np.zeros((4, 1)))  # of a map without heights


@dataclass(frozen=True, eq=False)
class Floors:
    """Places float64[2, n] along all lanes [m], and there: height [m], its slope float64[2, n], level, lift [m], lane, half the lane's
    width [m]."""

    at: np.ndarray
    height: np.ndarray
    slope: np.ndarray
    level: np.ndarray
    lift: np.ndarray
    lane: np.ndarray
    half: np.ndarray

    @cached_property
    def tree(self):
        """Where places are looked for."""
        return tree_of(self.at)

    def around(self, x: float, y: float) -> list[Floor]:
        """The floors at a place, one for each lane on whose deck it is; the land where it is on none."""
        near = np.array(self.tree.query_ball_point((x, y), float(self.half.max()) + PAVEMENT + SPACING), dtype=int)
        far = np.hypot(*(self.at[:, near] - [[x], [y]]))
        found: dict[int, int] = {}
        for k in np.argsort(far, kind="stable").tolist():
            found.setdefault(int(self.lane[near[k]]), int(near[k]))
        on = [i for i in found.values() if np.hypot(*self.apart(i, x, y)) <= self.half[i] + PAVEMENT]
        return [self.floor(i, x, y) for i in on] or [self.land(int(self.tree.query((x, y))[1]))]

    def apart(self, i: int, x: float, y: float) -> tuple[float, float]:
        """How far a place is from place i, but for what is along its lane within `SPACING` [m]."""
        d_x, d_y = x - self.at[0, i], y - self.at[1, i]
        east, north = self.along[:, i]
        ahead = float(np.clip(d_x * east + d_y * north, -SPACING, SPACING))
        return d_x - ahead * east, d_y - ahead * north

    @cached_property
    def along(self) -> np.ndarray:
        """float64[2, n]: the direction of the lane at every place."""
        first = np.concatenate([[0], np.flatnonzero(np.diff(self.lane)) + 1, [self.lane.size]])
        step = np.concatenate([np.gradient(self.at[:, a:b], axis=1) for a, b in pairwise(first)], axis=1)
        return step / np.maximum(np.hypot(*step), 1e-9)

    def floor(self, i: int, x: float, y: float) -> Floor:
        """The deck of the lane of place i, at a place near it."""
        d_x, d_y = np.clip([x - self.at[0, i], y - self.at[1, i]], -SPACING, SPACING)
        rise = self.slope[0, i] * d_x + self.slope[1, i] * d_y
        return Floor(float(self.height[i] + rise), float(self.level[i]), float(self.lift[i] + (rise if self.lift[i] else 0.0)))

    def land(self, i: int) -> Floor:
        """The land under place i."""
        return Floor(float(self.height[i] - self.lift[i]), 0.0, 0.0)


@once
def floors_of(network: Network) -> Floors | None:
    """All places of a map on which one may stand; None for one that lies on the ground all over."""
    if not any(lane.height.any() for lane in network.lanes):
        return None
    stations, first = stationed(network.lanes)
    x, y, z, level = along(network.lanes, stations, first, [(*lane.centre, lane.height, levels(lane)) for lane in network.lanes])
    relief: Relief | None = relief_of(network)
    lift = relief.lift if relief is not None else np.zeros(z.size)
    lane = np.repeat(np.arange(len(network.lanes)), np.diff(first))
    half = np.array([each.width for each in network.lanes])[lane] / 2.0
    return Floors(np.stack([x, y]), z, slopes(np.stack([x, y, z]), z, first), level, lift, lane, half)


def floors_at(network: Network, x: float, y: float) -> tuple[Floor, ...]:
    """The floors at a place, those that are one told once: the one on the land or nearest to it first."""
    found = floors_of(network)
    if found is None:
        return (Floor(0.0, 0.0, 0.0),)
    ordered = sorted(found.around(x, y), key=lambda each: (abs(each.level), abs(each.lift), each.height))
    told: list[Floor] = []
    for each in ordered:
        if all(abs(each.height - other.height) >= APART for other in told):
            told.append(each)
    return tuple(told)


def followed(network: Network, line: Sequence[tuple[float, float]], level: float | None = None, height: float | None = None) -> Tread:
    """The floor under a line [m] all along it, from the one of a level, of a height [m], or what is nearest to the land."""
    found = floors_of(network)
    if found is None:
        return GROUND
    (x, y), *_ = line
    here = begun(floors_at(network, x, y), level, height)
    rows = [(0.0, *here)]
    for s, x, y in places(line):
        last = here.height
        here = min(found.around(x, y), key=lambda each: abs(each.height - last))
        rows.append((s, *here))
    return Tread(*np.array(rows).T)


def begun(floors: Sequence[Floor], level: float | None, height: float | None) -> Floor:
    """The floor on which a line begins."""
    if height is not None:
        return min(floors, key=lambda each: abs(each.height - height))
    return min(floors, key=lambda each: abs(each.level - level)) if level is not None else floors[0]


def places(line: Sequence[tuple[float, float]]) -> list[tuple[float, float, float]]:
    """Stations [m] and places [m] along a line at equal distances, every corner but the first among them."""
    found, begin = [], 0.0
    for (x, y), (to_x, to_y) in pairwise(line):
        length = float(np.hypot(to_x - x, to_y - y))
        shares = np.linspace(0.0, 1.0, max(int(np.ceil(length / SPACING)), 1) + 1)[1:].tolist()
        found += [(begin + share * length, x + share * (to_x - x), y + share * (to_y - y)) for share in shares]
        begin += length
    return found
