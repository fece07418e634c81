"""A scenario with everything resolved that names something: its map, and the path and start of every car.

setting(scenario)   →  Setting
"""

import os
import re
from collections.abc import Collection, Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path as FilePath
from typing import Any

from studio import road
from studio.errors import MapError, Problem, RouteError, ScenarioError, UnknownError, nearest
from studio.kind import registry
from studio.kind.settings import references
from studio.road.network import Network
from studio.road.network.curve import LOCK
from studio.road.ways import path as road_path
from studio.road.ways.route import connect
from studio.scenario import catalogue, figures
from studio.scenario.catalogue import VehicleModel
from studio.scenario.schema import Scenario
from studio.vehicle.command import RING
from studio.vehicle.fleet import check_step
from studio.world import crew
from studio.world.car import Car, footprint
from studio.world.channel import catalogue as channels
from studio.world.cycle import circles
from studio.world.demand.count import Counted, counted
from studio.world.demand.imported import imported
from studio.world.demand.lock import Locks, known_locks
from studio.world.demand.population import CAR_LENGTH, END_CLEARANCE, traffic
from studio.world.demand.source import Detour, Source, sources_of, streams
from studio.world.demand.style import type_problems
from studio.world.effect import Walk
from studio.world.exclusive import exclusive
from studio.world.footprint import Footprint, Overlap, overlaps
from studio.world.site import Site, joins, place_problems, sites
from studio.world.spot import spots
from studio.world.standoff import standoffs
from studio.world.thing import Thing, names, things
from studio.world.value import values
from studio.world.way import MOST_WORKS, Works

USUAL_RADIUS = 800.0  # [m] of a map file that no scenario or import cuts otherwise


@dataclass(frozen=True)
class Setting:
    """A scenario with everything resolved that names something: its map, its cars, and its script in its place."""

    scenario: Scenario
    network: Network
    cars: tuple[Car, ...]
    sites: tuple[Site, ...]
    works: Works
    spots: dict[str, tuple[float, float]]  # [m] where the stations stand
    sources: tuple[Source, ...] = ()  # where the cars of flows and matrices come in
    detours: tuple[Detour, ...] = ()  # what closed roads do to them
    imported: tuple[str, ...] = ()  # what is told of the route file
    routes_digest: str = ""  # of the route file
    counted: tuple[Counted, ...] = ()  # what counts at the road do to the demand

    @property
    def names(self) -> tuple[str, ...]:
        """The vehicles, in the order of their columns."""
        return tuple(car.name for car in self.cars)

    @cached_property
    def locks(self) -> dict[str, float]:
        """The sharpest curves [1/m] of those who drive each route."""
        routes = {vehicle.route for vehicle in self.scenario.vehicles.values()}
        return {route: min(self.lock_of(name) for name, each in self.scenario.vehicles.items() if each.route == route) for route in routes}

    def lock_of(self, vehicle: str) -> float:
        """The sharpest curve of a named vehicle [1/m]."""
        return min(LOCK, *(figures.lock(car.model.values) for car in self.cars if car.name == vehicle))

    @property
    def changes_roads(self) -> bool:
        """Whether something in the script is about the roads."""
        return any(site.laid or any(isinstance(each, Walk) for each in site.effects) for site in self.sites)


def setting(scenario: Scenario, folder: FilePath, where: str) -> Setting:
    """Resolves map, routes, models and starts; raises ScenarioError, MapError or RouteError."""
    network = place(scenario, folder, where)
    refuse(name_problems(scenario, where) + place_problems(scenario, network, where, known_locks(scenario, folder).of_routes()), where)
    asked = imported(scenario, network, folder, where)
    models = models_of(asked.scenario, folder, where)
    locks = Locks(scenario, models)
    paths = paths_of(scenario, network, locks, where)
    cars = [named_car(name, scenario, models, path, where) for name, path in paths.items()]
    found = sites(scenario, network, locks.of_routes())
    check_starts(cars, found, where)
    refuse([face_to_face(*pair, where) for pair in standoffs(cars, network)], where)
    works = Works(found)
    check_works(cars, works, where)
    locks = Locks(asked.scenario, models)
    demand, changed = counted([*streams(scenario), *asked.streams], scenario, network, where, locks)
    sources, detours = sources_of(demand, network, works, where, locks)
    filled = tuple(cars + traffic(asked.scenario, network, models, cars, works, sources))
    stations = spots(scenario, network, where)
    return Setting(scenario, network, filled, found, works, stations, sources, detours, asked.told, asked.digest, changed)


def models_of(scenario: Scenario, folder: FilePath, where: str) -> dict[str, VehicleModel]:
    """The vehicles that are named, of the catalogue or from files beside the scenario; fit for its step and tick."""
    is_used = scenario.traffic.is_there
    named = {path: name for path, name in models_named(scenario).items() if is_used or path.startswith("vehicles.")}
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
    for path, model in models_named(scenario).items():
        if not is_file(model):
            is_type = path.startswith("traffic.") and not path.startswith("traffic.types.")
            more = (models | set(scenario.traffic.types), ", nor a type of the traffic") if is_type else (models, "")
            found.append(unknown(where, path, model, more[0], f"vehicle of the catalogue{more[1]}"))
    for i, name in enumerate(scenario.recording.channels):
        found.append(unknown(where, f"recording.channels.{i}", name, set(channels()), "channel"))
    more = (reserved, circles, exclusive, untimely, type_problems, crew.problems)
    return [each for each in found if each] + [each for look in more for each in look(scenario, where)]


