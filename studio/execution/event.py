"""Events: what compiled code has noticed, with names and in words.

watched(settings, world)     →  Watch              what is looked out for
Teller(settings, world)      .tell(watch)          →  (world, Happening), in the order in which things happened
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import isnan

import numpy as np

from studio.execution.happening import Happening, happening
from studio.execution.record import Chain
from studio.kind import registry
from studio.scenario.figures import top_speed
from studio.scenario.schema import REASONS, Scenario
from studio.world.commander import PARTS, commanders, standing
from studio.world.effect import Place
from studio.world.passes import notice
from studio.world.passes.notice import NUMBERS, Watch
from studio.world.setting import Setting
from studio.world.table.event import (
    COMMAND_GIVEN,
    COMMAND_TAKEN,
    COMPANY_CAME,
    COMPANY_LEFT,
    COUNTED,
    CUT_OFF,
    EVENTS,
    HOPELESS,
    LED_AROUND,
    MESSAGE_LOST,
    NOTICE_SHOWN,
    OUT_OF_REACH,
    ROUTE_FILE,
    SCRIPT_BEGUN,
    SCRIPT_CUT,
    SCRIPT_ENDED,
    SCRIPT_VAIN,
    TAKES_OVER,
)  # fmt: skip
from studio.world.world import World

NOBODY = -1


@dataclass(frozen=True)
class Follower:
    """A vehicle of a chain, and the one that it listens to."""

    world: int
    name: str
    ahead: str
    members: tuple[str, ...]


def chains(setting: Setting) -> tuple[Chain, ...]:
    """Groups in which everybody listens to the vehicle ahead of it in the list."""
    found = []
    for name, group in setting.scenario.applications.items():
        ahead = [group.senders(i)[0] for i in range(len(group.units)) if group.senders(i)]
        order = [*ahead[:1], *group.units]
        if ahead and ahead == order[:-1] and setting.scenario.vehicles.keys() >= set(order):
            found.append(Chain(name, group.application, tuple(order)))
    return tuple(found)


def followers(settings: Sequence[Setting]) -> list[Follower]:
    """All vehicles of all chains but the first of each."""
    return [
        Follower(w, follower, ahead, chain.vehicles)
        for w, each in enumerate(settings)
        for chain in chains(each)
        for ahead, follower in pairwise(chain.vehicles)
    ]


def watched(settings: Sequence[Setting], world: World) -> Watch:
    """What is looked out for in a batch."""
    numbers = [{name: i for i, name in enumerate(names)} for names in world.names]
    named = [np.arange(len(each.cars)) < len(each.scenario.vehicles) for each in settings]
    listening = []
    for each in followers(settings):
        number = numbers[each.world]
        column = int(world.worlds.first[each.world]) + number[each.name]
        listening.append((column, tuple(number[name] for name in each.members)))
    return notice.watch(world, np.concatenate(named).astype(np.int64), listening, listened(settings, world))


def listened(settings: Sequence[Setting], world: World) -> list[np.ndarray]:
    """Per post, the links whose sender the receiver's applications listen to by name.

    That one of everybody else's messages was lost is no event but a line of the log of messages.
    """
    number = world.units.number
    pairs = {
        (number(unit, w), number(sender, w))
        for w, each in enumerate(settings)
        for group in each.scenario.applications.values()
        for i, unit in enumerate(group.units)
        for sender in group.senders(i)
    }
    return [np.array([link for pair, link in post.links.items() if pair in pairs], dtype=np.int64) for post in world.units.posts]


def hopeless(setting: Setting) -> Iterator[Happening]:
    """What is told before a run: entries of the script that can never begin, or never end."""
    place = Place(setting.scenario, setting.network, setting.locks)
    for site in setting.sites:
        for turn, part in (("begin", site.entry.when), ("end", site.entry.until)):
            if part is not None and (reason := place.never(part)):
                yield happening(HOPELESS, 0.0, site.vehicles, place=site.place, entry=site.name, turn=turn, reason=reason)


def out_of_reach(setting: Setting) -> Iterator[Happening]:
    """What is told before a run: speeds at the start and in the script that a vehicle's power does not bring it to against its drag."""
    cars = {car.name: car for car in setting.cars}
    for vehicle, what, speed in speeds(setting.scenario):
        if speed > (top := top_speed(cars[vehicle].model.values)):
            yield happening(OUT_OF_REACH, 0.0, (vehicle,), what=what, speed=speed, top_speed=top)


def speeds(scenario: Scenario) -> Iterator[tuple[str, str, float]]:
    """The speeds [m/s] that a scenario asks of its vehicles, and where."""
    for name, vehicle in scenario.vehicles.items():
        yield name, "at its start", vehicle.speed
    for name, entry in scenario.script.items():
        module = registry.find("action", entry.do.kind).module
        if hasattr(module, "fastest"):
            yield entry.do.vehicle, f"script.{name}", module.fastest(entry.do)


