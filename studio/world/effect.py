"""Effects: what an action may do to the world. An action gives a list of these, as many and as different as it likes.

Limit, Slippery, Row        about a stretch of a route or lane
Closing, Shift              about a stretch of one lane, with tapers
Walk                        somebody who moves, on a line of the map
WeatherChange, Lights       about the whole world, or the lights of a road
Placement, Removal          about a vehicle
Jam, Delay, Drop            about the radio
SensorFault, Switch, Tune   about what a unit has on board
End                         about the run

They are data: names and stations, which the world looks up on its map.
"""

from collections.abc import Mapping, Sequence
from types import MappingProxyType
from typing import Any, Literal, NamedTuple

import numpy as np

from studio.application import port
from studio.errors import Problem, RouteError, nearest
from studio.kind import registry
from studio.kind.area import Area
from studio.kind.stretch import LaneStretch, Stretch
from studio.road.network import Network
from studio.road.network.curve import LOCK
from studio.road.ways import path as road_path
from studio.road.ways.detour import lane_line
from studio.road.ways.path import PATH_HEADING, PATH_SPACING, PATH_X, PATH_Y, Path
from studio.road.ways.relief import height_at
from studio.road.ways.route import connect
from studio.scenario.schema import Scenario

MOST_OBJECTS = 500  # in one row


class Limit(NamedTuple):
    """A limit [m/s] on all lanes of a stretch."""

    stretch: Stretch
    speed: float


class Slippery(NamedTuple):
    """Another friction [1] along a stretch, so far [m] to the left and to the right of its line."""

    stretch: Stretch
    friction: float
    left: float
    right: float


class Row(NamedTuple):
    """Objects along a stretch, every `spacing` [m], `offset` [m] to the left of its line."""

    stretch: Stretch
    what: Literal["cones", "barriers"]
    spacing: float
    offset: float


class Closing(NamedTuple):
    """A closed lane, with its cones and barriers; cars go over to the nearest open lane."""

    stretch: LaneStretch


class Shift(NamedTuple):
    """A lane whose line is moved by `offset` [m] to the left."""

    stretch: LaneStretch
    offset: float


class Walk(NamedTuple):
    """Somebody who moves along a line [m] on the map with a speed [m/s], and `stays` at its end or is gone; length and width [m].

    Without speed it stands at the first corner, and looks towards the second. Where roads lie above each other it begins on the one of this
    `level` of the map, or of this `height` [m]; else on the land, or what is nearest to it.
    """

    who: Literal["pedestrian", "cyclist", "box", "cylinder", "cone", "barrier", "wall", "tree"]
    line: tuple[tuple[float, float], ...]
    speed: float
    stays: bool
    size: tuple[float, float]
    level: int | None = None
    height: float | None = None


class WeatherChange(NamedTuple):
    """Another friction [1], another visibility [m], or both, everywhere."""

    friction: float | None
    visibility: float | None


class Lights(NamedTuple):
    """What the lights at the end of a road show, whatever their programme says."""

    road: str
    shows: Literal["red", "red_amber", "green", "amber"]


class Jam(NamedTuple):
    """An area in which units hear nothing."""

    area: Area


class Delay(NamedTuple):
    """What a unit sends, or everybody, comes later by a time [s]."""

    unit: str | None
    delay: float


class Drop(NamedTuple):
    """So many of the next messages of a unit reach nobody."""

    unit: str
    count: int


class SensorFault(NamedTuple):
    """A sensor of a unit, or all of them, gives nothing, or has its noise times a factor [1]."""

    unit: str
    sensor: str | None
    fails: bool
    noise: float


class Switch(NamedTuple):
    """A group of applications does not run, on one unit or on all."""

    group: str
    unit: str | None


class Tune(NamedTuple):
    """A group of applications has other parameters, on one unit or on all."""

    group: str
    unit: str | None
    parameters: dict[str, Any]


class Placement(NamedTuple):
    """A vehicle is put on its route at a station [m], with a speed [m/s]."""

    vehicle: str
    along: float
    speed: float


class Removal(NamedTuple):
    """A vehicle is taken away."""

    vehicle: str


class End(NamedTuple):
    """The run ends."""


OnRoad = Limit | Slippery | Row | Closing | Shift  # which lie somewhere
Deed = WeatherChange | Lights | Jam | Delay | Drop | SensorFault | Switch | Tune | Placement | Removal
Effect = OnRoad | Walk | Deed | End


