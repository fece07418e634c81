"""Effects: what an action may do to the road. An action gives a list of these, as many and as different as it likes.

Limit, Slippery, Row        about a stretch of a route or lane
Closing, Shift              about a stretch of one lane, with tapers

They are data: names and stations, which the world looks up on its map.
"""

from typing import Literal, NamedTuple

import numpy as np

from studio.errors import Problem, RouteError, nearest
from studio.kind.stretch import LaneStretch, Stretch
from studio.road.network import Network
from studio.road.ways import path as road_path
from studio.road.ways.detour import lane_line
from studio.road.ways.path import Path
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


Effect = Limit | Slippery | Row | Closing | Shift


class Place:
    """What an action may ask about the map: lengths and lanes."""

    def __init__(self, scenario: Scenario, network: Network) -> None:
        self.scenario, self.network = scenario, network

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
    def roads(self) -> set[str]:
        """The names of all roads."""
        return {road.id for road in self.network.roads.values() if not road.internal}

    def line(self, stretch: Stretch | LaneStretch) -> Path:
        """The line that the stations of a stretch count along."""
        if stretch.road is not None:
            return lane_line(self.network, self.network.lanes_of(stretch.road)[stretch.lane])
        return self.route(str(stretch.route))

    def route(self, name: str) -> Path:
        """The line of a route; raises KeyError or RouteError."""
        return road_path.path(self.network, connect(self.network, self.scenario.routes[name].roads))


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
