"""Handshakes of three messages, one after the other: request, acknowledgement, commitment, each repeated until the next one is heard."""

from typing import Annotated, NamedTuple

from studio.application.contract import Clock, Inbox, Outbox
from studio.compiled import compiled
from studio.kind.settings import Part, number

from .step import Payload

KIND = "application"
TITLE = "Handshake"
EARLY = 1e-6  # [s]


class Parameters(Part):
    """What is set."""

    asks: bool = False
    repetition: float = number(0.02, unit="s", title="Repetition", ge=0.001, le=1)
    round: float = number(0.8, unit="s", title="Time of one handshake", ge=0.1, le=10)


class Memory(NamedTuple):
    """Which handshake, how far it is, and when was sent last."""

    round: Annotated[float, "1"] = -1.0
    stage: Annotated[float, "1"] = 0.0
    sent: Annotated[float, "s"] = -1.0
    took: Annotated[float, "s"] = -1.0


class Sees(NamedTuple):
    """The other."""

    clock: Clock
    heard: Annotated[Inbox, "step", 1]


class Log(NamedTuple):
    """When the newest handshake was done, since its beginning, and which it was."""

    took: Annotated[float, "s"] = -1.0
    round: Annotated[float, "1"] = -1.0


class Does(NamedTuple):
    """What it does."""

    send: Annotated[Outbox, "step", 1]
    log: Log


@compiled
def decide(parameters, memory, sees):
    """One moment."""
    p, time, heard = parameters, sees.clock.time, sees.heard.message[0]
    round, stage, sent = memory.round, memory.stage, memory.sent
    told = heard.payload if heard.received else Payload(-2.0, 0.0)
    now = time // p.round if (time + EARLY) // p.round == time // p.round else time // p.round + 1.0
    if p.asks and now != round:
        round, stage, sent = now, 1.0, -1.0
    elif p.asks and stage == 1.0 and told.round == round:
        stage, sent = 2.0, -1.0
    elif not p.asks and told.round > round:
        round, stage, sent = told.round, 1.0, -1.0
    elif not p.asks and stage == 1.0 and told.round == round and told.stage == 2.0:
        stage = 3.0
    sends = 0.0 < stage < 3.0 and time - sent > p.repetition - EARLY
    took = time - round * p.round if stage == 3.0 and memory.stage != 3.0 else memory.took
    out = Outbox(1 if sends else 0, (Payload(round, stage),))
    return Memory(round, stage, time if sends else sent, took), Does(out, Log(took, round))
