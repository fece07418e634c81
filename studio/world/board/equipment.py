"""Equipment: the units of all worlds with their clocks, antennas, sensors and radio, before the first tick.

units_of(settings, worlds, cars, objects, tick)   →  Units
"""

from collections.abc import Iterator, Sequence
from itertools import product
from typing import Any

import numpy as np

from studio.application import port
from studio.application.port import INBOX, OUTBOX
from studio.kind import registry
from studio.kind.registry import Kind
from studio.road.ways.relief import road_height
from studio.scenario.schema import Application, Bus
from studio.world.board.air import air
from studio.world.board.post import Known, Need, Post, post, slots_of
from studio.world.board.sensing import Mounted, Sensor, mounted
from studio.world.car import Car
from studio.world.passes.sight import ROOM, SIGHT
from studio.world.setting import Setting
from studio.world.table.unit import (
    COSINE,
    GPS_SET,
    HEADING,
    OWN_X,
    OWN_Y,
    PRESENT,
    SATELLITE,
    SINE,
    SPEED_NOISE,
    TROUBLE,
    TRUE_X,
    TRUE_Y,
    TRUE_Z,
    UNIT,
    UNIT_SET,
)  # fmt: skip
from studio.world.world import Units, Worlds

STATIONS = 50_000  # stations are numbered from here on, as chance tells them apart


def units_of(settings: Sequence[Setting], worlds: Worlds, cars: Sequence[Car], objects: int, tick: float) -> Units:
    """All units, on roads with so many objects; nothing has been sensed or sent."""
    names = tuple((*each.scenario.vehicles, *each.scenario.stations) for each in settings)
    first = np.cumsum([0, *(len(each) for each in names)])[:-1]
    parts = [part for each in settings for part in (*each.scenario.vehicles.values(), *each.scenario.stations.values())]
    units = Units(
        names=names,
        first=first,
        vehicle=np.array([column for w, each in enumerate(settings) for column in columns(each, int(worlds.first[w]))], dtype=np.int64),
        world=np.repeat(np.arange(len(settings)), [len(each) for each in names]),
        entity=np.array([number for w, each in enumerate(settings) for number in entities(each, worlds, w)], dtype=np.int64),
        fixed=np.array([fixed_rows(each) for each in parts]).reshape(len(parts), -1).T.copy(),
        now=np.zeros((len(UNIT), len(parts))),
        gps_set=np.array([[getattr(car.gps, row.name) for row in GPS_SET] for car in cars]).T.copy(),
        satellite=np.zeros((len(SATELLITE), len(cars))),
        trouble=np.zeros((len(TROUBLE), len(parts))),
        airs=[],
        sight=np.zeros((len(SIGHT), len(cars) + objects + ROOM)),
        mounted=list(sensors_of(parts, tick)),
        posts=[],
    )
    stand(settings, units)
    return units


def fixed_rows(part: Any) -> list[float]:
    """Clock, antenna and bus of a vehicle or station; a station has no bus."""
    bus = getattr(part, "bus", Bus())
    return [part.clock.offset, part.clock.drift, part.antenna.height, *(getattr(bus, row.name) for row in UNIT_SET[SPEED_NOISE:])]


def columns(each: Setting, first: int) -> Iterator[int]:
    """The vehicles of its units, -1 for a station."""
    yield from (first + i for i in range(len(each.scenario.vehicles)))
    yield from (-1 for _ in each.scenario.stations)


def entities(each: Setting, worlds: Worlds, world: int) -> Iterator[int]:
    """How chance tells its units apart: vehicles as before, stations by the order of their names."""
    first = int(worlds.first[world])
    yield from (int(worlds.entity[first + i]) for i in range(len(each.scenario.vehicles)))
    order = sorted(each.scenario.stations)
    yield from (STATIONS + order.index(name) for name in each.scenario.stations)


def stand(settings: Sequence[Setting], units: Units) -> None:
    """Stations are where they are; they know it."""
    for w, each in enumerate(settings):
        for name, station in each.scenario.stations.items():
            u, (x, y) = units.number(name, w), each.spots[name]
            units.now[[TRUE_X, TRUE_Y, TRUE_Z, HEADING, PRESENT], u] = x, y, road_height(each.network, x, y), station.heading, 1.0
            units.now[[COSINE, SINE], u] = np.cos(station.heading), np.sin(station.heading)
            units.now[[OWN_X, OWN_Y], u] = x, y


def sensors_of(parts: Sequence, tick: float) -> Iterator[Mounted]:
    """All sensors, kind by kind."""
    found: dict[str, list[Sensor]] = {}
    for unit, part in enumerate(parts):
        for name, settings in part.sensors.items():
            found.setdefault(settings.kind, []).append(Sensor(unit, name, settings))
    for kind, sensors in found.items():
        yield mounted(registry.find("sensor", kind), sensors, tick)


# -- messages ------------------------------------------------------------------------------------------


