"""Where the changes of a scenario lie: each stretch as a line on the map, each moment as a time or a place.

place_problems(scenario, network, where)   what is wrong with their places, all of it
sites(scenario, network)                   →  Site, one for each change, in the order of the file
"""

from collections.abc import Iterator
from dataclasses import dataclass
from math import inf

import numpy as np

from studio.errors import Problem, RouteError, nearest
from studio.road.assembly.alignment import SHARPEST
from studio.road.network import Lane, Network
from studio.road.ways import path as road_path
from studio.road.ways.detour import STEEPEST, Work, lane_line
from studio.road.ways.path import Path
from studio.road.ways.route import connect
from studio.scenario.schema import Change, CloseLane, LaneWork, Moment, Scenario, ShiftLane

WORDS = {
    "limit": "limit {0.speed:g} m/s",
    "friction": "friction {0.friction:g}",
    "close_lane": "lane {0.lane} of {0.road} closed",
    "shift_lane": "lane {0.lane} of {0.road} shifted by {0.offset:g} m",
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
    """One change in its place: `line` is what its stations count along, `work` what a lane's closing or shift means there.

    `edges` are the sides of a closed lane (1 left, -1 right) on which another lane stays open beside it.
    """

    name: str
    change: Change
    line: Path
    begins: Occasion
    ends: Occasion
    work: Work | None = None
    edges: tuple[int, ...] = ()

    @property
    def text(self) -> str:
        """What it does, in words."""
        return WORDS[self.change.do.change].format(self.change.do)


def sites(scenario: Scenario, network: Network) -> tuple[Site, ...]:
    """Every change in its place; the scenario has none of its `place_problems`."""
    return tuple(site(name, each, scenario, network) for name, each in scenario.changes.items())


def site(name: str, each: Change, scenario: Scenario, network: Network) -> Site:
    """One of them."""
    begins, ends = (occasion(moment, scenario, network) for moment in (each.start, each.end))
    if not isinstance(each.do, LaneWork):
        return Site(name, each, line_of(each.do, scenario, network), begins, ends)
    lane = network.lanes_of(each.do.road)[each.do.lane]
    line = lane_line(network, lane)
    if isinstance(each.do, ShiftLane):
        return Site(
            name, each, line, begins, ends, Work(line, each.do.start, each.do.end, each.do.taper, lane.width, offset=each.do.offset)
        )
    target = open_lane(each.do, scenario, network)
    work = Work(line, each.do.start, each.do.end, each.do.taper, lane.width)
    if target is not None:
        side = network.middle * np.sign(target.index - lane.index)
        work = Work(line, each.do.start, each.do.end, each.do.taper, lane.width, lane_line(network, target), side)
    return Site(name, each, line, begins, ends, work, open_sides(each.do, scenario, network))


def open_lane(do: CloseLane, scenario: Scenario, network: Network) -> Lane | None:
    """The lane that a closed one leads onto: the nearest that is open, of two the one towards the middle of the road."""
    closed = {other.lane for other in closings(scenario) if overlap(do, other)}
    usable = [lane for lane in network.lanes_of(do.road) if lane.open and lane.index not in closed]
    return min(usable, key=lambda lane: (abs(lane.index - do.lane), -lane.index), default=None)


def open_sides(do: CloseLane, scenario: Scenario, network: Network) -> tuple[int, ...]:
    """The sides of a closed lane on which the next lane is not closed as well."""
    closed = {other.lane for other in closings(scenario) if overlap(do, other)}
    beside = [step for step in (1, -1) if 0 <= do.lane + step < len(network.lanes_of(do.road)) and do.lane + step not in closed]
    return tuple(int(network.middle) * step for step in beside)


def closings(scenario: Scenario) -> list[CloseLane]:
    """All closings of a scenario."""
    return [each.do for each in scenario.changes.values() if isinstance(each.do, CloseLane)]


def overlap(one: LaneWork, other: LaneWork) -> bool:
    """Whether two works share some of the road with their tapers."""
    return one.road == other.road and one.start - one.taper < other.end + other.taper and other.start - other.taper < one.end + one.taper


def line_of(do, scenario: Scenario, network: Network) -> Path:
    """The line of a stretch."""
    if do.road is not None:
        return lane_line(network, network.lanes_of(do.road)[do.lane])
    return road_path.path(network, connect(network, scenario.routes[do.route].roads))


def occasion(moment: Moment, scenario: Scenario, network: Network) -> Occasion:
    """A moment, its station counted on the path that the vehicle drives, which may begin later than its route."""
    if moment.time is not None:
        return Occasion(time=moment.time)
    assert moment.vehicle is not None and moment.along is not None  # a moment has these or a time
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
        known = list(stretch_problems(each.do, scenario, network, f"{at}.do"))
        found += known
        if isinstance(each.do, LaneWork) and not known:
            found += taper_problems(each.do, scenario, network, f"{at}.do")
        for field, moment in (("start", each.start), ("end", each.end)):
            found += moment_problems(moment, scenario, network, f"{at}.{field}")
    return found + list(overlap_problems(scenario, where))


def stretch_problems(do, scenario: Scenario, network: Network, at: str) -> Iterator[Problem]:
    """A stretch must lie on a route of the scenario or a lane of the map."""
    if isinstance(do, LaneWork) or do.road is not None:
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


def taper_problems(do: LaneWork, scenario: Scenario, network: Network, at: str) -> Iterator[Problem]:
    """The tapers must lie on the road, and be long enough for a car to go over."""
    lane = network.lanes_of(do.road)[do.lane]
    room = min(do.start, np.floor(lane.length) - do.end)
    if do.taper > room:
        remedy = "close less of the road, or farther from its ends"
        yield Problem(
            f"{at}.taper",
            f"does not fit on road {do.road!r} before the start and behind the end",
            f"{do.taper} m",
            f"≤ {room:.0f} m",
            remedy,
        )
    target = open_lane(do, scenario, network) if isinstance(do, CloseLane) else None
    width = abs(do.offset) if isinstance(do, ShiftLane) else lane.width * abs(target.index - lane.index) if target else 0.0
    shortest = np.ceil(np.sqrt(STEEPEST * width / SHARPEST))
    if do.taper < shortest:
        yield Problem(f"{at}.taper", f"is too short to go over by {width:g} m", f"{do.taper} m", f"≥ {shortest:.0f} m")


def overlap_problems(scenario: Scenario, where: str) -> Iterator[Problem]:
    """Works share a road only as one site: closings of several lanes with the same stretch."""
    works = {name: each.do for name, each in scenario.changes.items() if isinstance(each.do, LaneWork)}
    for i, (name, one) in enumerate(works.items()):
        for other_name, other in list(works.items())[:i]:
            if overlap(one, other) and not is_one_site(one, other):
                what = f"overlaps {other_name!r} on road {one.road!r}, tapers included"
                remedy = "keep their tapers apart, or close several lanes with the same start, end and taper"
                yield Problem(f"{where}: changes.{name}.do", what, f"{one.start} to {one.end} m", remedy=remedy)


def is_one_site(one: LaneWork, other: LaneWork) -> bool:
    """Whether two works that overlap close two lanes of one stretch."""
    same = (one.start, one.end, one.taper) == (other.start, other.end, other.taper)
    return same and isinstance(one, CloseLane) and isinstance(other, CloseLane) and one.lane != other.lane


def moment_problems(moment: Moment, scenario: Scenario, network: Network, at: str) -> Iterator[Problem]:
    """The vehicle must come by."""
    if moment.vehicle not in scenario.vehicles or moment.along is None:
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
