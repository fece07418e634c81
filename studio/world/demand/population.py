"""Population: the cars that fill a map. Some are about from the start and come in again when they have arrived, others flow through.

traffic(scenario, network, models, named, works, sources)   cars at random on the ways between the arms, then those of the sources

The cars of a source come in as soon as there is room when one is due. It has as many as would be about at three times the time that its way
takes, and no more than will ever be due.
"""

from collections import defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from studio.errors import Problem, ScenarioError
from studio.model.random import TRAFFIC_PLACE, TRAFFIC_ROUTE, uniform
from studio.road import kept
from studio.road.network import Network
from studio.road.network.curve import LOCK
from studio.road.network.index import once
from studio.road.ways.lane_path import LanePath
from studio.road.ways.path import PATH_SPACING, PATH_SPEED, Path, path
from studio.road.ways.route import all_routes
from studio.road.ways.strand import driven, strands_of
from studio.scenario.catalogue import VehicleModel
from studio.scenario.schema import Gps, Intervention, Scenario
from studio.scenario.traffic import MOST_CARS, Manned
from studio.world.car import Car, footprint, position
from studio.world.demand.lock import Locks
from studio.world.demand.source import Source
from studio.world.demand.style import Who, driver_of, kind_of, who_of
from studio.world.footprint import Footprint, depth
from studio.world.way import MOST_WORKS, Works

CAR_LENGTH = 4.5  # [m] a car that starts nearer than this to works is about to be in them
FAR = 60.0  # [m] east plus north, beyond which no two bodies meet
BRAKING = 15.0  # [m] before a junction no traffic starts
TRIES = 200  # to place one traffic car
END_CLEARANCE = 60.0  # [m] no traffic starts this close to the end of its way
PAINTS = ("#9aa3ad", "#d9d9d4", "#3b4048", "#6f7f8f", "#b8b2a6", "#54606e")  # of traffic, in turn
SLOW = 3.0  # times as long as in free traffic a car may need, until cars of its flow run out

_paths: dict[tuple[str, int, float], Path] = {}
_junctions: dict[tuple[str, int, float], np.ndarray] = {}
Models = dict[str, VehicleModel]


@once
def _ways(network: Network) -> dict[float, tuple[LanePath, ...]]:
    """Those that have been found, by their locks."""
    return {LOCK: all_routes(network)}


def through_ways(network: Network, lock: float) -> tuple[LanePath, ...]:
    """The ways from every arm to every other for vehicles of a lock [1/m]; those of trucks take long to find, and are kept on disk."""
    known = _ways(network)
    if lock not in known:
        known[lock] = kept.of_map(network.digest, "ways", tuple, lambda: all_routes(network, lock), lock, maker=__file__)
    return known[lock]


def through_path(network: Network, number: int, lock: float) -> Path:
    """The path of one of the ways between the arms, made when it is needed, once."""
    key = network.digest, number, lock
    if key not in _paths:
        _paths[key] = path(network, through_ways(network, lock)[number], lock=lock)
    return _paths[key]


def traffic(scenario: Scenario, network: Network, models: Models, named: list[Car], works: Works, sources: Sequence[Source]) -> list[Car]:
    """All of it, numbered through: those that go round, then the flows'."""
    round_about = list(population(scenario, network, models, named, works))
    return round_about + list(flowing(scenario, models, sources, len(round_about)))


# -- who goes round --------------------------------------------------------------------------------


def population(scenario: Scenario, network: Network, models: Models, named: list[Car], works: Works) -> Iterator[Car]:
    """Cars at random on the ways, none near another; those that find no place wait where a way begins. Raises ScenarioError."""
    taken, bodies, count = Cells(scenario.traffic.spacing), Cells(FAR), number_of(scenario, network)
    lock = Locks(scenario, models).of_traffic() if count else LOCK
    for each in named:
        take(taken, bodies, footprint(each.name, each.model, each.path, each.station), position(each.path, each.station))
    for i in range(count):
        of = kind_of(Who(i), scenario, None)
        model = models[of.model]
        found = free_place(i, scenario, network, taken, bodies, model, works, lock)
        way, station = found or (outside(i, scenario, network, works, lock), 0.0)
        if found:
            take(taken, bodies, footprint(name_of(i), model, way, station), position(way, station))
        speed = min(scenario.traffic.speed, float(way.points[PATH_SPEED, int(station)]))
        yield replace(car(i, Who(i), scenario, of, models, way, station, speed), returns=True, is_outside=found is None)


