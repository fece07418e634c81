"""Finding: what is named in the settings of a script as numbers, world by world. Pairs and corners go into one pool for all worlds."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from studio.kind import registry
from studio.kind.area import Area
from studio.road.network import Network
from studio.road.ways.detour import lane_line
from studio.road.ways.path import PATH_HEADING, PATH_SPACING, PATH_X, PATH_Y
from studio.world.line import starts
from studio.world.mail import number_of
from studio.world.setting import Setting
from studio.world.table.street import OBJECT
from studio.world.world import Worlds

Pair = tuple[float, float]
APART = 5.0  # [m] corners along the edges of a lane


@dataclass
class Found:
    """What is looked at besides: pairs of numbers, and names of values with the number of their world."""

    pairs: list[Pair] = field(default_factory=list)
    watched: list[tuple[int, str]] = field(default_factory=list)

    def keep(self, pairs: Sequence[Pair]) -> Pair:
        """Puts pairs into the pool; where they begin, and how many they are."""
        self.pairs += pairs
        return float(len(self.pairs) - len(pairs)), float(len(pairs))

    @property
    def pool(self) -> np.ndarray:
        """All pairs, float64[2, pair]."""
        return np.array(self.pairs, dtype=float).reshape(-1, 2).T.copy()


@dataclass
class Finder:
    """What the names of one world stand for: columns of vehicles, numbers of entries, routes, lights and objects."""

    world: int
    setting: Setting
    numbers: dict[str, dict[str, float]]
    found: Found

    def __call__(self, what: str, name: Any) -> Any:
        """The number of what is named; of pairs and areas as many as they have."""
        if what == "points":
            return self.found.keep([(float(a), float(b)) for a, b in name])
        if what == "area":
            return self.area(name)
        if what == "value":
            self.found.watched.append((self.world, name))
            return float(len(self.found.watched) - 1)
        return self.numbers[what][name]

    def area(self, of: Area) -> tuple[float, ...]:
        """A circle, or corners in the pool."""
        if of.x is not None and of.y is not None and of.radius is not None:
            return (of.x, of.y, of.radius, 0.0, 0.0)
        return (0.0, 0.0, 0.0, *self.found.keep(corners(of, self.setting.network)))


def corners(of: Area, network: Network) -> list[Pair]:
    """The corners of a polygon, or of a stretch of a lane: along its right edge and back on the left."""
    if of.road is None:
        return of.corners
    lane = network.lanes_of(of.road)[of.lane]
    points = lane_line(network, lane).points
    grid = np.arange(points.shape[1]) * PATH_SPACING
    end = min(of.end if of.end is not None else np.inf, float(grid[-1]))
    at = np.linspace(of.start, end, max(2, int((end - of.start) / APART) + 1))
    x, y, heading = (np.interp(at, grid, points[row]) for row in (PATH_X, PATH_Y, PATH_HEADING))
    east, north = 0.5 * lane.width * np.sin(heading), 0.5 * lane.width * np.cos(heading)
    right, left = zip(x + east, y - north, strict=True), zip(x - east, y + north, strict=True)
    return [(float(a), float(b)) for a, b in [*right, *[*left][::-1]]]


def finders(settings: Sequence[Setting], worlds: Worlds, movers: list[dict[str, int]]) -> tuple[list[Finder], Found]:
    """One for each world; `movers` are the numbers of objects among all, by the entries that bring them."""
    found, made = Found(), []
    entries, lights, units = (starts(np.array(counts)) for counts in (
        [len(each.scenario.script) for each in settings], [len(each.network.signals) for each in settings],
        [len(each.scenario.vehicles) + len(each.scenario.stations) for each in settings],
    ))  # fmt: skip
    for w, each in enumerate(settings):
        columns = {name: float(worlds.first[w] + i) for i, name in enumerate(each.names)}
        signals = each.network.signals
        roads = [each.network.lanes[lane].road for lane in signals.link_lane]
        numbers = {
            "vehicle": columns,
            "unit": {name: float(units[w] + i) for i, name in enumerate((*each.scenario.vehicles, *each.scenario.stations))},
            "message": {name: float(number_of(name)) for name in registry.known("message")},
            "body": columns | {name: float(OBJECT - number) for name, number in movers[w].items()},
            "entry": {name: float(entries[w] + i) for i, name in enumerate(each.scenario.script)},
            "route": {name: float(i) for i, name in enumerate(each.scenario.routes)},
            "signal": {road: float(lights[w] + roads.index(road)) for road in dict.fromkeys(roads)},
        }
        made.append(Finder(w, each, numbers, found))
    return made, found