class Place:
    """What an action may ask about the map: lengths and lanes. `locks` are the sharpest curves [1/m] of those who drive a route, by its
    name; of one that is not among them that of a car."""

    def __init__(self, scenario: Scenario, network: Network, locks: Mapping[str, float] = MappingProxyType({})) -> None:
        self.scenario, self.network, self.locks = scenario, network, locks

    def never(self, condition: Any) -> str:
        """Why a condition can never hold here, in words; empty when it may."""
        module = registry.find("condition", condition.kind).module
        return module.never(condition, self) if hasattr(module, "never") else ""

    @property
    def duration(self) -> float:
        """Of the run [s]."""
        return self.scenario.clock.duration

    def is_off_map(self, area: Area) -> bool:
        """Whether no part of the box around an area lies on the map."""
        if area.x is None or area.y is None or area.radius is None:
            sides = [(min(each), max(each)) for each in zip(*area.corners, strict=True)]
        else:
            sides = [(middle - area.radius, middle + area.radius) for middle in (area.x, area.y)]
        x0, y0, x1, y1 = self.network.bounds
        return any(high < first or low > last for (low, high), first, last in zip(sides, (x0, y0), (x1, y1), strict=False))

    def sent(self) -> set[str]:
        """The kinds of messages that units send by themselves, or that applications here may send."""
        known = registry.known("application")
        modules = [known[each.application].module for each in self.scenario.applications.values() if each.application in known]
        by_applications = {one.kind for module in modules for one in port.done(module) if one.what == port.OUTBOX}
        return by_applications | {name for name, kind in registry.known("message").items() if hasattr(kind.module, "beacon")}

    def lanes(self, road: str) -> int:
        """How many lanes a road has; 0 when there is no such road."""
        return len(self.network.lanes_of(road)) if road in self.roads else 0

    def length(self, stretch: Stretch | LaneStretch) -> float:
        """Length [m] of the route or lane of a stretch; without an end where that does not exist, which is told elsewhere."""
        try:
            return self.line(stretch).length
        except (KeyError, IndexError, RouteError):
            return np.inf

    @property
    def lit(self) -> set[str]:
        """The roads with lights at their end."""
        return {self.network.lanes[lane].road for lane in self.network.signals.link_lane}

    @property
    def roads(self) -> set[str]:
        """The names of all roads."""
        return {road.id for road in self.network.roads.values() if not road.internal}

    def line(self, stretch: Stretch | LaneStretch) -> Path:
        """The line that the stations of a stretch count along."""
        if stretch.road is not None:
            return lane_line(self.network, self.network.lanes_of(stretch.road)[stretch.lane])
        return self.route(str(stretch.route))

    def on_map(self, route: str | None, line: Sequence[tuple[float, float]]) -> tuple[tuple[float, float], ...]:
        """Places that are given as station along a route and distance to its left, or on the map as they are."""
        if route is None or route not in self.scenario.routes:  # a name that there is not is told elsewhere
            return tuple(line)
        return tuple(beside(self.route(route), along, left)[:2] for along, left in line)

    def height(self, route: str | None, along: float) -> float | None:
        """Height [m] of a route at a station [m]; None without one."""
        if route is None or route not in self.scenario.routes:
            return None
        return float(height_at(self.route(route), np.array(along)))

    def route(self, name: str) -> Path:
        """The line of a route; raises KeyError or RouteError."""
        lock = self.locks.get(name, LOCK)
        return road_path.path(self.network, connect(self.network, self.scenario.routes[name].roads, lock=lock), lock=lock)


def beside(line: Path, station: float, offset: float) -> tuple[float, float, float]:
    """Place [m] at a station of a line, `offset` [m] to its left, and its heading there [rad]."""
    grid = np.arange(line.points.shape[1]) * PATH_SPACING
    x, y, heading = (float(np.interp(station, grid, line.points[row])) for row in (PATH_X, PATH_Y, PATH_HEADING))
    return x - offset * float(np.sin(heading)), y + offset * float(np.cos(heading)), heading


def length_problem(stretch: Stretch | LaneStretch, place: Place, at: str) -> list[Problem]:
    """A stretch must lie on a route of the scenario or a lane of the map."""
    if stretch.road is not None:
        return lane_problem(stretch, place, at)
    length = place.length(stretch)
    if length >= stretch.end:
        return []
    return [Problem(f"{at}.end", "lies beyond the end of its route", f"{stretch.end} m", f"≤ {length:.0f} m")]


def lane_problem(stretch: Stretch | LaneStretch, place: Place, at: str) -> list[Problem]:
    """Road, lane, and the length of it."""
    road = str(stretch.road)
    if road not in place.roads:
        return [Problem(f"{at}.road", "names no road of this map", repr(road), remedy=nearest(road, place.roads))]
    if stretch.lane >= place.lanes(road):
        return [Problem(f"{at}.lane", f"names no lane of road {road!r}", str(stretch.lane), f"0 to {place.lanes(road) - 1}")]
    length = np.floor(place.network.lanes_of(road)[stretch.lane].length)
    if stretch.end <= length:
        return []
    return [Problem(f"{at}.end", f"lies beyond the end of road {road!r}", f"{stretch.end} m", f"≤ {length:.0f} m")]


def row_problem(row: Row, at: str) -> list[Problem]:
    """A row must not be endless."""
    count = int((row.stretch.end - row.stretch.start) / row.spacing) + 1
    if count <= MOST_OBJECTS:
        return []
    remedy = "give them a wider spacing"
    return [Problem(f"{at}.spacing", f"makes {count} objects", f"{row.spacing:g} m", f"≤ {MOST_OBJECTS} objects", remedy)]
