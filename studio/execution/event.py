"""Events in words: what compiled code has noticed, as sentences with names.

watched(settings, world)     →  Watch              what is looked out for
Teller(settings, world)      .tell(watch)          →  (world, Happening), in the order in which things happened
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from studio.execution.record import Chain, Happening
from studio.scenario.schema import REASONS
from studio.world.passes import notice
from studio.world.passes.notice import Watch
from studio.world.setting import Setting
from studio.world.table.street import HIT_FIRST, HIT_SECOND, HIT_SPEED, HIT_TIME
from studio.world.world import World


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
    return notice.watch(world, np.concatenate(named).astype(np.int64), listening)


class Teller:
    """Makes happenings of notices."""

    def __init__(self, settings: Sequence[Setting], world: World) -> None:
        self.world = world
        self.triggers = [trigger for each in settings for trigger in each.scenario.triggers.items()]
        self.sites = [site for each in settings for site in each.sites]
        self.followers = followers(settings)
        self.words = {
            notice.TRIGGERED: self.triggered,
            notice.BEGUN: self.begun,
            notice.ENDED: self.ended,
            notice.HIT: self.hit,
            notice.ROLLED_OVER: self.rolled_over,
            notice.ARRIVED: self.arrived,
            notice.COMPANY: self.company,
            notice.WAITS: self.waits,
            notice.TAKES_OVER: self.takes_over,
        }

    def tell(self, watch: Watch) -> Iterator[tuple[int, Happening]]:
        """Empties the table."""
        rows, watch.count[0] = watch.table[:, : watch.count[0]].T.tolist(), 0
        for when, kind, world, subject, other in rows:
            at, text, vehicle = self.words[int(kind)](when, int(world), int(subject), int(other))
            yield int(world), Happening(round(at, 6), text, vehicle)

    def triggered(self, _when: float, _world: int, subject: int, _other: int) -> tuple[float, str, str]:
        """A scripted maneuver has begun."""
        name, trigger = self.triggers[subject]
        return trigger.time, f"{name}: {trigger.do.maneuver} with {trigger.do.deceleration:g} m/s²", trigger.vehicle

    def begun(self, _when: float, _world: int, subject: int, _other: int) -> tuple[float, str, str]:
        """A change of the road has begun."""
        site = self.sites[subject]
        return float(self.world.changes.turned[0, subject]), f"{site.name} begins: {site.text}", site.begins.vehicle

    def ended(self, _when: float, _world: int, subject: int, _other: int) -> tuple[float, str, str]:
        """A change of the road is over."""
        site = self.sites[subject]
        return float(self.world.changes.turned[1, subject]), f"{site.name} ends", site.ends.vehicle

    def hit(self, _when: float, world: int, subject: int, _other: int) -> tuple[float, str, str]:
        """A collision."""
        hit = self.world.events.hits_of(world)[:, subject]
        first, second = (self.world.name_of(int(hit[row]), world) for row in (HIT_FIRST, HIT_SECOND))
        return float(hit[HIT_TIME]), f"collision of {first} and {second} at {hit[HIT_SPEED]:.1f} m/s", first

    def rolled_over(self, when: float, world: int, subject: int, _other: int) -> tuple[float, str, str]:
        """A vehicle has rolled over: what it does after it is not claimed."""
        return when, "rolled over; what it does after this is not claimed", self.world.names[world][subject]

    def arrived(self, when: float, world: int, subject: int, _other: int) -> tuple[float, str, str]:
        """A named vehicle has reached the end of its route."""
        return when, "arrived at the end of its route", self.world.names[world][subject]

    def company(self, when: float, world: int, subject: int, other: int) -> tuple[float, str, str]:
        """Somebody has come between a follower and the car that it listens to, or has gone again."""
        follower = self.followers[subject]
        if other < 0:
            return when, f"nobody is between it and {follower.ahead} any more", follower.name
        return when, f"{self.world.names[world][other]} is between it and {follower.ahead}", follower.name

    def waits(self, when: float, world: int, subject: int, _other: int) -> tuple[float, str, str]:
        """A named vehicle has come to a stand at a red light."""
        return when, "waits at a red light", self.world.names[world][subject]

    def takes_over(self, when: float, world: int, subject: int, other: int) -> tuple[float, str, str]:
        """A driver has begun to overrule the application of his vehicle."""
        return when, f"driver takes over: {REASONS[other].replace('_', ' ')}", self.world.names[world][subject]
