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
from studio.scenario.schema import Application, Bus
from studio.world.board.post import Need, Post, post
from studio.world.board.sensing import Mounted, Sensor, mounted
from studio.world.passes.sight import ROOM, SIGHT
from studio.world.setting import Car, Setting
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
    TRUE_X,
    TRUE_Y,
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
            units.now[[TRUE_X, TRUE_Y, HEADING, PRESENT], u] = x, y, station.heading, 1.0
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
    radios = list(dict.fromkeys(each.scenario.radio.kind for each in settings))
    for radio, kind in product(radios, registry.known("message").values()):
        if any(is_wanted(each, kind, radio) for each in settings):
            need = need_of(settings, units, kind, radio)
            units.posts.append(post(kind, registry.find("radio", radio), need, units.entity, number, units.world, tick))


def is_wanted(each: Setting, kind: Kind, radio: str) -> bool:
    """Whether a world has this radio, and an application with a port for a kind of message; else nobody sends it."""
    modules = [module_of(group) for group in each.scenario.applications.values()] if each.scenario.radio.kind == radio else []
    ports = [one for module in modules for one in (*port.seen(module), *port.done(module))]
    return any(one.what in (INBOX, OUTBOX) and one.kind == kind.name for one in ports)


def need_of(settings: Sequence[Setting], units: Units, kind: Kind, radio: str) -> Need:
    """Who sends and who hears a kind of message, in the worlds with this radio."""
    senders: set[int] = set()
    pairs: list[tuple[int, int]] = []
    most = 0
    for w, each in enumerate(settings):
        if not is_wanted(each, kind, radio):
            continue
        sending, at_once = senders_of(each, units, w, kind)
        senders |= sending
        most = max(most, at_once)
        pairs += [(receiver, sender) for receiver, some in receivers_of(each, units, w, kind) for sender in (some or sending)
                  if sender in sending and sender != receiver]  # fmt: skip
    beacons = [getattr(each.scenario.messages, kind.name, None) for each in settings]
    own = next(each.scenario.radio for each in settings if each.scenario.radio.kind == radio)
    airs = [each.scenario.radio if each.scenario.radio.kind == radio else own for each in settings]
    return Need(sorted(senders), most, pairs, beacons, airs)


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
