"""A route file of SUMO on the map of a scenario: its edges as roads, its types with drivers of ours, its departures as streams.

imported(scenario, network, path, where)   →  Imported

Our maps from OpenStreetMap have the edge ids of SUMO's netconvert. Where a street was cut into other pieces, those of the same mapped way
are taken for each other; an edge that is not on the map at all is left out, and the router joins what is left.
"""

import hashlib
from collections import Counter, defaultdict
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from studio.errors import Problem, RouteError, ScenarioError
from studio.kind.driver import Driver
from studio.road.network import Network
from studio.road.network.curve import LOCK
from studio.road.ways.route import connect
from studio.scenario import catalogue
from studio.scenario.schema import Scenario
from studio.scenario.traffic import CarType, Normal
from studio.world.demand.lock import Locks, known_locks
from studio.world.demand.routes_file import SETTING_OF, Departure, Vtype, read
from studio.world.demand.source import Stream
from studio.world.demand.style import range_of

CAR_MODELS = ("smart_fortwo", "electric_compact", "ford_escort", "bmw_320i", "suv")
THEIRS = {mine: theirs for theirs, mine in SETTING_OF.items()}
NO_WAY = "cars whose route does not lead over this map"
MOST_TOLD = 12  # kinds of what is not used


@dataclass(frozen=True)
class Imported:
    """What a route file gives: the scenario with its types, streams, what is told of it, and the digest of the file."""

    scenario: Scenario
    streams: tuple[Stream, ...]
    told: tuple[str, ...]
    digest: str


def imported(scenario: Scenario, network: Network, folder: Path, where: str) -> Imported:
    """The route file that a scenario names; raises ScenarioError when none of its cars can drive, or a driver cannot be."""
    named = scenario.traffic.routes
    if named is None:
        return Imported(scenario, (), (), "")
    path = folder / named
    plan = read(path, scenario.seed_of("traffic"), scenario.clock.duration, where)
    mine = scenario.traffic.types
    types = types_of({name: each for name, each in plan.types.items() if name not in mine}, scenario, where)
    traffic = scenario.traffic.model_copy(update={"types": types | mine})
    asked = scenario.model_copy(update={"traffic": traffic})
    streams, lost = streams_of(plan.departures, network, {*types, *mine}, known_locks(asked, folder))
    if not streams:
        reasons = "; ".join(f"{what}: {count}" for what, count in (lost + plan.unused).most_common(3)) or "nobody departs in it"
        problem = Problem(f"{where}: traffic.routes", "brings no car onto this map", named, remedy=reasons)
        raise ScenarioError(f"The route file of {where} cannot be used.", [problem])
    told = (*summary(streams, lost), *unused(plan.unused))
    digest = hashlib.sha256(path.read_bytes()).hexdigest()
    return Imported(asked, tuple(streams), told, digest)


# -- what is told ----------------------------------------------------------------------------------


def summary(streams: list[Stream], lost: Counter) -> Iterator[str]:
    """How many cars it brings, and what became of the others."""
    yield f"brings {sum(each.due.size for each in streams)} cars on {len({each.roads for each in streams})} routes"
    yield from (f"{what}: {count}" for what, count in sorted(lost.items()))


def unused(found: Counter) -> Iterator[str]:
    """What is not used, the most frequent first."""
    common = found.most_common()
    yield from (f"does not use {what}: {count}" for what, count in common[:MOST_TOLD])
    if rest := [what for what, _ in common[MOST_TOLD:]]:
        yield f"does not use, besides: {', '.join(rest)}"


# -- types -----------------------------------------------------------------------------------------


def types_of(found: dict[str, Vtype], scenario: Scenario, where: str) -> dict[str, CarType]:
    """The types of the file as types of ours; raises ScenarioError with all settings that are out of range."""
    usual = scenario.traffic.driver
    problems = [each for vtype in found.values() for each in type_problems(vtype, type(usual), where)]
    if problems:
        raise ScenarioError(f"The route file of {where} cannot be used.", problems)
    return {name: type_of(vtype, scenario) for name, vtype in found.items()}


def type_of(vtype: Vtype, scenario: Scenario) -> CarType:
    """One type: the drivers of the traffic with what the file says of them."""
    usual, factor = scenario.traffic.driver, vtype.speed_factor
    said = {*vtype.settings, *(["speed_factor"] if factor else [])}
    spread = {name: each for name, each in scenario.traffic.spread.items() if name not in said}
    if factor:
        spread |= {"speed_factor": within(factor, *range_of(type(usual), "speed_factor"))}
    driver = usual.model_copy(update=vtype.settings)
    return CarType.model_construct(model=model_of(vtype, scenario), dynamics=None, driver=driver, spread=spread)


def within(factor: Normal, low: float, high: float) -> Normal:
    """The part of a distribution that a setting allows."""
    least, most = (low if factor.least is None else factor.least), (high if factor.most is None else factor.most)
    return factor.model_copy(update={"least": max(least, low), "most": min(most, high)})


def model_of(vtype: Vtype, scenario: Scenario) -> str:
    """The model for a type: by its class, or the car of the catalogue that is about as long, or that of the traffic."""
    if vtype.model or vtype.length is None:
        return vtype.model or scenario.traffic.model
    length = vtype.length
    return min(CAR_MODELS, key=lambda name: abs(catalogue.find_vehicle(name).values.body.length - length))


