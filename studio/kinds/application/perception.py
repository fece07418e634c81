"""Collective perception: tells others what the own object sensor sees, by the rules of ETSI TS 103 324.

Every 0.1 s an object is told of when it has moved by more than 4 m or become faster or slower by more than 0.5 m/s since it was last
told of, or when that is a second ago (studio/model/generation.py); a message goes out when there is such an object, and once a second.
How far an object has moved is the sum of how far the own car has, along its way, and how its place before the car has changed: a car
knows no heading of its own, so that bends count little.
"""

from math import cos, sin, sqrt
from typing import Annotated, NamedTuple

from studio.application.contract import Clock, Outbox, Own, Targets
from studio.compiled import compiled
from studio.kind.settings import Part, number
from studio.kinds.message.cpm import MOST, NONE, Eight, Payload
from studio.model import generation

KIND = "application"
TITLE = "Collective perception (CPM)"
NOBODY = (-1.0, -1.0, -1.0, -1.0, -1.0, -1.0, -1.0, -1.0)
EARLY = 1e-6  # [s]


class Parameters(Part):
    """What is told, and how often it is looked."""

    period: float = number(0.1, unit="s", title="Time between two looks", ge=0.02, le=1)
    existence: float = number(0.5, unit="1", title="Least existence", description="of an object that is told of", ge=0, le=1)


class Memory(NamedTuple):
    """Of the objects that were seen at the last look: their tracks, and what was told of each."""

    looked: Annotated[float, "s", "when"] = -1.0
    sent: Annotated[float, "s", "when the last message went out"] = -1.0
    travelled: Annotated[float, "m", "by the own car"] = 0.0
    track: Annotated[Eight, "1", "numbers of the tracks, -1 for none"] = NOBODY
    told: Annotated[Eight, "s", "when each was told of"] = NONE
    place: Annotated[Eight, "m", "where it was then, along the own way"] = NONE
    left: Annotated[Eight, "m", "and to the left of it"] = NONE
    speed: Annotated[Eight, "m/s", "and how fast"] = NONE


class Sees(NamedTuple):
    """The sensor."""

    clock: Clock
    own: Own
    around: Annotated[Targets, "object_sensor", 8]


class Log(NamedTuple):
    """What was done."""

    told: Annotated[float, "1"] = 0.0


class Does(NamedTuple):
    """The message."""

    send: Annotated[Outbox, "cpm", 1]
    log: Log


@compiled
def put(some, place, value):
    """Eight numbers with another one at a place."""
    return (
        value if place == 0 else some[0], value if place == 1 else some[1], value if place == 2 else some[2],
        value if place == 3 else some[3], value if place == 4 else some[4], value if place == 5 else some[5],
        value if place == 6 else some[6], value if place == 7 else some[7],
    )  # fmt: skip


@compiled
def place_of(track, among):
    """Where a track stands among those that are known; -1 when it is new."""
    for i in range(MOST):
        if among[i] == track:
            return i
    return -1


@compiled
def is_news(i, time, place, left, speed, memory):
    """Whether others must hear of the object that stands at a place of the memory; one that stands nowhere is new."""
    if i < 0:
        return True
    along, across = place - memory.place[i], left - memory.left[i]
    moved = generation.hundredths(sqrt(along * along + across * across))
    changed = generation.has_changed(moved, 0, generation.hundredths(speed - memory.speed[i]))
    return generation.is_told(generation.milliseconds(time - memory.told[i]), changed)


@compiled
def decide(parameters, memory, sees):
    """One tick."""
    p, own, time = parameters, sees.own, sees.clock.time
    travelled = memory.travelled + own.speed * sees.clock.tick
    silent = Payload(own.gps_x, own.gps_y, own.speed, 0.0, NONE, NONE, NONE, NONE, NONE)
    if memory.looked >= 0.0 and time - memory.looked < p.period - EARLY:
        kept = Memory(memory.looked, memory.sent, travelled, memory.track, memory.told, memory.place, memory.left, memory.speed)
        return kept, Does(Outbox(0, (silent,)), Log(0.0))
    track, told, places, lefts, speeds = NOBODY, NONE, NONE, NONE, NONE
    identity, age, ahead, left, speed_ahead, count = NONE, NONE, NONE, NONE, NONE, 0
    for k in range(min(sees.around.count, MOST)):
        target = sees.around.target[k]
        before, aside, speed = target.range * cos(target.azimuth), target.range * sin(target.azimuth), own.speed + target.rate
        i, place = place_of(target.track, memory.track), travelled + before
        news = target.existence >= p.existence and is_news(i, time, place, aside, speed, memory)
        if news:
            identity, age, ahead = put(identity, count, target.track), put(age, count, sees.around.age), put(ahead, count, before)
            left, speed_ahead, count = put(left, count, aside), put(speed_ahead, count, speed), count + 1
        if news or i >= 0:
            track, told = put(track, k, target.track), put(told, k, time if news else memory.told[i])
            places = put(places, k, place if news else memory.place[i])
            lefts = put(lefts, k, aside if news else memory.left[i])
            speeds = put(speeds, k, speed if news else memory.speed[i])
    goes = count > 0 or memory.sent < 0.0 or time - memory.sent >= 1.0 - EARLY
    payload = Payload(own.gps_x, own.gps_y, own.speed, float(count), identity, age, ahead, left, speed_ahead)
    kept = Memory(time, time if goes else memory.sent, travelled, track, told, places, lefts, speeds)
    return kept, Does(Outbox(1 if goes else 0, (payload,)), Log(float(count)))
