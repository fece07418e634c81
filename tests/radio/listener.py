"""Hears what others say of themselves, and does nothing about it: so that they say it."""

from typing import Annotated, NamedTuple

from studio.application.contract import Inbox
from studio.compiled import compiled
from studio.kind.settings import Part

KIND = "application"
TITLE = "Listener"


class Parameters(Part):
    """Nothing is set."""


class Memory(NamedTuple):
    """Nothing is remembered."""


class Sees(NamedTuple):
    """The others."""

    heard: Annotated[Inbox, "awareness", 1]


class Log(NamedTuple):
    """What is recorded."""

    heard: Annotated[float, "1"] = 0.0


class Does(NamedTuple):
    """It does nothing."""

    log: Log


@compiled
def decide(parameters, memory, sees):
    """One tick."""
    return memory, Does(Log(float(sees.heard.count)))
