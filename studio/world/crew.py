"""Who may be on board together: what can be said about a scenario's applications before a world is built.

problems(scenario, where)   →  what does not fit: ports without a sensor, senders that are none, two that command the same
"""

from collections.abc import Iterator
from itertools import combinations

from studio.application import port
from studio.application.port import ACTUATORS, BITS, INBOX, OUTBOX, TARGETS
from studio.errors import Problem, UnknownError, nearest
from studio.kind import registry
from studio.kind.registry import Kind
from studio.scenario.schema import Application, Scenario

FULL_ONLY = ("steering_torque", "engine_torque")  # what no light vehicle can be commanded


def problems(scenario: Scenario, where: str) -> list[Problem]:
    """Everything about the applications of a scenario; those that do not exist have been told."""
    known = registry.known("application")
    groups = {name: (group, known[group.application]) for name, group in scenario.applications.items() if group.application in known}
    found = list(large(groups, scenario, where))
    found += [each for name, (group, kind) in groups.items() for each in unfit(name, group, kind, scenario, where)]
    return found + list(quarrels(groups, where)) + list(astray(scenario, where))


def astray(scenario: Scenario, where: str) -> Iterator[Problem]:
    """Radios of messages that there are not, and two of a kind that are set differently: they would be one air with two natures."""
    known = registry.known("message")
    for message, radio in scenario.radios.items():
        if message not in known:
            yield Problem(f"{where}: radios.{message}", "names no kind of message", repr(message), remedy=nearest(message, known))
        others = {"radio": scenario.radio} | {f"radios.{name}": each for name, each in scenario.radios.items() if name < message}
        for path, other in others.items():
            if other.kind == radio.kind and other != radio:
                what = f"is set differently from {path}, which is of the same kind and shares its air"
                yield Problem(f"{where}: radios.{message}", what, radio.kind, remedy="set both alike, or choose another kind")


def large(groups: dict[str, tuple[Application, Kind]], scenario: Scenario, where: str) -> Iterator[Problem]:
    """Messages that the radio does not take."""
    for name, (_, kind) in groups.items():
        for one in port.done(kind.module):
            found, radio = registry.known("message").get(one.kind) if one.what == OUTBOX else None, scenario.radio_of(one.kind)
            largest = registry.find("radio", radio.kind).module.largest(radio)
            if found and largest < found.module.SIZE:
                what = f"{kind.name!r} sends {one.kind!r}, which is larger than the radio {radio.kind!r} takes"
                yield Problem(f"{where}: applications.{name}.application", what, f"{found.module.SIZE} bytes", f"≤ {largest} bytes")


def unfit(name: str, group: Application, kind: Kind, scenario: Scenario, where: str) -> Iterator[Problem]:
    """What one application asks for and does not get."""
    for one in (*port.seen(kind.module), *port.done(kind.module)):
        if one.what in port.WITH_KIND:
            yield from unknown(one, kind, f"{where}: applications.{name}.application")
    for i, unit in enumerate(group.units):
        at = f"{where}: applications.{name}.units.{i}"
        if port.commanded(kind.module) and unit in scenario.stations:
            yield Problem(at, f"is a station, and {kind.name!r} commands a car", repr(unit), ", ".join(scenario.vehicles))
        yield from beyond_light(kind, unit, scenario, at)
        yield from blind(kind, unit, scenario, at)
        yield from namesake(name, kind, unit, scenario, f"{where}: applications.{name}")
        yield from silent(kind, group, i, scenario, f"{where}: applications.{name}.listens_to.{i}")


def beyond_light(kind: Kind, unit: str, scenario: Scenario, where: str) -> Iterator[Problem]:
    """What an application commands of a light vehicle that it has not."""
    light = unit in scenario.vehicles and scenario.vehicles[unit].dynamics == "light"
    lacks = [name for name in FULL_ONLY if port.commanded(kind.module) & BITS[name]]
    if light and lacks:
        what = f"is light, and {kind.name!r} commands its {' and '.join(lacks)}"
        yield Problem(where, what, repr(unit), remedy=f"write vehicles.{unit}.dynamics: full")


