"""The script of a scenario in its place: what each entry does to the road, and where that lies.

place_problems(scenario, network, where, locks)   what is wrong with their places, all of it
sites(scenario, network, locks)                   →  Site, one for each entry of the script, in the order of the file
"""

import traceback
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, NamedTuple, get_args

import numpy as np

from studio.errors import Problem, RouteError, ScenarioError, nearest
from studio.kind import registry
from studio.kind.area import Area
from studio.kind.settings import StationOf, inner, marks, named, references
from studio.kind.stretch import LaneStretch, Stretch
from studio.road.assembly.alignment import SHARPEST
from studio.road.network import Lane, Network
from studio.road.ways import path as road_path
from studio.road.ways.detour import STEEPEST, Work, lane_line
from studio.road.ways.floor import GROUND, Tread, floors_at, followed
from studio.road.ways.path import PATH_SPACING, PATH_X, PATH_Y, Path
from studio.road.ways.relief import SPACING, height_at
from studio.road.ways.route import connect
from studio.scenario.schema import Entry, Scenario, moment_of
from studio.world.effect import Closing, Effect, OnRoad, Place, Row, Shift, Walk, length_problem, row_problem
from studio.world.refusal import deed_problems

Effects = dict[str, list[Effect]]  # by the name of the entry


@dataclass(frozen=True, eq=False)
class Laid:
    """An effect in its place: `line` is what its stations count along, `work` what a lane's closing or shift means there.

    `edges` are the sides of a closed lane (1 left, -1 right) on which another lane stays open beside it.
    """

    effect: OnRoad
    line: Path
    work: Work | None = None
    edges: tuple[int, ...] = ()
    tread: Tread = GROUND  # under the line where it acts


class Walked(NamedTuple):
    """Somebody who moves, and what there is under his line."""

    walk: Walk
    tread: Tread


@dataclass(frozen=True, eq=False)
class Site:
    """One entry of the script, all its effects, and where those on the road lie."""

    name: str
    entry: Entry
    effects: tuple[Effect, ...]
    laid: tuple[Laid, ...]
    walked: tuple[Walked, ...] = ()

    @property
    def is_momentary(self) -> bool:
        """Whether it is over as it begins."""
        return hasattr(registry.find("action", self.entry.do.kind).module, "MOMENTARY")

    @property
    def is_there_from_the_start(self) -> bool:
        """Whether it begins before anything has moved."""
        moment = moment_of(self.entry.when)
        return moment is not None and moment <= 0.0

    @cached_property
    def text(self) -> str:
        """What it does, in words."""
        kind = registry.find("action", self.entry.do.kind)
        return kind.module.told(self.entry.do) if hasattr(kind.module, "told") else kind.title

    @property
    def vehicles(self) -> tuple[str, ...]:
        """Those that it is about: the one that acts, else those that it waits for."""
        found = [each.name for part in (self.entry.do, self.entry.when) for each in references(part) if each.what in ("vehicle", "body")]
        return tuple(dict.fromkeys(found))

    @property
    def place(self) -> tuple[float, float] | None:
        """Where its first effect begins [m]; None when it has none."""
        if not self.laid:
            return None
        first = self.laid[0]
        at = min(int(first.effect.stretch.start / PATH_SPACING), first.line.points.shape[1] - 1)
        return float(first.line.points[PATH_X, at]), float(first.line.points[PATH_Y, at])


def sites(scenario: Scenario, network: Network, locks: Mapping[str, float]) -> tuple[Site, ...]:
    """Every entry in its place, on routes of vehicles of these locks [1/m]; the scenario has none of its `place_problems`."""
    place = Place(scenario, network, locks)
    effects = {name: list(effects_of(entry, place)) for name, entry in scenario.script.items()}
    closed = closings(effects)
    return tuple(site(name, scenario.script[name], found, place, closed) for name, found in effects.items())


def site(name: str, entry: Entry, effects: list[Effect], place: Place, closed: list[LaneStretch]) -> Site:
    """One entry in its place."""
    found = tuple(laid(each, place, closed) for each in effects if isinstance(each, OnRoad))
    walked = [Walked(each, followed(place.network, each.line, each.level, each.height)) for each in effects if isinstance(each, Walk)]
    return Site(name, entry, tuple(effects), found, tuple(walked))


