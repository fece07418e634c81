"""Lets in: keeps a time gap, tells which lane it is about to take, and opens a gap for whoever tells the same of its own lane.

What two cars of a zipper owe each other. Following as in studio/kinds/application/acc.py (R. Rajamani, Vehicle Dynamics and Control,
2nd ed., Eq. 6.18); who is let in has told so by an `intent` and is beside or ahead as the side radar sees it.
"""

from typing import Annotated, NamedTuple

from studio.application.contract import ACCELERATION, Clock, Command, Inbox, Notice, Outbox, Own, Targets, accelerate
from studio.compiled import compiled
from studio.kind.settings import Part, number

from .intent import Payload

KIND = "application"
TITLE = "Lets others in"
COMMANDS = ACCELERATION
NOTICES = ("A car beside you wants into your lane",)
FRESH = 0.5  # [s] age of a message that still counts
EVERY = 0.1  # [s] between two messages


class Parameters(Part):
    """What is tuned."""

    headway: float = number(1.2, unit="s", title="Time headway", ge=0.3, le=5)
    courtesy: float = number(1.5, unit="m/s²", title="Braking to let somebody in", ge=0, le=4)
    side: float = number(0.0, unit="1", title="Own intent", description="1 to the left, -1 to the right, 0 none", ge=-1, le=1)


class Memory(NamedTuple):
    """When the last message was sent."""

    sent: Annotated[float, "s"] = -1.0


class Sees(NamedTuple):
    """Two sensors, and the newest messages of two others."""

    clock: Clock
    own: Own
    front: Annotated[Targets, "front_radar", 1]
    side: Annotated[Targets, "side_radar", 4]
    heard: Annotated[Inbox, "intent", 2]


class Logged(NamedTuple):
    """What is recorded."""

    wanting: Annotated[float, "1"] = 0.0  # how many others have told that they want into a lane
    beside: Annotated[float, "1"] = 0.0  # cars that the side radar sees beside or ahead


class Does(NamedTuple):
    """Pedals, a message, a notice, and what is recorded."""

    command: Command
    send: Annotated[Outbox, "intent", 1]
    notice: Notice
    log: Logged


@compiled
def decide(parameters, memory, sees):
    """One tick."""
    own, wanting, beside = sees.own, 0.0, 0.0
    for i in range(sees.heard.count):
        message = sees.heard.message[i]
        if message.age < FRESH and message.payload.side != 0.0:
            wanting += 1.0
    for i in range(sees.side.count):
        if sees.side.target[i].ahead > -2.0:
            beside += 1.0
    u = 0.5 * (own.set_speed - own.speed)
    if sees.front.count > 0:
        target = sees.front.target[0]
        u = min(u, (target.rate + 0.1 * (target.range - 2.0 - parameters.headway * own.speed)) / parameters.headway)
    lets_in = wanting > 0.0 and beside > 0.0
    if lets_in:
        u = min(u, -parameters.courtesy)
    is_due = sees.clock.time - memory.sent >= EVERY
    outbox = Outbox(1 if is_due else 0, (Payload(parameters.side, parameters.headway * own.speed, own.speed),))
    command = accelerate(min(max(u, -8.0), 2.0))
    does = Does(command, outbox, Notice(1 if lets_in else 0), Logged(wanting, beside))
    return Memory(sees.clock.time if is_due else memory.sent), does