def brought(scenario: Scenario) -> dict[str, Any]:
    """The entries of the script that bring somebody who moves."""
    return {name: each for name, each in scenario.script.items() if hasattr(registry.find("action", each.do.kind).module, "MOVES")}


def unknown(where: str, path: str, name: str, known: Collection[str], kind: str) -> Problem | None:
    """What is wrong with a name."""
    return None if name in known else Problem(f"{where}: {path}", f"names no {kind}", repr(name), remedy=nearest(name, known))


def models_named(scenario: Scenario) -> dict[str, str]:
    """The models that a scenario names, by path."""
    traffic = scenario.traffic
    named = {f"vehicles.{name}.model": vehicle.model for name, vehicle in scenario.vehicles.items()}
    named |= {f"traffic.types.{name}.model": each.model for name, each in traffic.types.items()}
    return named | {f"traffic.{path}": name for path, name in traffic.named_models().items() if name not in traffic.types}


def named_files(scenario: Scenario) -> dict[str, str]:
    """The files that a scenario names, by path: its map, its routes, and vehicles that are no names of the catalogue."""
    routes = {"traffic.routes": scenario.traffic.routes} if scenario.traffic.routes else {}
    return {"map.file": scenario.map.file} | routes | {path: model for path, model in models_named(scenario).items() if is_file(model)}


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
    for part, known in (("flows", scenario.traffic.flows), ("matrices", scenario.traffic.matrices), ("counts", scenario.traffic.counts)):
        for name, each in known.items():
            if each.begin >= scenario.clock.duration:
                latest = f"< {scenario.clock.duration:g} s"
                found.append(Problem(f"{where}: traffic.{part}.{name}.begin", "is after the end of the run", f"{each.begin:g} s", latest))
    for name, group in scenario.applications.items():
        parts = tick / (group.cycle or tick)
        if parts < 1 - 1e-9 or abs(parts - round(parts)) > 1e-6 * parts:
            found.append(
                Problem(f"{where}: applications.{name}.cycle", "is not a whole part of a tick", f"{group.cycle} s", f"{tick} s / n")
            )
    return found


def paths_of(scenario: Scenario, network: Network, locks: Locks, where: str) -> dict[str, road_path.Path]:
    """The line of every named vehicle; those that start alike on the same route and turn as sharply share one."""
    made: dict[tuple, road_path.Path] = {}
    found = {}
    for name, vehicle in scenario.vehicles.items():
        lock = locks.of(vehicle.model)
        key = vehicle.route, vehicle.position.road, vehicle.position.lane, lock
        if key not in made:
            made[key] = path_of(name, scenario, network, lock, where)
        found[name] = made[key]
    return found


def path_of(name: str, scenario: Scenario, network: Network, lock: float, where: str) -> road_path.Path:
    """The line that a named vehicle drives, with the speeds of its route."""
    vehicle = scenario.vehicles[name]
    route, start = scenario.routes[vehicle.route], vehicle.position.road
    roads, lane = route.roads, None
    if start is not None:
        roads, lane = from_road(name, start, route.roads, where), vehicle.position.lane
    try:
        path = road_path.path(network, connect(network, roads, start_lane=lane, lock=lock), lock=lock)
    except RouteError as error:
        field = f"vehicles.{name}.position" if lane is not None else f"routes.{vehicle.route}.roads"
        raise RouteError(
            f"{where} cannot be driven.",
            [Problem(f"{where}: {field}", error.message, remedy="; ".join(map(str, error.problems)))],
        ) from None
    joined = 0.0 if start is None else joins(start, route.roads, network, lock)
    return road_path.annotated(path, route.speeds, joined)


def from_road(name: str, start: str, roads: list[str], where: str) -> list[str]:
    """The route from the road on which a vehicle starts."""
    if start not in roads:
        field = f"{where}: vehicles.{name}.position.road"
        raise ScenarioError(
            f"{where} is not a valid scenario.",
            [Problem(field, "is not a road of this route", repr(start), remedy=nearest(start, roads))],
        )
    return roads[roads.index(start) :]


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
    manned = vehicle.driver, vehicle.intervention, vehicle.colour, vehicle.gps
    own = Car(name, models[vehicle.model], path, station, vehicle.speed, *manned, is_light=vehicle.dynamics == "light")
    return replace(own, changes_lanes=vehicle.lane_changes)


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


def thing_at(each: Thing) -> tuple[float, float, float, float, float, float]:
    """Place, heading and size of a thing, and the height of what it stands on."""
    return each.x, each.y, each.heading, each.length, each.width, each.tread.at(0.0).height


def face_to_face(one: Car, other: Car, where: str) -> Problem:
    """What is wrong with two that start towards each other on ground that both directions share."""
    what = f"starts face to face with {other.name!r} on a street with one lane for both directions, where neither can pass"
    remedy = "let one of them start before that street, or behind the other"
    return Problem(f"{where}: vehicles.{one.name}.position", what, f"{one.station:g} m", remedy=remedy)


def overlapping(each: Overlap, starting: Collection[str], where: str) -> Problem:
    """What is wrong with two that share ground."""
    field = f"{where}: vehicles.{each.one.name}.position"
    who = repr(each.other.name) if each.other.name in starting else each.other.name
    gap, remedy = f"a gap of {-each.depth:.2f} m", f"place it at least {each.depth:.2f} m farther away"
    return Problem(field, f"starts where {who} starts, their outlines overlap", gap, "≥ 0 m", remedy)