def effects_of(entry: Entry, place: Place) -> list[Effect]:
    """What an entry does to the road."""
    module = registry.find("action", entry.do.kind).module
    return list(module.effects(entry.do, place)) if hasattr(module, "effects") else []


def laid(effect: OnRoad, place: Place, closed: list[LaneStretch]) -> Laid:
    """An effect in its place."""
    line = place.line(effect.stretch)
    made = laid_work(effect, line, place, closed) if isinstance(effect, Closing | Shift) else Laid(effect, line)
    return replace(made, tread=under(line, effect.stretch, place.network)) if isinstance(effect, Row | Closing) else made


def under(line: Path, stretch: Stretch | LaneStretch, network: Network) -> Tread:
    """What there is under a line along a stretch with its taper, at stations of the line."""
    first = max(stretch.start - (stretch.taper if isinstance(stretch, LaneStretch) else 0.0), 0.0)
    (x, y), grid = line.points[[PATH_X, PATH_Y]], np.arange(line.points.shape[1]) * PATH_SPACING
    stations = np.linspace(first, stretch.end, max(int((stretch.end - first) / SPACING), 1) + 1)
    places = np.column_stack([np.interp(stations, grid, x), np.interp(stations, grid, y)])
    tread = followed(network, places.tolist(), height=float(height_at(line, stations[0])))
    return tread._replace(station=tread.station + first)


def laid_work(effect: Closing | Shift, line: Path, place: Place, closed: list[LaneStretch]) -> Laid:
    """A closed or shifted lane, with what it means for those who come along."""
    stretch = effect.stretch
    lane = place.network.lanes_of(stretch.road)[stretch.lane]
    if isinstance(effect, Shift):
        return Laid(effect, line, Work(line, stretch.start, stretch.end, stretch.taper, lane.width, offset=effect.offset))
    target = open_lane(stretch, closed, place.network)
    work = Work(line, stretch.start, stretch.end, stretch.taper, lane.width)
    if target is not None:
        side = place.network.middle * np.sign(target.index - lane.index)
        work = Work(line, stretch.start, stretch.end, stretch.taper, lane.width, lane_line(place.network, target), side)
    return Laid(effect, line, work, open_sides(stretch, closed, place.network))


def open_lane(stretch: LaneStretch, closed: list[LaneStretch], network: Network) -> Lane | None:
    """The lane that a closed one leads onto: the nearest that is open, of two the one towards the middle of the road."""
    shut = {other.lane for other in closed if overlap(stretch, other)}
    usable = [lane for lane in network.lanes_of(stretch.road) if lane.open and lane.index not in shut]
    return min(usable, key=lambda lane: (abs(lane.index - stretch.lane), -lane.index), default=None)


def open_sides(stretch: LaneStretch, closed: list[LaneStretch], network: Network) -> tuple[int, ...]:
    """The sides of a closed lane on which the next lane is not closed as well."""
    shut = {other.lane for other in closed if overlap(stretch, other)}
    count = len(network.lanes_of(stretch.road))
    beside = [step for step in (1, -1) if 0 <= stretch.lane + step < count and stretch.lane + step not in shut]
    return tuple(int(network.middle) * step for step in beside)


def closings(effects: Effects) -> list[LaneStretch]:
    """All closed stretches of a script."""
    return [each.stretch for found in effects.values() for each in found if isinstance(each, Closing)]


def overlap(one: LaneStretch, other: LaneStretch) -> bool:
    """Whether two works share some of the road with their tapers."""
    return one.road == other.road and one.start - one.taper < other.end + other.taper and other.start - other.taper < one.end + one.taper


def joined_at(vehicle: str, scenario: Scenario, network: Network, lock: float) -> float:
    """Station [m] of its route at which the path of a vehicle of a lock [1/m] begins."""
    road = scenario.vehicles[vehicle].position.road
    if road is None:
        return 0.0
    return joins(road, scenario.routes[scenario.vehicles[vehicle].route].roads, network, lock)


def joins(start: str, roads: list[str], network: Network, lock: float) -> float:
    """Station [m] at which a route of a vehicle of a lock [1/m] from its first road comes to the road on which it starts."""
    whole = road_path.path(network, connect(network, roads, lock=lock), lock=lock)
    return next((station.s for station in whole.stations if station.road == start), 0.0)


