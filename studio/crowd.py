"""Crowds: scenarios with any number of cars, whose cost is measured.

motorway_crowd(count)          platoons on a motorway that is as long as their number asks, so that the density is always the same
traffic_crowd(count, dynamics) traffic that goes round on a motorway, at the same density whatever its number
town_crowd(map, count)         cars on ways of their own through a town
"""

import tempfile
from collections.abc import Callable, Iterator
from math import hypot
from pathlib import Path
from typing import Any, NamedTuple

from studio.errors import MapError, Problem
from studio.road import load
from studio.road.drawn.motorway import motorway
from studio.road.network import Network
from studio.road.ways.path import path
from studio.road.ways.route import all_routes
from studio.scenario import setup
from studio.world.car import position
from studio.world.setting import USUAL_RADIUS, Setting, setting

PLATOON, GAP, EVERY = 5, 25.0, 200.0  # cars of a platoon, [m] from one to the next, [m] from platoon to platoon
LANES, MARGIN = 3, 1000.0  # of each direction; [m] of road before the last car and ahead of the first
ROADS = {"eastbound": "motorway", "westbound": "-motorway"}
FOUR_SENSORS = {
    "front": {"kind": "front_radar", "preset": "long_range_radar"},
    "left": {"kind": "blind_spot", "preset": "left"},
    "lane": {"kind": "lane_markings", "preset": "camera"},
    "place": {"kind": "satellite_receiver", "preset": "gnss"},
}
DENSITY = 30.0  # cars of the traffic per kilometre of a direction, which all keep to one of its lanes
SHORTEST, LONGEST = 300.0, 1500.0  # [m] ways through a town that are taken
APART, BEGIN, END = 20.0, 20.0, 130.0  # [m] from car to car at least; from the ends of a way
STRIDE, PLACES = 911, 97  # primes: ways and places along them are gone through in leaps, so that they lie all over the town
TOWN_SPEED = 5.0  # [m/s] at the start


