"""Locks: which ways through junctions a vehicle can drive. A lock is the sharpest curve that its wheels allow [1/m].

bend_over(approaches, connection, lock)   →  Bend               what is driven over a connection
is_drivable(network, number, lock)        →  bool               whether that keeps near the lane; looked at once for a map and a lock
"""

from typing import NamedTuple

import numpy as np

from studio.road.network import Connection, Network, curve
from studio.road.network.index import once
from studio.road.ways.approach import Approaches
from studio.road.ways.path import Draft, curvature_of, joined, smooth

MOST_ASIDE = 3.0  # [m] beside the middle of its lane a vehicle swings no farther: that is the next lane, or the kerb
GENTLE = 0.8  # [1] times the lock: what is drawn gentler needs no look
SPARSE = 4  # of so many points one is looked at


class Bend(NamedTuple):
    """A line that is driven: its sharpest curvature [1/m], and how far it leaves the lanes' middle [m]."""

    curvature: float
    aside: float

    def is_within(self, lock: float) -> bool:
        """Whether a vehicle of this lock drives it."""
        return self.curvature <= lock and self.aside <= MOST_ASIDE


def bend_over(approaches: Approaches, connection: Connection, lock: float) -> Bend:
    """What a vehicle of a lock drives over a connection; of the ways of coming to it and leaving it the first that suits, or the best."""
    best = None
    for draft, _, _ in approaches.drafts(connection):
        bend = bend_of(draft, lock)
        if bend.is_within(lock):
            return bend
        best = bend if best is None or bend.aside < best.aside else best
    return best or Bend(np.inf, np.inf)


def fitting(approaches: Approaches, connection: Connection, lock: float) -> tuple[Draft, int, int]:
    """The draft of a connection that a vehicle of a lock drives best: as it comes to it straight on, unless that does not suit."""
    if connection.sharpest > lock:
        for made in approaches.drafts(connection):
            if bend_of(made[0], lock).is_within(lock):
                return made
    return approaches.draft(connection)


def bend_of(draft: Draft, lock: float) -> Bend:
    """What a vehicle of a lock drives along a draft."""
    line, _ = smooth(draft, lock)
    aside = float(curve.distances(line[:, ::SPARSE], joined(draft)[0]).max())
    return Bend(max(float(np.abs(curvature_of(line)).max()), 1e-6), aside)


class Known:
    """What has been found out of the connections of a map."""

    def __init__(self, network: Network) -> None:
        self.network, self.approaches = network, Approaches(network)
        self.drivable: dict[tuple[int, float], bool] = {}

    def is_drivable(self, number: int, lock: float) -> bool:
        """Whether a vehicle of a lock can drive over a connection."""
        connection = self.network.connections[number]
        if connection.sharpest <= GENTLE * lock:
            return True
        if (number, lock) not in self.drivable:
            self.drivable[number, lock] = bend_over(self.approaches, connection, lock).is_within(lock)
        return self.drivable[number, lock]


known_of = once(Known)


def is_drivable(network: Network, number: int, lock: float) -> bool:
    """Whether a vehicle of a lock [1/m] can drive over the connection of a number."""
    return known_of(network).is_drivable(number, lock)
