"""Population: the cars that fill a map. Some are about from the start and come in again when they have arrived, others flow through.

traffic(scenario, network, models, named, works, sources)   cars at random on the ways between the arms, then those of the flows
sources_of(scenario, network, where)                        where the cars of flows come in, and when

A flow has a source for every lane that it may start in; cars are due there in the order of time, and come in as soon as there is room.
A source has as many cars as would be about at three times the time that its way takes, and no more than will ever be due.
"""

from collections.abc import Iterator
from dataclasses import replace
from math import log
from typing import NamedTuple
from zlib import crc32

import numpy as np

from studio.errors import Problem, RouteError, ScenarioError
from studio.kind.driver import Driver
from studio.model.random import TRAFFIC_HEADWAY, TRAFFIC_MODEL, TRAFFIC_PLACE, TRAFFIC_ROUTE, TRAFFIC_STYLE, uniform
from studio.road.network import Network
from studio.road.network.index import once
from studio.road.ways.path import PATH_SPACING, PATH_SPEED, Path, annotated, path
from studio.road.ways.route import all_routes, connect
from studio.road.ways.strand import driven, strands_of
from studio.scenario.catalogue import VehicleModel
from studio.scenario.schema import Flow, Gps, Intervention, Scenario
from studio.world.car import Car, footprint, position
from studio.world.footprint import depth
from studio.world.way import MOST_WORKS, Works

CAR_LENGTH = 4.5  # [m] a car that starts nearer than this to works is about to be in them
FAR = 60.0  # [m] east plus north, beyond which no two bodies meet
BRAKING = 15.0  # [m] before a junction no traffic starts
TRIES = 200  # to place one traffic car
END_CLEARANCE = 60.0  # [m] no traffic starts this close to the end of its way
STYLE_SPREAD = 0.1  # traffic drivers want 90 % to 110 % of the usual speed
PAINTS = ("#9aa3ad", "#d9d9d4", "#3b4048", "#6f7f8f", "#b8b2a6", "#54606e")  # of traffic, in turn
SLOW = 3.0  # times as long as in free traffic a car may need, until cars of its flow run out
HOUR = 3600.0  # [s]

through_ways = once(all_routes)  # from every arm to every other
_paths: dict[tuple[str, int], Path] = {}


class Source(NamedTuple):
    """Where cars of a flow come in: the path that they take, and the times [s] at which they are due."""

    flow: str
    path: Path
    due: np.ndarray
    model: str | None  # None: as in the traffic


def through_path(network: Network, number: int) -> Path:
    """The path of one of the ways between the arms, made when it is needed, once."""
    if (network.digest, number) not in _paths:
        _paths[network.digest, number] = path(network, through_ways(network)[number])
    return _paths[network.digest, number]


def traffic(
    scenario: Scenario, network: Network, models: dict[str, VehicleModel], named: list[Car], works: Works, sources: list[Source]
) -> list[Car]:
    """All of it, numbered through: those that go round, then the flows'."""
    round_about = list(population(scenario, network, models, named, works))
    return round_about + list(flowing(scenario, models, sources, len(round_about)))


# -- who goes round --------------------------------------------------------------------------------


def population(scenario: Scenario, network: Network, models: dict[str, VehicleModel], named: list[Car], works: Works) -> Iterator[Car]:
    """Cars at random on the ways, none near another; those that find no place wait where a way begins. Raises ScenarioError."""
    taken = [position(car.path, car.station) for car in named]
    bodies = [footprint(car.name, car.model, car.path, car.station) for car in named]
    for i in range(scenario.traffic.count):
        model = models[model_of(i, scenario, None)]
        found = free_place(i, scenario, network, taken, bodies, model, works)
        way, station = found or (outside(i, scenario, network, works), 0.0)
        if found:
            taken.append(position(way, station))
            bodies.append(footprint(name_of(i), model, way, station))
        speed = min(scenario.traffic.speed, float(way.points[PATH_SPEED, int(station)]))
        yield replace(car(i, scenario, model, way, station, speed), returns=True, is_outside=found is None)


def outside(i: int, scenario: Scenario, network: Network, works: Works) -> Path:
    """The way of one for whom there is no room at the start; raises ScenarioError when no way can be driven."""
    count = len(through_ways(network))
    for attempt in range(TRIES if count else 0):
        way = through_path(network, int(uniform(scenario.seed_of("traffic"), i, TRAFFIC_ROUTE, attempt) * count))
        if is_long_enough(way, works):
            return way
    problem = Problem("traffic.count", "finds no way on the map", str(scenario.traffic.count), f"ways of more than {2 * END_CLEARANCE:g} m")
    raise ScenarioError("The traffic has nowhere to drive.", [problem])


def is_long_enough(way: Path, works: Works) -> bool:
    """Whether traffic drives a way."""
    return way.length > 2 * END_CLEARANCE and len(works.way(way).works) <= MOST_WORKS