# -- what may be wrong ---------------------------------------------------------------------------------


def place_problems(scenario: Scenario, network: Network, where: str, locks: Mapping[str, float]) -> list[Problem]:
    """Roads and lanes that do not exist, stretches and stations beyond what they lie on; on routes of vehicles of these locks [1/m]."""
    place, effects, found = Place(scenario, network, locks), {}, []
    for name, entry in scenario.script.items():
        effects[name], wrong = attempted(entry, place, f"{where}: script.{name}.do")
        found += wrong
    closed = closings(effects)
    for name, entry in scenario.script.items():
        at = f"{where}: script.{name}"
        for effect in [each for each in effects[name] if isinstance(each, OnRoad)]:
            found += effect_problems(effect, place, f"{at}.do") or work_problems(effect, closed, place, f"{at}.do")
        for path, part in conditions(entry, at):
            found += station_problems(part, place, path) + ground_problems(part, place, path)
        found += off_map_problems(entry.do, place, f"{at}.do")
        found += ground_problems(entry.do, place, f"{at}.do") + station_problems(entry.do, place, f"{at}.do")
        found += [each for effect in effects[name] for each in deed_problems(effect, scenario, f"{at}.do")]
        found += [each for effect in effects[name] if isinstance(effect, Walk) for each in level_problems(effect, network, f"{at}.do")]
    return found + list(overlap_problems(effects, place, where))


def attempted(entry: Entry, place: Place, at: str) -> tuple[list[Effect], list[Problem]]:
    """The effects of an entry, or what went wrong in its action."""
    try:
        found = effects_of(entry, place)
    except ScenarioError:
        raise
    except Exception:
        kind = registry.find("action", entry.do.kind)
        remedy = f"mend {kind.source}\n{traceback.format_exc()}"
        return [], [Problem(at, f"the effects of the action {kind.name!r} cannot be told", remedy=remedy)]
    strange = [each for each in found if not isinstance(each, Effect)]
    if strange:
        allowed = ", ".join(each.__name__ for each in get_args(Effect))
        return [], [Problem(at, "its action gives what is no effect", repr(strange[0]), allowed)]
    return found, []


def effect_problems(effect: OnRoad, place: Place, at: str) -> list[Problem]:
    """What is wrong with the place of an effect."""
    stretch = effect.stretch
    if getattr(stretch, "route", None) is not None and stretch.route not in place.scenario.routes:
        return []  # told where names are checked
    return length_problem(stretch, place, at) + (row_problem(effect, at) if isinstance(effect, Row) else [])


def work_problems(effect: OnRoad, closed: list[LaneStretch], place: Place, at: str) -> Iterator[Problem]:
    """The tapers must lie on the road, and be long enough for a car to go over."""
    if not isinstance(effect, Closing | Shift):
        return
    stretch = effect.stretch
    lane = place.network.lanes_of(stretch.road)[stretch.lane]
    room = min(stretch.start, np.floor(lane.length) - stretch.end)
    if stretch.taper > room:
        what = f"does not fit on road {stretch.road!r} before the start and behind the end"
        remedy = "close less of the road, or farther from its ends"
        yield Problem(f"{at}.taper", what, f"{stretch.taper} m", f"≤ {room:.0f} m", remedy)
    target = open_lane(stretch, closed, place.network) if isinstance(effect, Closing) else None
    width = abs(effect.offset) if isinstance(effect, Shift) else lane.width * abs(target.index - lane.index) if target else 0.0
    shortest = np.ceil(np.sqrt(STEEPEST * width / SHARPEST))
    if stretch.taper < shortest:
        yield Problem(f"{at}.taper", f"is too short to go over by {width:g} m", f"{stretch.taper} m", f"≥ {shortest:.0f} m")


def overlap_problems(effects: Effects, place: Place, where: str) -> Iterator[Problem]:
    """Works share a road only as one site: closings of several lanes with the same stretch."""
    works = [(name, each) for name, found in effects.items() for each in found if isinstance(each, Closing | Shift)]
    for i, (name, one) in enumerate(works):
        for other_name, other in works[:i]:
            if overlap(one.stretch, other.stretch) and not is_one_site(one, other):
                what = f"overlaps {other_name!r} on road {one.stretch.road!r}, tapers included"
                remedy = "keep their tapers apart, or close several lanes with the same start, end and taper"
                yield Problem(f"{where}: script.{name}.do", what, f"{one.stretch.start} to {one.stretch.end} m", remedy=remedy)


