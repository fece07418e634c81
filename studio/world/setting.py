"""A scenario with everything resolved that names something: its map, and the path and start of every car.

setting(scenario)   →  Setting
"""

import os
import re
from collections.abc import Collection, Iterator
from dataclasses import dataclass, replace
from pathlib import Path as FilePath
from typing import Any

import numpy as np

from studio import road
from studio.errors import MapError, Problem, RouteError, ScenarioError, UnknownError, nearest
from studio.kind import registry
from studio.kind.driver import Driver
from studio.kind.settings import references
from studio.model.random import TRAFFIC_PLACE, TRAFFIC_ROUTE, TRAFFIC_STYLE, uniform
from studio.road.network import Network
from studio.road.network.index import once
from studio.road.ways import path as road_path
from studio.road.ways.path import PATH_HEADING, PATH_SPACING, PATH_SPEED, PATH_X, PATH_Y
from studio.road.ways.route import all_routes, connect
from studio.road.ways.strand import driven, strands_of
from studio.scenario import catalogue
from studio.scenario.catalogue import VehicleModel
from studio.scenario.schema import Gps, Intervention, Scenario
from studio.vehicle.command import RING
from studio.vehicle.fleet import check_step
from studio.world import crew
from studio.world.channel import catalogue as channels
from studio.world.cycle import circles
from studio.world.effect import Walk
from studio.world.exclusive import exclusive
from studio.world.footprint import Footprint, Overlap, depth, overlaps
from studio.world.site import Site, joins, place_problems, sites
from studio.world.spot import spots
from studio.world.thing import Thing, names, things
from studio.world.value import values
from studio.world.way import MOST_WORKS, Works

USUAL_RADIUS = 800.0  # [m] of a map file that no scenario or import cuts otherwise
CAR_LENGTH = 4.5  # [m] a car that starts nearer than this to works is about to be in them
FAR = 60.0  # [m] east plus north, beyond which no two bodies meet
BRAKING = 15.0  # [m] before a junction no traffic starts
TRIES = 200  # to place one traffic car
END_CLEARANCE = 60.0  # [m] no traffic starts this close to the end of its way
STYLE_SPREAD = 0.1  # traffic drivers want 90 % to 110 % of the usual speed
PAINTS = ("#9aa3ad", "#d9d9d4", "#3b4048", "#6f7f8f", "#b8b2a6", "#54606e")  # of traffic, in turn


@dataclass(frozen=True)
class Car:
    """A car before it is a column: its model, path, start and driver."""

    name: str
    model: VehicleModel
    path: road_path.Path
    station: float  # [m] of the centre of gravity
    speed: float  # [m/s]
    driver: Driver
    intervention: Intervention
    colour: str
    gps: Gps
    returns: bool = False


@dataclass(frozen=True)
class Setting:
    """A scenario with everything resolved that names something: its map, its cars, and its script in its place."""

    scenario: Scenario
    network: Network
    cars: tuple[Car, ...]
    sites: tuple[Site, ...]
    works: Works
    spots: dict[str, tuple[float, float]]  # [m] where the stations stand

    @property
    def names(self) -> tuple[str, ...]:
        """The vehicles, in the order of their columns."""
        return tuple(car.name for car in self.cars)

    @property
    def changes_roads(self) -> bool:
        """Whether something in the script is about the roads."""
        return any(site.laid or any(isinstance(each, Walk) for each in site.effects) for site in self.sites)


def setting(scenario: Scenario, folder: FilePath, where: str) -> Setting:
    """Resolves map, routes, models and starts; raises ScenarioError, MapError or RouteError."""
    network = place(scenario, folder, where)
    refuse(name_problems(scenario, where) + place_problems(scenario, network, where), where)
    models = models_of(scenario, folder, where)
    paths = paths_of(scenario, network, where)
    cars = [named_car(name, scenario, models, path, where) for name, path in paths.items()]
    found = sites(scenario, network)
    check_starts(cars, found, where)
    works = Works(found)
    check_works(cars, works, where)
    filled = tuple(cars + traffic(scenario, network, models, cars, works))
    return Setting(scenario, network, filled, found, works, spots(scenario, network, where))


