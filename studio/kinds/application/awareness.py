"""Awareness alone: a unit says what it does (CAM) and hears the others, and drives nothing.

For measuring a radio: how many are heard, how old the freshest message of all is, and all measures of messages, without a function whose
reactions change the traffic.
"""

from typing import Annotated, NamedTuple

from studio.application.contract import Clock, Inbox
from studio.compiled import compiled
from studio.kind.settings import Part, number

KIND = "application"
TITLE = "Awareness alone (CAM)"


class Parameters(Part):
    """What counts as heard."""

    fresh: float = number(1.1, unit="s", title="Fresh", description="age of a message up to which its sender counts", gt=0, le=10)


class Memory(NamedTuple):
    """The worst so far."""

    silence: Annotated[float, "s", "longest time without a message of anybody"] = 0.0


class Sees(NamedTuple):
    """The freshest messages of others."""

    clock: Clock
    heard: Annotated[Inbox, "cam", 8]


class Log(NamedTuple):
    """What was heard."""

    heard: Annotated[float, "1"] = 0.0  # senders, up to eight
    age: Annotated[float, "s"] = 0.0  # of the freshest message; before the first, the time since the start
    silence: Annotated[float, "s"] = 0.0  # the greatest age so far


class Does(NamedTuple):
    """Nothing but what is recorded."""

    log: Log


@compiled
def decide(parameters, memory, sees):
    """One tick."""
    heard, age = 0.0, sees.heard.message[0].age
    for i in range(sees.heard.count):
        heard += sees.heard.message[i].age <= parameters.fresh
    silence = max(memory.silence, age)
    return Memory(silence), Does(Log(heard, age, silence))