class Cells:
    """Things by the square that they lie in: whoever is nearer than its side lies there or beside it."""

    def __init__(self, side: float):
        self.side, self.lying = side, defaultdict(list)

    def put(self, x: float, y: float, thing: Any) -> None:
        """Lays a thing down at a place [m]."""
        self.lying[int(x // self.side), int(y // self.side)].append(thing)

    def near(self, x: float, y: float) -> Iterator[Any]:
        """What lies around a place [m]."""
        column, row = int(x // self.side), int(y // self.side)
        return (each for i in (-1, 0, 1) for j in (-1, 0, 1) for each in self.lying.get((column + i, row + j), ()))


def take(taken: Cells, bodies: Cells, body: Footprint, at: tuple[float, float]) -> None:
    """A car stands at a place [m] from now on."""
    taken.put(*at, at)
    bodies.put(body.x, body.y, body)


def number_of(scenario: Scenario, network: Network) -> int:
    """How many go round: as many as the scenario says, or as a density makes of all lanes for cars. Raises ScenarioError."""
    if scenario.traffic.density is None:
        return scenario.traffic.count
    kilometres = sum(lane.length for lane in network.lanes if lane.open and not lane.internal) / 1000.0
    count = round(scenario.traffic.density * kilometres)
    if not 1 <= count <= MOST_CARS:
        what = f"makes {count} cars of {kilometres:.2f} km of lanes"
        problem = Problem(
            "traffic.density", what, f"{scenario.traffic.density:g} /km", f"1 to {MOST_CARS} cars", "change it, or the map's radius"
        )
        raise ScenarioError("The traffic has no number of cars that can be.", [problem])
    return count


def outside(i: int, scenario: Scenario, network: Network, works: Works, lock: float) -> Path:
    """The way of one for whom there is no room at the start; raises ScenarioError when no way can be driven."""
    count = len(through_ways(network, lock))
    for attempt in range(TRIES if count else 0):
        way = through_path(network, int(uniform(scenario.seed_of("traffic"), i, TRAFFIC_ROUTE, attempt) * count), lock)
        if is_long_enough(way, works):
            return way
    problem = Problem("traffic.count", "finds no way on the map", str(scenario.traffic.count), f"ways of more than {2 * END_CLEARANCE:g} m")
    raise ScenarioError("The traffic has nowhere to drive.", [problem])


def is_long_enough(way: Path, works: Works) -> bool:
    """Whether traffic drives a way."""
    return way.length > 2 * END_CLEARANCE and len(works.way(way).works) <= MOST_WORKS


def free_place(
    i: int, scenario: Scenario, network: Network, taken: Cells, bodies: Cells, model, works: Works, lock: float
) -> tuple[Path, float] | None:
    """A way and a station for traffic car i that keeps the spacing to all that is placed, and overlaps nobody."""
    count = len(through_ways(network, lock))
    for attempt in range(TRIES if count else 0):
        number = int(uniform(scenario.seed_of("traffic"), i, TRAFFIC_ROUTE, attempt) * count)
        way = through_path(network, number, lock)
        if not is_long_enough(way, works):
            continue
        station = uniform(scenario.seed_of("traffic"), i, TRAFFIC_PLACE, attempt) * (way.length - 2 * END_CLEARANCE) + 5.0
        x, y = position(way, station)
        near_light = any(0 <= stop - station < 15 for stop, _ in way.stop_lines)
        if near_light or not all((x - a) ** 2 + (y - b) ** 2 > scenario.traffic.spacing**2 for a, b in taken.near(x, y)):
            continue
        if works.way(way).is_touched(station, CAR_LENGTH, works.first) or in_junction(junctions(network, number, lock), station):
            continue
        own = footprint("", model, way, station)
        if all(depth(own, other) <= 0.0 for other in bodies.near(own.x, own.y) if abs(other.x - own.x) + abs(other.y - own.y) < FAR):
            return way, station
    return None


def junctions(network: Network, number: int, lock: float) -> np.ndarray:
    """From where to where the path of one of the ways leads through junctions, or along streets of one lane for both directions, where two
    might begin face to face, float64[2, n] [m]; found when it is needed, once."""
    key = network.digest, number, lock
    if key not in _junctions:
        lanes, there = strands_of(network).lanes, driven(network, through_path(network, number, lock))
        found = [(each.enter, each.leave) for each in there if each.strand >= lanes or network.lanes[each.strand].facing >= 0]
        _junctions[key] = np.array(found).reshape(-1, 2).T
    return _junctions[key]


def in_junction(through: np.ndarray, station: float) -> bool:
    """Whether a car at a station [m] would start in one of these places, or so near before it that it could not let others go first."""
    enter, leave = through
    return bool(((station > enter - CAR_LENGTH - BRAKING) & (station < leave + CAR_LENGTH)).any())


# -- who flows through -----------------------------------------------------------------------------


def flowing(scenario: Scenario, models: Models, sources: Sequence[Source], first: int) -> Iterator[Car]:
    """The cars of all sources, which wait outside; raises ScenarioError when they would be too many at once."""
    number, needs = first, sum(map(needed, sources))
    if needs > MOST_CARS:
        problem = Problem("traffic", f"would have {needs} cars ready to be about at once", allowed=f"≤ {MOST_CARS}", remedy="ask for fewer")
        raise ScenarioError("The flows, matrices and routes bring too many cars.", [problem])
    for i, source in enumerate(sources):
        for turn in range(needed(source)):
            who = who_of(source.stream, turn)
            of = kind_of(who, scenario, source.model)
            yield replace(car(number, who, scenario, of, models, source.path, 0.0, 0.0), source=i, is_outside=True)
            number += 1


def needed(source: Source) -> int:
    """How many cars a source has: those that are due while one is under way for three times as long as in free traffic."""
    under_way = SLOW * float(np.sum(PATH_SPACING / np.maximum(source.path.points[PATH_SPEED], 1.0)))
    within = np.searchsorted(source.due, source.due + under_way) - np.arange(source.due.size)
    return int(within.max(initial=0))


# -- one car ---------------------------------------------------------------------------------------


def name_of(i: int) -> str:
    """The name of traffic car i."""
    return f"traffic_{i + 1:02d}"


def car(i: int, who: Who, scenario: Scenario, of: Manned, models: Models, way: Path, station: float, speed: float) -> Car:
    """Traffic car i."""
    driver, paint = driver_of(who, scenario, of), PAINTS[i % len(PAINTS)]
    place, gps = (way, station, speed), Gps(drift=0.0, noise=0.0)
    own = Car(name_of(i), models[of.model], *place, driver, Intervention(), paint, gps, is_light=of.dynamics == "light")
    return replace(own, changes_lanes=scenario.traffic.lane_changes)