def models_of(scenario: Scenario, folder: FilePath, where: str) -> dict[str, VehicleModel]:
    """The vehicles that are named, of the catalogue or from files beside the scenario; fit for its step and tick."""
    named = {f"vehicles.{name}.model": vehicle.model for name, vehicle in scenario.vehicles.items()}
    if scenario.traffic.count:
        named["traffic.model"] = scenario.traffic.model
    found: dict[str, VehicleModel] = {}
    for path, name in named.items():
        if name not in found:
            try:
                found[name] = catalogue.find_vehicle(name, folder=folder)
            except UnknownError as error:
                problem = Problem(f"{where}: {path}", "names no vehicle of the catalogue", repr(name), remedy=error.message)
                raise ScenarioError(f"{where} is not a valid scenario.", [problem]) from None
            check_step(found[name], scenario.clock.step, f"{where}: clock.step")
            check_delays(found[name], scenario.clock.tick, f"{where}: {path}")
    return found


def check_delays(model: VehicleModel, tick: float, where: str) -> None:
    """Dead times must fit into what is kept of past commands."""
    delays = {"engine.delay": model.values.engine.delay, "brakes.delay": model.values.brakes.delay}
    kept = (RING - 1) * tick
    found = [
        Problem(f"{where}: {name}", "is longer than commands are kept", f"{delay} s", f"≤ {kept:g} s")
        for name, delay in delays.items()
        if delay > kept
    ]
    if found:
        raise ScenarioError(f"{model.name} does not fit the clock.", found)


def place(scenario: Scenario, folder: FilePath, where: str) -> Network:
    """The map of a scenario."""
    file = folder / scenario.map.file
    if not os.path.exists(file):
        others = [path.name for path in file.parent.iterdir() if path.name[0] != "."] if file.parent.is_dir() else []
        raise MapError(
            f"The map of {where} is missing.",
            [Problem(f"{where}: map.file", "does not exist", scenario.map.file, remedy=nearest(file.name, others))],
        )
    usual = None if file.is_dir() else USUAL_RADIUS
    try:
        return road.load(file, radius=scenario.map.radius or usual, parking_aisles=scenario.map.parking_aisles)
    except MapError as error:
        if error.problems:
            raise
        problem = Problem(f"{where}: map.file", error.message, scenario.map.file, "a map file, or the folder of an import")
        raise MapError(f"The map of {where} cannot be used.", [problem]) from None


def check_names(scenario: Scenario, where: str) -> None:
    """All that can be checked without the map; raises ScenarioError."""
    refuse(name_problems(scenario, where), where)


def refuse(found: list[Problem], where: str) -> None:
    """Raises ScenarioError with all problems, if there is one."""
    if found:
        raise ScenarioError(f"{where} is not a valid scenario.", found)


def name_problems(scenario: Scenario, where: str) -> list[Problem]:
    """Every vehicle, route, entry, model and channel that is named must exist."""
    names = {
        "vehicle": (scenario.vehicles, "vehicle of this scenario"),
        "unit": ({**scenario.vehicles, **scenario.stations}, "unit of this scenario"),
        "route": (scenario.routes, "route of this scenario"),
        "entry": (scenario.script, "entry of the script"),
        "body": ({**scenario.vehicles, **brought(scenario)}, "vehicle of this scenario, nor an entry of the script that brings somebody"),
        "application": (scenario.applications, "group of applications"),
        "message": (registry.known("message"), "kind of message"),
        "value": (values(scenario), "value that is measured, logged or recorded here"),
    }
    found = [unknown(where, each.path, each.name, *names[each.what]) for each in references(scenario) if each.what in names]
    models = set(catalogue.vehicle_names())
    for path, model in models_named(scenario):
        found.append(unknown(where, path, model, models, "vehicle of the catalogue"))
    for i, name in enumerate(scenario.recording.channels):
        found.append(unknown(where, f"recording.channels.{i}", name, set(channels()), "channel"))
    more = (reserved, circles, exclusive, untimely, crew.problems)
    return [each for each in found if each] + [each for look in more for each in look(scenario, where)]


def brought(scenario: Scenario) -> dict[str, Any]:
    """The entries of the script that bring somebody who moves."""
    return {name: each for name, each in scenario.script.items() if hasattr(registry.find("action", each.do.kind).module, "MOVES")}


def unknown(where: str, path: str, name: str, known: Collection[str], kind: str) -> Problem | None:
    """What is wrong with a name."""
    return None if name in known else Problem(f"{where}: {path}", f"names no {kind}", repr(name), remedy=nearest(name, known))


