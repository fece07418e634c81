"""Crews: applications are put on their units, and their ports are connected.

hosts(settings, units, tick)   →  hosted applications, the lowest priority first, and the inboxes that hear everybody
"""

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from studio.application import port
from studio.application.port import OUTBOX, TARGETS, Port
from studio.kind import registry
from studio.kind.number import numbers
from studio.kind.quantity import first_values, width
from studio.kind.registry import Kind
from studio.scenario.schema import Application, Scenario
from studio.world.board import text
from studio.world.board.equipment import equip, post_of
from studio.world.board.host import Group, Hosted, Wiring, is_compiled
from studio.world.board.post import Open, Post
from studio.world.commander import number_of
from studio.world.setting import Setting
from studio.world.world import Units


class Crew(NamedTuple):
    """The units of an application group before they are hosted."""

    world: int
    place: int
    name: str
    group: Application
    units: tuple[int, ...]
    radios: tuple[tuple[str, str], ...]  # of every kind of message at a port of it
    cycles: int
    rank: int


def hosts(settings: Sequence[Setting], units: Units, tick: float) -> tuple[list[Hosted], list[Open]]:
    """Every application of all groups of all worlds; a compiled one is hosted once for all of the same priority and radio."""
    number = np.arange(units.vehicle.size) - units.first[units.world]
    equip(settings, units, number, tick)
    together: dict[tuple, list[Crew]] = {}
    for crew in crews(settings, units):
        own = -1 if is_compiled(registry.find("application", crew.group.application)) else crew.place
        together.setdefault((crew.group.priority, crew.group.application, crew.radios, crew.cycles, own), []).append(crew)
    opened: list[Open] = []
    ordered = sorted(together.items(), key=lambda each: each[0][0])
    return [hosted(registry.find("application", key[1]), found, units, opened) for key, found in ordered], opened


def crews(settings: Sequence[Setting], units: Units) -> Iterator[Crew]:
    """Every application group of every world."""
    place = 0
    for w, each in enumerate(settings):
        for name, group in each.scenario.applications.items():
            members = tuple(units.number(unit, w) for unit in group.units)
            often = cycles(group, each.scenario.clock.tick)
            yield Crew(w, place, name, group, members, radios(group, each.scenario), often, number_of(name, each.scenario))
            place += 1


def radios(group: Application, scenario: Scenario) -> tuple[tuple[str, str], ...]:
    """Over which kind of radio the messages at the ports of an application go."""
    module = registry.find("application", group.application).module
    kinds = sorted({one.kind for one in (*port.seen(module), *port.done(module)) if one.what in (port.INBOX, port.OUTBOX)})
    return tuple((kind, scenario.radio_of(kind).kind) for kind in kinds)


def cycles(group: Application, tick: float) -> int:
    """How often the units of a group decide within a tick."""
    return round(tick / group.cycle) if group.cycle else 1


def hosted(application: Kind, found: list[Crew], units: Units, opened: list[Open]) -> Hosted:
    """Some groups of one application on their host."""
    module = application.module
    unit = np.array([each for crew in found for each in crew.units], dtype=np.int64)
    ends = np.cumsum([len(crew.units) for crew in found]).tolist()
    logged = sum(width(each.type) for each in port.done(module) if each.what == port.LOG)
    return Hosted(
        application=application,
        groups=[Group(crew.world, crew.place, crew.name, slice(end - len(crew.units), end)) for crew, end in zip(found, ends, strict=True)],
        unit=unit,
        names=tuple(units.name_of(each) for each in unit),
        column=units.vehicle[unit],
        rank=np.repeat([float(crew.rank) for crew in found], [len(crew.units) for crew in found]),
        stopped=np.zeros(unit.size, dtype=np.int64),
        parameters=np.concatenate([parameters(application, crew) for crew in found], axis=1),
        memory=np.tile(np.array(first_values(module.Memory))[:, None], unit.size),
        said=np.zeros((logged, unit.size)),
        shown=np.zeros(unit.size),
        fault=np.zeros(unit.size, dtype=np.int64),
        wrong=np.zeros(unit.size),
        wiring=[wired(each, found, units, opened) for each in (*port.seen(module), *port.done(module)) if each.what in text.WIRES],
        run=text.loop(application),
        checked=text.checked(module),
        cycles=found[0].cycles,
    )


def parameters(application: Kind, crew: Crew) -> np.ndarray:
    """Parameters of all units of a group, [row, unit]."""
    values = numbers(application.module.Parameters.model_validate(crew.group.parameters))
    return np.tile(np.array(values, dtype=float)[:, None], len(crew.units))


def wired(one: Port, found: list[Crew], units: Units, opened: list[Open]) -> Wiring:
    """Connects a port of all units."""
    if one.what == TARGETS:
        return to_sensors(one, found, units)
    return to_radio(one, found, units) if one.what == OUTBOX else from_radio(one, found, units, opened)


def to_sensors(one: Port, found: list[Crew], units: Units) -> Wiring:
    """The sensor of every unit: that of the port's name, or the only one of its kind."""
    each = next(each for each in units.mounted if each.kind.name == one.kind)
    columns = [sensor_of(one.name, np.flatnonzero(each.unit == unit).tolist(), each.names) for crew in found for unit in crew.units]
    return Wiring(one, each, ("out", "health"), (np.array([columns], dtype=np.int64),))


def sensor_of(name: str, columns: list[int], names: Sequence[str]) -> int:
    """Of some sensors the one of a name, or the only one."""
    return next((column for column in columns if names[column] == name), columns[0])


def to_radio(one: Port, found: list[Crew], units: Units) -> Wiring:
    """The place of every unit among the senders."""
    post = post_of(units.posts, one.kind, dict(found[0].radios)[one.kind])
    senders = post.senders
    index = np.array([senders[unit] for crew in found for unit in crew.units], dtype=np.int64)
    return Wiring(one, post, ("ring", "last", "fresh"), (index,))


def from_radio(one: Port, found: list[Crew], units: Units, opened: list[Open]) -> Wiring:
    """The links of every unit: those of `listens_to` in its order, or the freshest of all."""
    post = post_of(units.posts, one.kind, dict(found[0].radios)[one.kind])
    links = post.links
    members = [(crew, i, unit) for crew in found for i, unit in enumerate(crew.units)]
    slots, heard = np.full((one.most, len(members)), -1, dtype=np.int64), np.zeros(len(members), dtype=np.int64)
    for j, (crew, i, unit) in enumerate(members):
        senders = crew.group.senders(i)
        named = [links.get((unit, units.number(sender, crew.world)), -1) for sender in senders]
        slots[: len(named), j], heard[j] = named, len(named)
    is_open = np.array([not crew.group.senders(i) for crew, i, _ in members])
    kept = np.array([crew.group.keeps or np.inf for crew, _, _ in members])
    if is_open.any():
        of = np.array([unit for _, _, unit in members])
        opened.append(to_all(post, is_open, of, units.vehicle.size, kept, heard, slots))
    return Wiring(one, post, ("inbox",), (slots, heard, kept))


def to_all(post: Post, is_open: np.ndarray, of: np.ndarray, units: int, kept: np.ndarray, heard: np.ndarray, slots: np.ndarray) -> Open:
    """The inboxes of members, which stand on units `of` so many, where some hear everybody."""
    order = np.argsort(of, kind="stable")
    member = order[is_open[order]]
    return Open(post, is_open, kept, heard, slots, np.zeros(slots.shape), np.searchsorted(of[member], np.arange(units + 1)), member)
