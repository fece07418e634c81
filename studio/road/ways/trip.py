"""A trip to try a map with: from somewhere to somewhere else, drawn by lot, and the same every time."""

from dataclasses import dataclass

import numpy as np

from studio.errors import MapError, Problem, RouteError
from studio.model.random import TRIP, uniform
from studio.road.network import Network
from studio.road.network.curve import LOCK
from studio.road.ways.path import PATH_SPEED, Path, path
from studio.road.ways.route import connect

LONG_ENOUGH, TOO_LONG = 500.0, 3000.0  # [m]
SHORTEST = 60.0  # [m] a car needs some road
START = 5.0  # [m] from the start of the first road: the whole car is on it
CLEAR = 80.0  # [m] without a stop line ahead of the start: a car at 20 m/s can still stop there
TRIES = 60


@dataclass(frozen=True)
class Trip:
    """From the first road to the last one, the quickest way; `start` and `speed` are where and how fast a car begins."""

    roads: tuple[str, ...]
    path: Path
    start: float  # [m]
    speed: float  # [m/s]

    @property
    def length(self) -> float:
        """What there is to drive [m]."""
        return self.path.length - self.start

    @property
    def time(self) -> float:
        """How long it takes without a red light [s]."""
        return float(np.sum(1.0 / self.path.points[PATH_SPEED, int(self.start) :]))

    @property
    def starts_clear(self) -> bool:
        """Whether no stop line is near the start."""
        return not any(0.0 <= stop - self.start < CLEAR for stop, _ in self.path.stop_lines)


def trip(network: Network, *, seed: int = 1, lock: float = LOCK) -> Trip:
    """The first trip drawn for a vehicle of a lock [1/m] that is long enough and starts clear; where there is none, the longest one drawn.

    Raises:
        MapError: the roads do not connect to anything that one could drive along.
    """
    roads = [road.id for road in network.roads.values() if not road.internal and any(lane.open for lane in network.lanes_of(road.id))]
    drawn = []
    for i in range(TRIES if roads else 0):
        start, end = (roads[int(uniform(seed, i, TRIP, which) * len(roads))] for which in (0, 1))
        found = between(network, start, end, lock)
        if found is None:
            continue
        if LONG_ENOUGH <= found.length <= TOO_LONG and found.starts_clear:
            return found
        drawn.append(found)
    best = max(drawn, key=lambda each: (min(each.length, LONG_ENOUGH), each.starts_clear, -each.length), default=None)
    if best is None:
        problem = Problem("roads", "do not connect", f"{len(roads)} roads", f"a way of {SHORTEST:g} m", "import a larger part of the map")
        raise MapError(f"{network.name}: there is no way to drive along.", [problem])
    return best


def between(network: Network, start: str, end: str, lock: float = LOCK) -> Trip | None:
    """The trip from one road to another for a vehicle of a lock [1/m]; None where there is no way, or hardly any."""
    roads = (start,) if start == end else (start, end)
    try:
        line = path(network, connect(network, roads, lock=lock), lock=lock)
    except RouteError:
        return None
    if line.length < SHORTEST:
        return None
    return Trip(roads, line, START, float(line.points[PATH_SPEED, int(START)]))