def models_named(scenario: Scenario) -> Iterator[tuple[str, str]]:
    """Where models of the catalogue are named."""
    named = {f"vehicles.{name}.model": vehicle.model for name, vehicle in scenario.vehicles.items()}
    yield from ((path, model) for path, model in [*named.items(), ("traffic.model", scenario.traffic.model)] if not is_file(model))


def named_files(scenario: Scenario) -> dict[str, str]:
    """The files that a scenario names, by path: its map, and vehicles that are no names of the catalogue."""
    models = {f"vehicles.{name}.model": vehicle.model for name, vehicle in scenario.vehicles.items()}
    files = {path: model for path, model in (models | {"traffic.model": scenario.traffic.model}).items() if is_file(model)}
    return {"map.file": scenario.map.file} | files


def is_file(model: str) -> bool:
    """Whether a model is a vehicle file, and no name of the catalogue."""
    return catalogue.is_path(model, ".yaml", ".yml")


def reserved(scenario: Scenario, where: str) -> list[Problem]:
    """Names that the traffic has, or vehicle and station both, and a unit that listens to itself."""
    found = [
        Problem(f"{where}: vehicles.{name}", "is a name of the traffic", repr(name), remedy="choose another name")
        for name in scenario.vehicles
        if re.fullmatch(r"traffic_\d+", name)
    ]
    for group, application in scenario.applications.items():
        for i, unit in enumerate(application.units):
            if unit in application.senders(i):
                found.append(Problem(f"{where}: applications.{group}.listens_to.{i}", "is the unit itself", repr(unit)))
    both = [name for name in scenario.stations if name in scenario.vehicles]
    return found + [Problem(f"{where}: stations.{name}", "is the name of a vehicle", repr(name), remedy="choose another") for name in both]


def untimely(scenario: Scenario, where: str) -> list[Problem]:
    """Periods must be whole ticks; delays must fit into what is kept of the past; windows must begin within the run."""
    tick, found = scenario.clock.tick, []
    spans = {
        "clock.duration": scenario.clock.duration,
        "recording.period": scenario.recording.period,
    }
    spans |= {f"messages.{name}.period": part.period for name, part in scenario.messages if hasattr(part, "period")}
    for path, period in spans.items():
        ratio = period / tick
        if ratio < 1 - 1e-9 or abs(ratio - round(ratio)) > 1e-6:
            found.append(Problem(f"{where}: {path}", "is not a whole number of ticks", f"{period} s", f"n · {tick} s"))
    for name, measure in scenario.measures.items():
        begin = getattr(measure, "begin", None)
        if begin is not None and not begin.is_of_an_event and begin.at >= scenario.clock.duration:
            latest = f"< {scenario.clock.duration:g} s"
            found.append(Problem(f"{where}: measures.{name}.begin.at", "is after the end of the run", f"{begin.at:g} s", latest))
    for name, group in scenario.applications.items():
        parts = tick / (group.cycle or tick)
        if parts < 1 - 1e-9 or abs(parts - round(parts)) > 1e-6 * parts:
            found.append(
                Problem(f"{where}: applications.{name}.cycle", "is not a whole part of a tick", f"{group.cycle} s", f"{tick} s / n")
            )
    return found


def paths_of(scenario: Scenario, network: Network, where: str) -> dict[str, road_path.Path]:
    """The line of every named vehicle; those that start alike on the same route share one."""
    made: dict[tuple, road_path.Path] = {}
    found = {}
    for name, vehicle in scenario.vehicles.items():
        key = vehicle.route, vehicle.position.road, vehicle.position.lane
        if key not in made:
            made[key] = path_of(name, scenario, network, where)
        found[name] = made[key]
    return found


def path_of(name: str, scenario: Scenario, network: Network, where: str) -> road_path.Path:
    """The line that a named vehicle drives, with the speeds of its route."""
    vehicle = scenario.vehicles[name]
    route, start = scenario.routes[vehicle.route], vehicle.position.road
    roads, lane = route.roads, None
    if start is not None:
        roads, lane = from_road(name, start, route.roads, where), vehicle.position.lane
    try:
        path = road_path.path(network, connect(network, roads, start_lane=lane))
    except RouteError as error:
        field = f"vehicles.{name}.position" if lane is not None else f"routes.{vehicle.route}.roads"
        raise RouteError(
            f"{where} cannot be driven.",
            [Problem(f"{where}: {field}", error.message, remedy="; ".join(map(str, error.problems)))],
        ) from None
    joined = 0.0 if start is None else joins(start, route.roads, network)
    return annotated(path, route.speeds, joined)


