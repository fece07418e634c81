"""A radio with every part that one may have, for tests: losses in runs, a loaded channel, congestion control, a cell of a bandwidth.

Losses as E. N. Gilbert, Capacity of a burst-noise channel, Bell System Technical Journal 39 (1960) 1253, and E. O. Elliott, ibid. 42 (1963)
1977: a link is in a good or a bad state, which may change from message to message.
"""

from typing import Annotated, NamedTuple

from studio.compiled import compiled
from studio.kind.settings import Part, number
from studio.world.table.cause import BURST, CHANCE, RECEIVED
from studio.world.view import Transmission, chance

KIND = "radio"
TITLE = "Patchy radio"


class Settings(Part):
    """What all units share."""

    delay: float = number(0.02, unit="s", title="Delay", ge=0, le=1)
    worsens: float = number(0.0, unit="1", title="Good to bad", ge=0, le=1)
    betters: float = number(1.0, unit="1", title="Bad to good", ge=0, le=1)
    loss_good: float = number(0.0, unit="1", title="Loss in the good state", ge=0, le=1)
    loss_bad: float = number(0.0, unit="1", title="Loss in the bad state", ge=0, le=1)
    range: float = number(300.0, unit="m", title="Range", ge=1, le=5000)
    heard: float = number(300.0, unit="m", title="Range of the noise", ge=1, le=5000)
    airtime: float = number(0.0, unit="s", title="Time on the air", ge=0, le=0.1)
    bandwidth: float = number(1e9, unit="byte/s", title="Bandwidth of the cell", ge=1, le=1e12)
    longest_wait: float = number(0.0, unit="s", title="Longest wait", ge=0, le=100)


class Memory(NamedTuple):
    """Of a link."""

    is_bad: Annotated[float, "1", "1 in the bad state"] = 0.0


class Control(NamedTuple):
    """Of a unit."""

    gap: Annotated[float, "s", "the longest that it was told"] = 0.0


class Cell(NamedTuple):
    """Of the cell."""

    waiting: Annotated[float, "byte", "at the time of the last message"] = 0.0
    time: Annotated[float, "s", "of the last message"] = 0.0


def longest(settings):
    """The longest delay [s]."""
    return settings.delay + settings.longest_wait


def reach(settings):
    """The range [m]."""
    return settings.range


def heard_within(settings):
    """Where the channel is busy [m]."""
    return settings.heard


def largest(settings):
    """The largest message [bytes]."""
    return 1400


@compiled
def airtime(settings, size):
    """The same for all [s]."""
    return settings.airtime


@compiled
def control(settings, load, control):
    """0.4 s once the load has been 0.5."""
    gap = max(control.gap, 0.4 if load >= 0.5 else 0.0)
    return gap, Control(gap)


@compiled
def admit(settings, sent, cell):
    """What waits already is carried first."""
    waiting = max(cell.waiting - (sent.time - cell.time) * settings.bandwidth, 0.0) + sent.size
    return min(waiting / settings.bandwidth, settings.longest_wait), Cell(waiting, sent.time)


@compiled
def transmit(settings, way, draw, memory):
    """One message."""
    flips = chance(draw, 0) < (settings.betters if memory.is_bad > 0.0 else settings.worsens)
    is_bad = (memory.is_bad > 0.0) != flips
    lost = chance(draw, 1) < (settings.loss_bad if is_bad else settings.loss_good)
    cause = (BURST if is_bad else CHANCE) if lost else RECEIVED
    return Transmission(cause, settings.delay + way.wait), Memory(1.0 if is_bad else 0.0)