def type_problems(vtype: Vtype, driver: type[Driver], where: str) -> Iterator[Problem]:
    """What is wrong with the drivers of a type."""
    said = vtype.settings | ({"speed_factor": vtype.speed_factor.mean} if vtype.speed_factor else {})
    for name, value in said.items():
        low, high = range_of(driver, name)
        if not low <= value <= high:
            what = f"vType {vtype.id!r}: {THEIRS.get(name, 'speedFactor')} is beyond what drivers have"
            remedy = f"or write a type {vtype.id} under traffic.types, which goes before that of the file"
            yield Problem(f"{where}: traffic.routes", what, f"{value:g}", f"{low:g} to {high:g}", remedy)


# -- streams ---------------------------------------------------------------------------------------


def streams_of(departures: list[Departure], network: Network, types: set[str], locks: Locks) -> tuple[list[Stream], Counter]:
    """The departures by what they have in common, in an order that does not hang on that of the file; and what became of others."""
    of_type = {each: locks.of_traffic(each if each in types else None) for each in {each.vtype for each in departures}}
    together: dict[tuple, list[float]] = defaultdict(list)
    lost: Counter = Counter()
    drivable = Drivable(network, lost)
    for each in departures:
        roads, lane = drivable.way(each.edges, each.lane, of_type[each.vtype])
        if roads:
            together[roads, each.vtype, lane].append(each.time)
    for vtype in {vtype for _, vtype, _ in together} - types:
        lost[f"type {vtype!r} is not in the file, as in the traffic" if vtype else "without a type, as in the traffic"] += 1
    ordered = sorted(together.items(), key=lambda item: (item[0][0], item[0][1], -1 if item[0][2] is None else item[0][2]))
    return [stream(roads, vtype, lane, due, types) for (roads, vtype, lane), due in ordered], lost


def stream(roads: tuple[str, ...], vtype: str, lane: int | None, due: list[float], types: set[str]) -> Stream:
    """Those who drive the same roads in cars of one type, from the same lane."""
    name = f"{vtype or 'routes'}: {' '.join(roads)}" + ("" if lane is None else f" from {lane}")
    return Stream(name, "traffic.routes", roads, np.sort(np.array(due)), vtype if vtype in types else None, lane)


class Drivable:
    """Routes in edges as roads of a map, each looked up once."""

    def __init__(self, network: Network, lost: Counter) -> None:
        self.network, self.lost = network, lost
        self.known: dict[tuple[tuple[str, ...], int | None, float], tuple[tuple[str, ...], int | None]] = {}
        self.pieces: dict[str, list[str]] = defaultdict(list)
        for road in network.roads.values():
            if not road.internal:
                for way in {road.id.partition("#")[0], *(f"{'-' * road.id.startswith('-')}{way}" for way in road.ways)}:
                    self.pieces[way].append(road.id)

    def way(self, edges: tuple[str, ...], lane: int | None, lock: float) -> tuple[tuple[str, ...], int | None]:
        """The roads of a route, none when a vehicle of a lock [1/m] cannot drive it here, and the lane that it may start on."""
        if not self.looked_up(edges, lane, lock)[0]:
            is_narrow = lock < LOCK and self.looked_up(edges, lane, LOCK)[0]
            self.lost["cars whose route has turns that are too narrow for them" if is_narrow else NO_WAY] += 1
        return self.looked_up(edges, lane, lock)

    def looked_up(self, edges: tuple[str, ...], lane: int | None, lock: float) -> tuple[tuple[str, ...], int | None]:
        """The same, each looked up once."""
        key = edges, lane, lock
        if key not in self.known:
            self.known[key] = self.found(edges, lane, lock)
        return self.known[key]

    def found(self, edges: tuple[str, ...], lane: int | None, lock: float) -> tuple[tuple[str, ...], int | None]:
        """The same, looked up."""
        roads = tuple(dict.fromkeys(self.on_map(edges)))
        if not roads:
            return (), None
        lanes = len(self.network.roads[roads[0]].lanes)
        for start in dict.fromkeys((lane if lane is not None and lane < lanes else None, None)):
            if self.leads_on(roads, start, lock):
                if start != lane:
                    self.lost["routes that do not begin on the lane that the file names"] += 1
                return roads, start
        return (), None

    def on_map(self, edges: tuple[str, ...]) -> Iterator[str]:
        """The roads for the edges that are on the map; those that are not are counted."""
        for edge in edges:
            road = self.road(edge)
            if road is None:
                self.lost["edges of routes that are not on this map, joined by the router"] += 1
            else:
                yield road

    def road(self, edge: str) -> str | None:
        """The road that an edge is: the same, or the piece of the same mapped way that begins last before it."""
        if edge in self.network.roads and not self.network.roads[edge].internal:
            return edge
        way, _, piece = edge.partition("#")
        number = int(piece) if piece.isdecimal() else 0
        before = [(numbered(each), each) for each in self.pieces.get(way, ()) if numbered(each) <= number]
        return max(before)[1] if before else min(self.pieces.get(way, ()), key=numbered, default=None)

    def leads_on(self, roads: tuple[str, ...], lane: int | None, lock: float) -> bool:
        """Whether there is a way through some roads for a vehicle of a lock [1/m]."""
        try:
            connect(self.network, roads, start_lane=lane, lock=lock)
        except RouteError:
            return False
        return True


def numbered(road: str) -> int:
    """The number of the piece that a road is of its way."""
    piece = road.partition("#")[2]
    return int(piece) if piece.isdecimal() else 0