def from_road(name: str, start: str, roads: list[str], where: str) -> list[str]:
    """The route from the road on which a vehicle starts."""
    if start not in roads:
        field = f"{where}: vehicles.{name}.position.road"
        raise ScenarioError(
            f"{where} is not a valid scenario.",
            [Problem(field, "is not a road of this route", repr(start), remedy=nearest(start, roads))],
        )
    return roads[roads.index(start) :]


def annotated(path: road_path.Path, speeds, joined: float) -> road_path.Path:
    """The path with the annotated speeds of its route, which it joins at a station; bends and limits still hold."""
    if not speeds:
        return path
    points = path.points.copy()
    stations = joined + np.arange(points.shape[1]) * PATH_SPACING
    wanted = np.full(points.shape[1], np.inf)
    for annotation in sorted(speeds, key=lambda each: each.at):
        wanted[stations >= annotation.at] = annotation.speed
    points[PATH_SPEED] = np.minimum(points[PATH_SPEED], wanted)
    return replace(path, points=points)


def named_car(name: str, scenario: Scenario, models: dict[str, VehicleModel], path: road_path.Path, where: str) -> Car:
    """A car of the scenario file; its start must lie on its path."""
    vehicle = scenario.vehicles[name]
    position = vehicle.position
    station = position.along if position.along is not None else position.offset
    last = path.length - 2 * END_CLEARANCE / 3
    if station > last:
        field = f"{where}: vehicles.{name}.position"
        raise ScenarioError(
            f"{where} is not a valid scenario.",
            [Problem(field, "lies beyond the end of its route", f"{station} m", f"≤ {last:.0f} m")],
        )
    return Car(name, models[vehicle.model], path, station, vehicle.speed, vehicle.driver, vehicle.intervention, vehicle.colour, vehicle.gps)


def check_works(cars: list[Car], works: Works, where: str) -> None:
    """No path may pass more works than are kept apart, no car start in one that is there from the beginning."""
    found = []
    for car in cars:
        way = works.way(car.path)
        if len(way.works) > MOST_WORKS:
            names = ", ".join(works.name(number) for number in way.works)
            what = f"passes {len(way.works)} closed or shifted lanes: {names}"
            found.append(Problem(f"{where}: vehicles.{car.name}.route", what, allowed=f"at most {MOST_WORKS}"))
        elif way.is_touched(car.station, CAR_LENGTH, works.first):
            what = "lies where a lane is closed or shifted from the beginning, or on the taper before it"
            remedy = "start elsewhere, or let it begin later"
            found.append(Problem(f"{where}: vehicles.{car.name}.position", what, f"{car.station} m", remedy=remedy))
    refuse(found, where)


# --- traffic -----------------------------------------------------------------------------------------------------------


def traffic(scenario: Scenario, network: Network, models: dict[str, VehicleModel], named: list[Car], works: Works) -> list[Car]:
    """Cars at random on the ways between the arms, none near another; as many as find a place, else ScenarioError."""
    wanted = scenario.traffic
    taken = [position(car.path, car.station) for car in named]
    bodies = [footprint(car.name, car.model, car.path, car.station) for car in named]
    cars: list[Car] = []
    for i in range(wanted.count):
        found = free_place(i, scenario, network, taken, bodies, models[wanted.model], works)
        if found is None:
            raise ScenarioError(
                "The traffic does not fit on the map.",
                [Problem("traffic.count", "is too many", str(wanted.count), f"about {i} with this spacing")],
            )
        path, station = found
        taken.append(position(path, station))
        bodies.append(footprint(f"traffic_{i + 1:02d}", models[wanted.model], path, station))
        style = 1.0 + STYLE_SPREAD * (2.0 * uniform(scenario.seed_of("traffic"), i, TRAFFIC_STYLE, 0) - 1.0)
        driver = wanted.driver.model_copy(update={"speed_factor": wanted.driver.speed_factor * style})
        speed = min(wanted.speed, float(path.points[PATH_SPEED, int(station)]))
        name = f"traffic_{i + 1:02d}"
        cars.append(
            Car(
                name,
                models[wanted.model],
                path,
                station,
                speed,
                driver,
                Intervention(),
                PAINTS[i % len(PAINTS)],
                Gps(drift=0.0, noise=0.0),
                returns=True,
            )
        )
    return cars