def is_one_site(one: Closing | Shift, other: Closing | Shift) -> bool:
    """Whether two works that overlap close two lanes of one stretch."""
    a, b = one.stretch, other.stretch
    same = (a.start, a.end, a.taper) == (b.start, b.end, b.taper)
    return same and isinstance(one, Closing) and isinstance(other, Closing) and a.lane != b.lane


def conditions(entry: Entry, at: str) -> Iterator[tuple[str, Any]]:
    """All conditions of an entry with their paths, those within others too."""
    waiting = [(f"{at}.{field}", part) for field in ("when", "until") if (part := getattr(entry, field)) is not None]
    while waiting:
        path, part = waiting.pop(0)
        yield path, part
        waiting += [(f"{path}.{name}", each) for name, each in inner(part)]


def ground_problems(part: Any, place: Place, at: str) -> list[Problem]:
    """Areas on lanes that do not exist, and lights where there are none."""
    found = []
    for name, field in type(part).model_fields.items():
        value = getattr(part, name)
        if isinstance(value, Area) and value.road is not None:
            found += area_problem(value, place, f"{at}.{name}")
        elif value is not None and named(field) == "signal" and value not in place.lit:
            found.append(Problem(f"{at}.{name}", "names no road of this map with lights", repr(value), remedy=nearest(value, place.lit)))
    return found


def level_problems(walk: Walk, network: Network, at: str) -> Iterator[Problem]:
    """A level that is told must be one of those at the beginning of the line."""
    known = sorted({round(each.level) for each in floors_at(network, *walk.line[0])})
    if walk.level is not None and walk.level not in known:
        what, remedy = "is no level of the roads where it begins", "leave it out, or begin elsewhere"
        yield Problem(f"{at}.level", what, str(walk.level), " or ".join(map(str, known)), remedy)


def off_map_problems(action: Any, place: Place, at: str) -> Iterator[Problem]:
    """Areas in which an action would do nothing; that a condition never holds in one is told as an event."""
    for name in type(action).model_fields:
        value = getattr(action, name)
        if isinstance(value, Area) and value.road is None and place.is_off_map(value):
            west, south, east, north = place.network.bounds
            allowed = f"east {west:.0f} to {east:.0f} m, north {south:.0f} to {north:.0f} m"
            yield Problem(f"{at}.{name}", "lies off the map", allowed=allowed)


def area_problem(area: Area, place: Place, at: str) -> list[Problem]:
    """Road, lane, and the length of it."""
    assert area.road is not None
    if area.road not in place.roads:
        return [Problem(f"{at}.road", "names no road of this map", repr(area.road), remedy=nearest(area.road, place.roads))]
    if area.lane >= place.lanes(area.road):
        return [Problem(f"{at}.lane", f"names no lane of road {area.road!r}", str(area.lane), f"0 to {place.lanes(area.road) - 1}")]
    length, last = float(np.floor(place.network.lanes_of(area.road)[area.lane].length)), area.end or area.start
    what = f"lies beyond the end of road {area.road!r}"
    field = "end" if area.end is not None else "start"
    return [Problem(f"{at}.{field}", what, f"{last} m", f"≤ {length:.0f} m")] if last > length else []


def station_problems(part, place: Place, at: str) -> list[Problem]:
    """A vehicle must come by the stations of its route."""
    return list(too_far(part, place, at))


def too_far(part, place: Place, at: str) -> Iterator[Problem]:
    """The stations of a condition that its vehicle never comes to."""
    for name, field in type(part).model_fields.items():
        for mark in marks(field, StationOf):
            vehicle, station = getattr(part, mark.field), getattr(part, name)
            length = route_length(vehicle, place)
            if station > length:
                what = f"lies beyond the end of the route of {vehicle!r}"
                yield Problem(f"{at}.{name}", what, f"{station} m", f"≤ {length:.0f} m")


def route_length(vehicle: str, place: Place) -> float:
    """Length of a vehicle's route [m]; without an end when there is none or it does not connect, which is told elsewhere."""
    try:
        return place.route(place.scenario.vehicles[vehicle].route).length
    except (KeyError, RouteError):
        return np.inf