def unknown(one: port.Port, kind: Kind, where: str) -> Iterator[Problem]:
    """A port for a sensor or message that nobody has registered."""
    try:
        found = registry.find(port.WITH_KIND[one.what], one.kind)
    except UnknownError as error:
        yield Problem(where, f"{kind.name!r} has a port {one.name!r} that cannot be connected", one.kind, remedy=error.message)
        return
    capacity = getattr(found.module, "CAPACITY", 1)
    if one.what == TARGETS and one.most > capacity:
        what = f"{kind.name!r} has a port {one.name!r} for {one.most} targets"
        yield Problem(where, what, allowed=f"at most {capacity}, as many as {one.kind!r} gives")


def blind(kind: Kind, unit: str, scenario: Scenario, where: str) -> Iterator[Problem]:
    """A unit without the sensor that an application looks through."""
    part = scenario.vehicles.get(unit) or scenario.stations.get(unit)
    for one in port.seen(kind.module):
        if part and one.what == TARGETS:
            names = [name for name, sensor in part.sensors.items() if sensor.kind == one.kind]
            if not names:
                remedy = f"add it: sensors: {{{one.name}: {{kind: {one.kind}}}}}"
                yield Problem(
                    where, f"has no sensor of the kind {one.kind!r}, which {kind.name!r} looks through", repr(unit), remedy=remedy
                )
            elif len(names) > 1 and one.name not in names:
                what = f"has several sensors of the kind {one.kind!r}, none of them named {one.name!r} as the port of {kind.name!r} is"
                yield Problem(where, what, ", ".join(names), remedy=f"name one of them {one.name!r}")


def namesake(name: str, kind: Kind, unit: str, scenario: Scenario, where: str) -> Iterator[Problem]:
    """A group that is named like a sensor of its unit: what both give would be recorded under one name."""
    part = scenario.vehicles.get(unit) or scenario.stations.get(unit)
    tells = any(one.what in (port.LOG, port.NOTICE) for one in port.done(kind.module))
    if part and tells and name in part.sensors:
        yield Problem(where, f"is named like a sensor of {unit!r}, and {kind.name!r} has values to be recorded", name, remedy="rename one")


def silent(kind: Kind, group: Application, i: int, scenario: Scenario, where: str) -> Iterator[Problem]:
    """A sender that never sends what the unit listens for, and more senders than there is room for."""
    inboxes = [one for one in port.seen(kind.module) if one.what == INBOX]
    senders = group.senders(i)
    for one in inboxes:
        if len(senders) > one.most:
            yield Problem(where, f"names {len(senders)} units; the port {one.name!r} of {kind.name!r} has room for {one.most}")
    for sender in senders if inboxes else []:
        if not any(sends(scenario, sender, one.kind) for one in inboxes):
            kinds = ", ".join(repr(one.kind) for one in inboxes)
            others = [name for name in (*scenario.vehicles, *scenario.stations) if any(sends(scenario, name, one.kind) for one in inboxes)]
            yield Problem(where, f"never sends {kinds}, which {kind.name!r} listens for", repr(sender), remedy=nearest(sender, others))


def sends(scenario: Scenario, unit: str, message: str) -> bool:
    """Whether a unit sends a kind of message: by itself, or by one of its applications."""
    known = registry.known("application")
    if message in registry.known("message") and hasattr(registry.find("message", message).module, "beacon"):
        return True
    own = [known[group.application] for group in scenario.applications.values() if unit in group.units and group.application in known]
    return any(one.what == OUTBOX and one.kind == message for kind in own for one in port.done(kind.module))


def quarrels(groups: dict[str, tuple[Application, Kind]], where: str) -> Iterator[Problem]:
    """Two applications of equal priority that command the same actuator of the same unit, and one that is on a unit twice."""
    for name, (group, _) in groups.items():
        for unit in sorted({unit for unit in group.units if group.units.count(unit) > 1}):
            yield Problem(f"{where}: applications.{name}.units", "is named twice", repr(unit))
    for (first, (one, a)), (second, (other, b)) in combinations(groups.items(), 2):
        shared = [unit for unit in other.units if unit in one.units]
        both = port.commanded(a.module) & port.commanded(b.module)
        if shared and both and one.priority == other.priority:
            actuators = ", ".join(each.name for i, each in enumerate(ACTUATORS) if both >> i & 1)
            what = f"commands {actuators} of {shared[0]!r}, as {first!r} does, with the same priority"
            remedy = f"give one of them another priority; the higher one commands, {first!r} has {one.priority}"
            yield Problem(f"{where}: applications.{second}.priority", what, str(other.priority), remedy=remedy)