through_ways = once(all_routes)  # from every arm to every other
_paths: dict[tuple[str, int], road_path.Path] = {}


def through_path(network: Network, number: int) -> road_path.Path:
    """The path of one of these ways, made when it is needed, once."""
    if (network.digest, number) not in _paths:
        _paths[network.digest, number] = road_path.path(network, through_ways(network)[number])
    return _paths[network.digest, number]


def pose(path: road_path.Path, station: float) -> tuple[float, float, float]:
    """Position [m] and heading [rad] at a station of a path."""
    stations = np.arange(path.points.shape[1]) * PATH_SPACING
    x, y, heading = (np.interp(station, stations, path.points[row]) for row in (PATH_X, PATH_Y, PATH_HEADING))
    return float(x), float(y), float(heading)


def position(path: road_path.Path, station: float) -> tuple[float, float]:
    """Where a station of a path lies [m]."""
    return pose(path, station)[:2]


def footprint(name: str, model: VehicleModel, path: road_path.Path, station: float) -> Footprint:
    """The outline of a car whose centre of gravity is at a station of a path."""
    x, y, heading = pose(path, station)
    body = model.values.body
    ahead = body.front_distance + body.front_overhang - 0.5 * body.length
    return Footprint(name, x + ahead * np.cos(heading), y + ahead * np.sin(heading), heading, body.length, body.width)


def check_starts(cars: list[Car], found: tuple[Site, ...], where: str) -> None:
    """No named car may start in another, or in what stands on the road from the beginning: their outlines decide."""
    bodies = [Footprint(name, *thing_at(each)) for name, each in standing_first(found)]
    starting = {car.name: footprint(car.name, car.model, car.path, car.station) for car in cars}
    refuse([overlapping(each, starting, where) for each in overlaps([*bodies, *starting.values()]) if each.one.name in starting], where)


def standing_first(found: tuple[Site, ...]) -> Iterator[tuple[str, Thing]]:
    """The things that stand there from the beginning, with their names."""
    made = list(things(found))
    for name, each in zip(names(found, made), made, strict=True):
        if found[each.entry].is_there_from_the_start:
            yield name, each


def thing_at(each: Thing) -> tuple[float, float, float, float, float]:
    """Place, heading and size of a thing."""
    return each.x, each.y, each.heading, each.length, each.width


def overlapping(each: Overlap, starting: Collection[str], where: str) -> Problem:
    """What is wrong with two that share ground."""
    field = f"{where}: vehicles.{each.one.name}.position"
    who = repr(each.other.name) if each.other.name in starting else each.other.name
    gap, remedy = f"a gap of {-each.depth:.2f} m", f"place it at least {each.depth:.2f} m farther away"
    return Problem(field, f"starts where {who} starts, their outlines overlap", gap, "≥ 0 m", remedy)


def junctions(network: Network, way: road_path.Path) -> np.ndarray:
    """From where to where a path leads through junctions, float64[2, n] [m]."""
    lanes = strands_of(network).lanes
    return np.array([(each.enter, each.leave) for each in driven(network, way) if each.strand >= lanes]).reshape(-1, 2).T


def in_junction(network: Network, way: road_path.Path, station: float) -> bool:
    """Whether a car at a station [m] would start in a junction, or so near before it that it could not let others go first."""
    enter, leave = junctions(network, way)
    return bool(((station > enter - CAR_LENGTH - BRAKING) & (station < leave + CAR_LENGTH)).any())


def free_place(i: int, scenario: Scenario, network: Network, taken, bodies, model, works: Works) -> tuple[road_path.Path, float] | None:
    """A way and a station for traffic car i that keeps the spacing to all that is placed, and overlaps nobody."""
    count = len(through_ways(network))
    for attempt in range(TRIES if count else 0):
        way = through_path(network, int(uniform(scenario.seed_of("traffic"), i, TRAFFIC_ROUTE, attempt) * count))
        if way.length <= 2 * END_CLEARANCE or len(works.way(way).works) > MOST_WORKS:
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
