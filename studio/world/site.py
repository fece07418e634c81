"""Where the changes of a scenario lie: each stretch as a line on the map, each moment as a time or a place.

    place_problems(scenario, network, where)   what is wrong with their places, all of it
    sites(scenario, network)                   →  Site, one for each change, in the order of the file
"""

from collections.abc import Iterator
from dataclasses import dataclass
from math import inf

import numpy as np

from studio.errors import Problem, RouteError, nearest
from studio.road import path as road_path
from studio.road.detour import lane_line
from studio.road.network import Network
from studio.road.path import Path
from studio.road.route import connect
from studio.scenario.schema import Change, Moment, Scenario

WORDS = {
    "limit": "limit {0.speed:g} m/s",
    "friction": "friction {0.friction:g}",
    "objects": "{0.kind} on the road",
}


@dataclass(frozen=True)
class Occasion:
    """A moment with everything resolved: a time [s], or a vehicle and a station [m] of its path."""

    time: float = inf
    vehicle: str = ""
    station: float = 0.0


@dataclass(frozen=True, eq=False)
class Site:
    """One change in its place: `line` is what its stations count along."""

    name: str
    change: Change
    line: Path
    begins: Occasion
    ends: Occasion

    @property
    def text(self) -> str:
        """What it does, in words."""
        return WORDS[self.change.do.change].format(self.change.do)


def sites(scenario: Scenario, network: Network) -> tuple[Site, ...]:
    """Every change in its place; the scenario has none of its `place_problems`."""
    return tuple(
        Site(name, each, line_of(each.do, scenario, network), *(occasion(m, scenario, network) for m in (each.start, each.end)))
        for name, each in scenario.changes.items()
    )


def line_of(do, scenario: Scenario, network: Network) -> Path:
    """The line of a stretch."""
    if do.road is not None:
        return lane_line(network, network.lanes_of(do.road)[do.lane])
    return road_path.path(network, connect(network, scenario.routes[do.route].roads))


def occasion(moment: Moment, scenario: Scenario, network: Network) -> Occasion:
    """A moment, its station counted on the path that the vehicle drives, which may begin later than its route."""
    if moment.time is not None:
        return Occasion(time=moment.time)
    return Occasion(vehicle=moment.vehicle, station=moment.along - joined_at(moment.vehicle, scenario, network))


def joined_at(vehicle: str, scenario: Scenario, network: Network) -> float:
    """Station [m] of its route at which a vehicle's path begins."""
    road = scenario.vehicles[vehicle].position.road
    if road is None:
        return 0.0
    return joins(road, scenario.routes[scenario.vehicles[vehicle].route].roads, network)


def joins(start: str, roads: list[str], network: Network) -> float:
    """Station [m] at which a route from its first road comes to the road on which a vehicle starts."""
    whole = road_path.path(network, connect(network, roads))
    return next((station.s for station in whole.stations if station.road == start), 0.0)


# -- what may be wrong ---------------------------------------------------------------------------------


def place_problems(scenario: Scenario, network: Network, where: str) -> list[Problem]:
    """Roads and lanes that do not exist, stretches and moments beyond what they lie on."""
    found = []
    for name, each in scenario.changes.items():
        at = f"{where}: changes.{name}"
        found += stretch_problems(each.do, scenario, network, f"{at}.do")
        for field, moment in (("start", each.start), ("end", each.end)):
            found += moment_problems(moment, scenario, network, f"{at}.{field}")
    return found


def stretch_problems(do, scenario: Scenario, network: Network, at: str) -> Iterator[Problem]:
    """A stretch must lie on a route of the scenario or a lane of the map."""
    if do.road is not None:
        yield from lane_problems(do, network, at)
    elif (length := route_length(do.route, scenario, network)) < do.end:
        yield Problem(f"{at}.end", "lies beyond the end of its route", f"{do.end} m", f"≤ {length:.0f} m")


def lane_problems(do, network: Network, at: str) -> Iterator[Problem]:
    """Road, lane, and the length of it."""
    roads = {road.id for road in network.roads.values() if not road.internal}
    if do.road not in roads:
        yield Problem(f"{at}.road", "names no road of this map", repr(do.road), remedy=nearest(do.road, roads))
        return
    lanes = network.lanes_of(do.road)
    if do.lane >= len(lanes):
        yield Problem(f"{at}.lane", f"names no lane of road {do.road!r}", str(do.lane), f"0 to {len(lanes) - 1}")
        return
    length = np.floor(lanes[do.lane].length)
    if do.end > length:
        yield Problem(f"{at}.end", f"lies beyond the end of road {do.road!r}", f"{do.end} m", f"≤ {length:.0f} m")


def moment_problems(moment: Moment, scenario: Scenario, network: Network, at: str) -> Iterator[Problem]:
    """The vehicle must come by."""
    if moment.vehicle not in scenario.vehicles:
        return
    length = route_length(scenario.vehicles[moment.vehicle].route, scenario, network)
    if moment.along > length:
        yield Problem(f"{at}.along", f"lies beyond the end of the route of {moment.vehicle!r}", f"{moment.along} m", f"≤ {length:.0f} m")


def route_length(route: str, scenario: Scenario, network: Network) -> float:
    """Length of a route [m]; without an end when there is no such route or it does not connect, which is told elsewhere."""
    try:
        return road_path.path(network, connect(network, scenario.routes[route].roads)).length
    except (KeyError, RouteError):
        return inf