def equip(settings: Sequence[Setting], units: Units, number: np.ndarray, tick: float) -> None:
    """Gives the units their posts: for every kind of message that an application sends or hears, on every kind of radio."""
    names = sorted({one.kind for each in settings for one in radios_in(each)})
    radios, known = [registry.find("radio", name) for name in names], Known(units.entity, number, units.world)
    for radio in radios:
        worlds = [w for w, each in enumerate(settings) if any(one.kind == radio.name for one in radios_in(each))]
        units.airs.append(air(radio, worlds, radios_of(settings, radio.name), units.entity.size))
    for (place, radio), kind in product(enumerate(radios), registry.known("message").values()):
        if any(is_wanted(each, kind, radio.name) for each in settings):
            units.posts.append(post(kind, radio, place, need_of(settings, units, kind, radio), known, tick))


def radios_in(each: Setting) -> list[Any]:
    """The radios of a world: the usual one, and those of some messages."""
    return [each.scenario.radio, *each.scenario.radios.values()]


def radios_of(settings: Sequence[Setting], radio: str) -> list[Any]:
    """The settings of a kind of radio in every world; in one that has none of it nobody asks for them."""
    found = [next((one for one in radios_in(each) if one.kind == radio), None) for each in settings]
    own = next(one for one in found if one is not None)
    return [one or own for one in found]


def is_wanted(each: Setting, kind: Kind, radio: str) -> bool:
    """Whether a kind of message goes over this radio in a world, and an application has a port for it; else nobody sends it."""
    goes = each.scenario.radio_of(kind.name).kind == radio
    modules = [module_of(group) for group in each.scenario.applications.values()] if goes else []
    ports = [one for module in modules for one in (*port.seen(module), *port.done(module))]
    return any(one.what in (INBOX, OUTBOX) and one.kind == kind.name for one in ports)


def need_of(settings: Sequence[Setting], units: Units, kind: Kind, radio: Kind) -> Need:
    """Who sends and who hears a kind of message, in the worlds with this radio."""
    senders: set[int] = set()
    pairs: list[tuple[int, int]] = []
    most, slots = 0, [0] * len(settings)
    for w, each in enumerate(settings):
        if not is_wanted(each, kind, radio.name):
            continue
        sending, at_once = senders_of(each, units, w, kind)
        senders |= sending
        most, slots[w] = max(most, at_once), slots_in(each, kind, radio, at_once)
        pairs += [(receiver, sender) for receiver, some in receivers_of(each, units, w, kind) for sender in (some or sending)
                  if sender in sending and sender != receiver]  # fmt: skip
    beacons = [getattr(each.scenario.messages, kind.name, None) for each in settings]
    return Need(sorted(senders), most, pairs, beacons, slots)


def slots_in(each: Setting, kind: Kind, radio: Kind, at_once: int) -> int:
    """How many messages of one sender may have to be kept in a world: beacons, and what applications send at every instant."""
    scenario, tick, has_beacon = each.scenario, each.scenario.clock.tick, hasattr(kind.module, "beacon")
    added = max((getattr(entry.do, "added_delay", 0.0) for entry in scenario.script.values()), default=0.0)
    longest = float(radio.module.longest(scenario.radio_of(kind.name))) + added
    cycle = min((group.cycle or tick for group in scenario.applications.values()), default=tick)
    shortest = cycle if at_once or not has_beacon else getattr(scenario.messages, kind.name).period
    return slots_of(longest, shortest, max(at_once + has_beacon, 1))


def senders_of(each: Setting, units: Units, world: int, kind: Kind) -> tuple[set[int], int]:
    """Who sends a kind of message in a world, and how many at once applications do."""
    everybody = {units.number(name, world) for name in units.names[world]} if hasattr(kind.module, "beacon") else set()
    most: dict[int, int] = {}
    for group in each.scenario.applications.values():
        for one in port.done(module_of(group)):
            if one.what == OUTBOX and one.kind == kind.name:
                for name in group.units:
                    most[units.number(name, world)] = most.get(units.number(name, world), 0) + one.most
    return everybody | set(most), max(most.values(), default=0)


def receivers_of(each: Setting, units: Units, world: int, kind: Kind) -> Iterator[tuple[int, list[int]]]:
    """Who hears a kind of message in a world, and whom; nobody named: everybody."""
    for group in each.scenario.applications.values():
        if any(one.what == INBOX and one.kind == kind.name for one in port.seen(module_of(group))):
            for i, name in enumerate(group.units):
                yield units.number(name, world), [units.number(sender, world) for sender in group.senders(i)]


def module_of(group: Application):
    """The module of a group's application."""
    return registry.find("application", group.application).module


def post_of(posts: Sequence[Post], kind: str, radio: str) -> Post:
    """The post of a kind of message on a kind of radio."""
    return next(each for each in posts if each.kind.name == kind and each.radio.name == radio)