def free_place(i: int, scenario: Scenario, network: Network, taken, bodies, model, works: Works) -> tuple[Path, float] | None:
    """A way and a station for traffic car i that keeps the spacing to all that is placed, and overlaps nobody."""
    count = len(through_ways(network))
    for attempt in range(TRIES if count else 0):
        way = through_path(network, int(uniform(scenario.seed_of("traffic"), i, TRAFFIC_ROUTE, attempt) * count))
        if not is_long_enough(way, works):
            continue
        station = uniform(scenario.seed_of("traffic"), i, TRAFFIC_PLACE, attempt) * (way.length - 2 * END_CLEARANCE) + 5.0
        x, y = position(way, station)
        near_light = any(0 <= stop - station < 15 for stop, _ in way.stop_lines)
        if near_light or not all((x - a) ** 2 + (y - b) ** 2 > scenario.traffic.spacing**2 for a, b in taken):
            continue
        if works.way(way).is_touched(station, CAR_LENGTH, works.first) or in_junction(network, way, station):
            continue
        own = footprint("", model, way, station)
        if all(depth(own, other) <= 0.0 for other in bodies if abs(other.x - own.x) + abs(other.y - own.y) < FAR):
            return way, station
    return None


def junctions(network: Network, way: Path) -> np.ndarray:
    """From where to where a path leads through junctions, float64[2, n] [m]."""
    lanes = strands_of(network).lanes
    return np.array([(each.enter, each.leave) for each in driven(network, way) if each.strand >= lanes]).reshape(-1, 2).T


def in_junction(network: Network, way: Path, station: float) -> bool:
    """Whether a car at a station [m] would start in a junction, or so near before it that it could not let others go first."""
    enter, leave = junctions(network, way)
    return bool(((station > enter - CAR_LENGTH - BRAKING) & (station < leave + CAR_LENGTH)).any())


# -- who flows through -----------------------------------------------------------------------------


def sources_of(scenario: Scenario, network: Network, where: str) -> list[Source]:
    """The sources of all flows, in the order of names; raises RouteError for a flow that cannot be driven."""
    return [each for name in sorted(scenario.traffic.flows) for each in sources_of_flow(name, scenario, network, where)]


def sources_of_flow(name: str, scenario: Scenario, network: Network, where: str) -> Iterator[Source]:
    """One for each lane, which share its cars in turn."""
    flow = scenario.traffic.flows[name]
    paths = list(paths_of(name, flow, scenario, network, where))
    due = departures(name, flow, scenario)
    for lane, way in enumerate(paths):
        yield Source(name, way, due[lane :: len(paths)], flow.model)


def paths_of(name: str, flow: Flow, scenario: Scenario, network: Network, where: str) -> Iterator[Path]:
    """Its paths, from the lane that it names or from every lane of its first road from which its route can be driven."""
    route = scenario.routes[flow.route]
    lanes = range(len(network.lanes_of(route.roads[0]))) if flow.lane is None and route.roads[0] in network.roads else [flow.lane]
    reasons = []
    for lane in lanes:
        try:
            yield annotated(path(network, connect(network, route.roads, start_lane=lane)), route.speeds, 0.0)
        except RouteError as error:
            reasons.append(error)
    if len(reasons) == len(lanes):
        field = f"{where}: traffic.flows.{name}." + ("route" if flow.lane is None else "lane")
        problem = Problem(field, reasons[0].message, flow.route, remedy="; ".join(map(str, reasons[0].problems)))
        raise RouteError(f"{where} cannot be driven.", [problem])


def departures(name: str, flow: Flow, scenario: Scenario) -> np.ndarray:
    """Times [s] at which its cars are due; those at random hang on the flow's name, and not on the other flows."""
    end, every = min(flow.end or np.inf, scenario.clock.duration), HOUR / flow.rate
    if flow.headways == "even":
        return np.arange(flow.begin + 0.5 * every, end, every)
    seed, who = scenario.seed_of("traffic"), crc32(name.encode())
    times, time = [], flow.begin
    while time < end:
        time -= every * log(1.0 - uniform(seed, who, TRAFFIC_HEADWAY, len(times)))
        times.append(time)
    return np.array(times[:-1])


def flowing(scenario: Scenario, models: dict[str, VehicleModel], sources: list[Source], first: int) -> Iterator[Car]:
    """The cars of all sources, which wait outside."""
    number = first
    for i, source in enumerate(sources):
        for _ in range(needed(source)):
            model = models[model_of(number, scenario, source.model)]
            yield replace(car(number, scenario, model, source.path, 0.0, 0.0), source=i, is_outside=True)
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


def model_of(i: int, scenario: Scenario, own: str | None) -> str:
    """The model of traffic car i: that of its flow, or of the mix by chance, or the one that all have."""
    mix = scenario.traffic.mix
    if own or not mix:
        return own or scenario.traffic.model
    share = np.cumsum([mix[name] for name in sorted(mix)])
    return sorted(mix)[int(np.searchsorted(share, uniform(scenario.seed_of("traffic"), i, TRAFFIC_MODEL, 0) * share[-1], side="right"))]


def car(i: int, scenario: Scenario, model: VehicleModel, way: Path, station: float, speed: float) -> Car:
    """Traffic car i."""
    driver = style(i, scenario)
    return Car(name_of(i), model, way, station, speed, driver, Intervention(), PAINTS[i % len(PAINTS)], Gps(drift=0.0, noise=0.0))


def style(i: int, scenario: Scenario) -> Driver:
    """The driver of traffic car i: a little faster or slower than usual."""
    usual = scenario.traffic.driver
    by = 1.0 + STYLE_SPREAD * (2.0 * uniform(scenario.seed_of("traffic"), i, TRAFFIC_STYLE, 0) - 1.0)
    return usual.model_copy(update={"speed_factor": usual.speed_factor * by})