def motorway_crowd(count: int, equipment: Callable[[dict[str, Any]], dict[str, Any]] = lambda document: document) -> Setting:
    """`count` cars in platoons on all lanes of both directions of a motorway, everything on in each of them."""
    rows = -(-count // (PLATOON * 2 * LANES))
    with tempfile.TemporaryDirectory() as folder:
        road = motorway(length=2.0 * MARGIN + rows * EVERY, lanes=LANES)
        (Path(folder) / "motorway.xodr").write_text(road, encoding="utf-8")
        return setting(setup.complete(equipment(crowd_document(count)), "the crowd"), Path(folder), "the crowd")


def crowd_document(count: int) -> dict[str, Any]:
    """Its scenario: the first car of every platoon leads, the others follow it with CACC; one brakes at times."""
    names = [f"car_{i}" for i in range(count)]
    platoons = [names[i : i + PLATOON] for i in range(0, count, PLATOON)]
    return {
        "title": f"{count} cars in platoons",
        "map": {"file": "motorway.xodr"},
        "clock": {"duration": 60},
        "routes": {name: {"roads": [road], "speeds": [{"at": 0, "speed": 30}]} for name, road in ROADS.items()},
        "vehicles": {name: crowd_vehicle(i) for i, name in enumerate(names)},
        "applications": {
            f"platoon_{k}": {"application": "cacc", "units": members[1:], "listens_to": members[:-1]}
            for k, members in enumerate(platoons)
            if len(members) > 1
        },
        "script": {"brake": {"when": {"kind": "time", "at": 1}, "do": {"kind": "brake", "vehicle": names[0], "deceleration": 2}}},
    }


def crowd_vehicle(i: int) -> dict[str, Any]:
    """Car i: its platoon's place on the motorway, and its own within the platoon."""
    platoon, place = divmod(i, PLATOON)
    row, lane = divmod(platoon, 2 * LANES)
    route, road = list(ROADS.items())[lane // LANES]
    offset = MARGIN + EVERY * (row + lane / (2 * LANES)) - place * GAP
    return {"route": route, "position": {"road": road, "lane": lane % LANES, "offset": offset}, "speed": 30}


def equipped(document: dict[str, Any]) -> dict[str, Any]:
    """A crowd with four sensors on every car and a real radio, over which all hear all."""
    vehicles = {name: each | {"sensors": FOUR_SENSORS} for name, each in document["vehicles"].items()}
    groups = {name: {key: part for key, part in each.items() if key != "listens_to"} for name, each in document["applications"].items()}
    return document | {"vehicles": vehicles, "applications": groups, "radio": {"kind": "wlan", "preset": "motorway"}}


def traffic_crowd(count: int, dynamics: str) -> Setting:
    """`count` cars, all but one of them traffic, with full or light dynamics."""
    length = max(count / (2.0 * DENSITY) * 1000.0, 2.0 * MARGIN)
    vehicle = {"route": "eastbound", "position": {"along": MARGIN}, "speed": 25, "dynamics": dynamics}
    document = {
        "title": f"{count} cars with {dynamics} dynamics",
        "map": {"file": "motorway.xodr"},
        "clock": {"duration": 60},
        "routes": {"eastbound": {"roads": [ROADS["eastbound"]]}},
        "vehicles": {"car": vehicle},
        "traffic": {"count": count - 1, "dynamics": dynamics, "speed": 25, "spacing": 15},
    }
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "motorway.xodr").write_text(motorway(length=length, lanes=LANES), encoding="utf-8")
        return setting(setup.complete(document, "the traffic"), Path(folder), "the traffic")


# -- in a town -----------------------------------------------------------------------------------------


class Start(NamedTuple):
    """Where a car begins: the roads of its way, and the station on it [m]."""

    roads: tuple[str, ...]
    along: float


def town_crowd(map_file: Path, count: int) -> Setting:
    """`count` cars with four sensors each and a real radio, over which all hear all, on the map of a town; raises MapError."""
    starts = list(starts_in(load(map_file, radius=USUAL_RADIUS), count, map_file))
    return setting(setup.complete(town_document(map_file.name, starts), "the town"), map_file.parent, "the town")


def starts_in(network: Network, count: int, map_file: Path) -> Iterator[Start]:
    """So many places on ways through a town, none near another."""
    ways, taken, lines = all_routes(network), [], {}
    for k in range(PLACES * len(ways)):
        if len(taken) == count:
            return
        number = k * STRIDE % len(ways)
        line = lines[number] = lines.get(number) or path(network, ways[number])
        along = BEGIN + k % PLACES / PLACES * (line.length - BEGIN - END)
        if SHORTEST <= line.length <= LONGEST and is_free(*position(line, along), taken):
            taken.append(position(line, along))
            yield Start(ways[number].roads(network), along)
    raise MapError("The town is too small.", [Problem(str(map_file), "has no room for so many cars", str(count), f"about {len(taken)}")])


def is_free(x: float, y: float, taken: list[tuple[float, float]]) -> bool:
    """Whether nobody is near a place [m]."""
    return all(hypot(x - u, y - v) >= APART for u, v in taken)


def town_document(map_name: str, starts: list[Start]) -> dict[str, Any]:
    """Its scenario."""
    names = [f"car_{i}" for i in range(len(starts))]
    return {
        "title": f"{len(starts)} cars in a town",
        "map": {"file": map_name},
        "clock": {"duration": 60},
        "routes": {name: {"roads": list(start.roads)} for name, start in zip(names, starts, strict=True)},
        "vehicles": {name: town_vehicle(name, start.along) for name, start in zip(names, starts, strict=True)},
        "applications": {"all": {"application": "awareness", "units": names}},
        "radio": {"kind": "wlan", "preset": "urban"},
    }


def town_vehicle(name: str, along: float) -> dict[str, Any]:
    """One car at its place."""
    return {"route": name, "position": {"along": along}, "speed": TOWN_SPEED, "sensors": FOUR_SENSORS}
