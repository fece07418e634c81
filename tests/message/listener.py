"""Hears awareness messages by the standard's rules, for tests."""

from typing import Annotated, NamedTuple

from studio.application.contract import Inbox
from studio.compiled import compiled
from studio.kind.settings import Part

KIND = "application"
TITLE = "Listener"


class Parameters(Part):
    """Nothing."""


class Memory(NamedTuple):
    """Nothing."""


class Sees(NamedTuple):
    """What is said."""

    heard: Annotated[Inbox, "cam", 4]


class Log(NamedTuple):
    """How many are known, and how fast the first is."""

    count: Annotated[float, "1"] = 0.0
    speed: Annotated[float, "m/s"] = 0.0
    received: Annotated[float, "1"] = 0.0


class Does(NamedTuple):
    """What is kept."""

    log: Log


@compiled
def decide(parameters, memory, sees):
    """One tick."""
    first = sees.heard.message[0]
    return Memory(), Does(Log(float(sees.heard.count), first.payload.speed, 1.0 if first.received else 0.0))