def rerouted(setting: Setting) -> Iterator[Happening]:
    """What is told before a run: flows and trips whose way a closed road cuts."""
    for each in setting.detours:
        if np.isfinite(each.longer):
            yield happening(LED_AROUND, 0.0, demand=each.field, road=each.road, longer=each.longer)
        else:
            yield happening(CUT_OFF, 0.0, demand=each.field, road=each.road)


def foreseen(setting: Setting) -> Iterator[Happening]:
    """All that is told before a run."""
    yield from hopeless(setting)
    yield from out_of_reach(setting)
    yield from rerouted(setting)
    for each in setting.counted:
        yield happening(COUNTED, 0.0, count=each.name, road=each.road, rate=each.rate, brought=each.brought)
    yield from (happening(ROUTE_FILE, 0.0, what=each) for each in setting.imported)


class Teller:
    """Makes happenings of notices."""

    def __init__(self, settings: Sequence[Setting], world: World) -> None:
        self.world = world
        self.scenarios = [each.scenario for each in settings]
        self.sites = [site for each in settings for site in each.sites]
        self.followers = followers(settings)
        self.special = {
            SCRIPT_BEGUN: self.turned,
            SCRIPT_ENDED: self.turned,
            SCRIPT_CUT: self.turned,
            SCRIPT_VAIN: self.turned,
            COMPANY_CAME: self.company,
            COMPANY_LEFT: self.company,
            TAKES_OVER: self.takes_over,
            COMMAND_TAKEN: self.changes_hands,
            MESSAGE_LOST: self.lost,
            NOTICE_SHOWN: self.shown,
        }
        self.showing = [hosted.application.module.NOTICES for hosted in world.hosted if hosted.shows]

    def tell(self, watch: Watch) -> Iterator[tuple[int, Happening]]:
        """Empties the table."""
        rows, watch.count[0] = watch.table[:, : watch.count[0]].T.tolist(), 0
        for when, kind, world, subject, other, x, y, value in rows:
            make = self.special.get(int(kind), self.plain)
            place = None if isnan(x) else (x, y)
            yield int(world), make(int(kind), when, int(world), int(subject), int(other), place, value)

    def plain(self, kind, when, world, subject, other, place, value) -> Happening:
        """What is about a vehicle, and perhaps another one or an object, with one number or none."""
        units = tuple(self.world.name_of(number, world) for number in (subject, other) if number != NOBODY)
        return happening(kind, when, units, place=place, **dict.fromkeys(EVENTS[kind].numbers, value))

    def turned(self, kind, when, _world, subject, other, place, _value) -> Happening:
        """An entry of the script has begun or ended, by itself or because another has begun."""
        site, by = self.sites[subject], "" if other == NOBODY else self.sites[other].name
        return happening(kind, when, site.vehicles, place=place or site.place, entry=site.name, action=site.text, other=by)

    def company(self, kind, when, world, subject, other, place, _value) -> Happening:
        """Somebody has come between a follower and the car that it listens to, or has gone again."""
        follower = self.followers[subject]
        between = () if other == NOBODY else (self.world.names[world][other],)
        return happening(kind, when, (follower.name, *between, follower.ahead), place=place)

    def lost(self, kind, when, world, subject, other, place, value) -> Happening:
        """A unit hears another again after messages were lost."""
        names = self.world.units.names[world]
        return happening(kind, when, (names[subject], names[other]), place=place, missed=value)

    def shown(self, kind, when, world, subject, other, place, value) -> Happening:
        """An application has begun to show a sentence to its driver."""
        return happening(kind, when, (self.world.units.names[world][subject],), place=place, sentence=self.showing[other][int(value) - 1])

    def takes_over(self, kind, when, world, subject, _other, place, value) -> Happening:
        """A driver has begun to overrule the application of his vehicle."""
        reason = REASONS[int(value)].replace("_", " ")
        return happening(kind, when, (self.world.names[world][subject],), place=place, reason=reason)

    def changes_hands(self, _kind, when, world, subject, _other, place, value) -> Happening:
        """Wheel, brake, drive or gear are another's now: taken by whoever goes before, given back to whoever does not."""
        rest, which = divmod(int(value), NUMBERS)
        who, before = divmod(rest, NUMBERS)
        scenario = self.scenarios[world]
        names, kind = commanders(scenario), COMMAND_GIVEN if standing(who, scenario) < standing(before, scenario) else COMMAND_TAKEN
        what = listed([part for i, part in enumerate(PARTS) if which >> i & 1])
        return happening(kind, when, (self.world.names[world][subject],), place=place, by=names[who], what=what, before=names[before])


def listed(words: Sequence[str]) -> str:
    """Words as one reads them: brake, drive and gear."""
    return " and ".join(filter(None, [", ".join(words[:-1]), words[-1]]))
