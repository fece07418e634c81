"""Cooperative awareness message (CAM): what a car says of itself whenever others must know, by the rules of ETSI EN 302 637-2.

When one is due is told in studio/model/generation.py: on a straight road at 50 km/h every 0.3 s, standing every second. Congestion
control of the radio may make it wait. There is no compass among what a car knows of itself, so the change of its heading is the sum of
its yaw rate from one look to the next. The container of low frequency goes along every half second, with a certificate: 200 to 400
bytes are measured, 200 and 300 taken here.
"""

from math import sqrt
from typing import Annotated, NamedTuple

from studio.compiled import compiled
from studio.kind.settings import Part, number
from studio.model import generation

KIND = "message"
TITLE = "Cooperative awareness (CAM), sent when something has changed"
SIZE = 300
SMALL = 200  # [bytes] without the container of low frequency
RARELY = 500  # [ms] between two containers of low frequency


class Settings(Part):
    """How often it is looked whether one is due."""

    period: float = number(0.1, unit="s", title="Time between two looks", description="T_CheckCamGen", ge=0.01, le=0.1)


class Payload(NamedTuple):
    """The sender."""

    x: Annotated[float, "m", "east position by its satellite receiver, with its errors"] = 0.0
    y: Annotated[float, "m", "north position, likewise"] = 0.0
    speed: Annotated[float, "m/s", "along the car"] = 0.0
    acceleration: Annotated[float, "m/s²", "forward"] = 0.0
    yaw_rate: Annotated[float, "rad/s", "to the left"] = 0.0
    low_frequency: Annotated[bool, "", "whether the container of low frequency goes along"] = False


class Memory(NamedTuple):
    """What the last one said, and the rules' own state."""

    sent: Annotated[float, "s", "when, on the own clock; negative before the first"] = -1.0
    looked: Annotated[float, "s", "when it was looked last"] = 0.0
    x: Annotated[float, "m", "position that it told"] = 0.0
    y: Annotated[float, "m", "position that it told"] = 0.0
    speed: Annotated[float, "m/s", "that it told"] = 0.0
    turned: Annotated[float, "rad", "heading now, less that when it was sent"] = 0.0
    interval: Annotated[float, "ms", "T_GenCam"] = 1000.0
    timed: Annotated[float, "1", "how many in a row only time has triggered"] = 0.0
    rare: Annotated[float, "s", "when the container of low frequency went along last"] = -1.0


@compiled
def due(own, settings, memory, turn):
    """Whether one is sent now."""
    turned = memory.turned + own.yaw_rate * (turn.time - memory.looked)
    moved = sqrt((own.gps_x - memory.x) ** 2 + (own.gps_y - memory.y) ** 2)
    changed = generation.has_changed(
        generation.hundredths(moved), generation.tenths_of_degree(turned), generation.hundredths(own.speed - memory.speed)
    )
    elapsed, gap = generation.milliseconds(turn.time - memory.sent), generation.milliseconds(turn.gap)
    is_due, interval, timed = generation.awareness(elapsed, gap, int(memory.interval), int(memory.timed), changed)
    if memory.sent < 0.0:
        is_due, interval, timed = True, generation.LONGEST, 0
    if not is_due:
        return False, Memory(memory.sent, turn.time, memory.x, memory.y, memory.speed, turned, memory.interval, memory.timed, memory.rare)
    is_rare = memory.rare < 0.0 or generation.milliseconds(turn.time - memory.rare) >= RARELY
    rare = turn.time if is_rare else memory.rare
    return True, Memory(turn.time, turn.time, own.gps_x, own.gps_y, own.speed, 0.0, float(interval), float(timed), rare)


@compiled
def beacon(own, settings, memory):
    """What a car says of itself."""
    return Payload(own.gps_x, own.gps_y, own.speed, own.acceleration, own.yaw_rate, memory.rare == memory.sent)


@compiled
def size(payload):
    """Bytes, by what goes along."""
    return SIZE if payload.low_frequency else SMALL
