"""Hears what everybody says of itself, for tests."""

from typing import Annotated, NamedTuple

from studio.application.contract import Clock, Inbox
from studio.compiled import compiled
from studio.kind.settings import Part

KIND = "application"
TITLE = "Ear"


class Parameters(Part):
    """Nothing."""


class Memory(NamedTuple):
    """Nothing."""


class Sees(NamedTuple):
    """What is said."""

    clock: Clock
    heard: Annotated[Inbox, "awareness", 8]


class Log(NamedTuple):
    """How many are known; of the first whether it was received, how old it is and how long it was under way."""

    count: Annotated[float, "1"] = 0.0
    received: Annotated[float, "1"] = 0.0
    age: Annotated[float, "s"] = 0.0
    delay: Annotated[float, "s"] = 0.0


class Does(NamedTuple):
    """What is kept."""

    log: Log


@compiled
def decide(parameters, memory, sees):
    """One tick."""
    first = sees.heard.message[0]
    return Memory(), Does(Log(float(sees.heard.count), 1.0 if first.received else 0.0, first.age, first.delay))
