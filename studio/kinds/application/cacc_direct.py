"""Cooperative adaptive cruise control that does at once what the car ahead does.

    u = k_a u_ahead + k_v (v_p - v) + k_d (d - r - h v)

B. van Arem, C. J. G. van Driel, R. Visser, The impact of cooperative adaptive cruise control on traffic-flow characteristics, IEEE
Trans. Intelligent Transportation Systems 7 (2006) 429, with their gains; in place of the acceleration of the car ahead stands the one
that it has requested, which comes before it.

With k_a = 1 and cars that do what they are asked the speeds follow each other by

    V/V_p = (s² + k_v s + k_d) / (s² + (k_v + k_d h) s + k_d)

so the gain is below 1 at every frequency, and the lag that of the message; a car of Ploeg's law (cacc) comes a headway later. The price
is the spacing, which is off until the slow poles have brought it back.

When the link is silent for longer than `timeout`, or a stranger is ahead, the acceleration ahead is estimated from the radar
(studio/model/singer.py), as gap and rate always are, and the headway rises to `fallback_headway`, by 0.1 s in a second, as one that is
tuned does.
"""

from typing import Annotated, NamedTuple

from studio.application.contract import ACCELERATION, Clock, Command, Inbox, Own, Targets, accelerate
from studio.compiled import compiled
from studio.kind.settings import number
from studio.kinds.application.cacc import HEADWAY_RATE, Estimate, Following, approach, calmed, is_sender
from studio.model import singer

KIND = "application"
TITLE = "Cooperative adaptive cruise control (direct feed-forward)"
COMMANDS = ACCELERATION
CALM = 0.1  # [m/s²] four times what the noise of a radar makes of the request


class Parameters(Following):
    """What is tuned."""

    headway: float = number(0.5, unit="s", title="Time headway", description="h", ge=0.1, le=5)
    standstill: float = number(2.0, unit="m", title="Standstill distance", description="r", ge=0, le=20)
    k_a: float = number(1.0, unit="1", title="Feed-forward", description="k_a, share of the request of the car ahead", ge=0, le=1)
    k_v: float = number(0.58, unit="1/s", title="Gain on the speed difference", description="k_v", ge=0, le=5)
    k_d: float = number(0.1, unit="1/s²", title="Gain on the gap", description="k_d", ge=0, le=5)
    fallback_headway: float = number(1.6, unit="s", title="Headway without link", ge=0.1, le=5)


class Memory(NamedTuple):
    """The headway in force, what is asked of the car, and what is estimated of the car ahead."""

    headway: Annotated[float, "s"] = -1.0  # negative before the first tick
    asked: Annotated[float, "m/s²", "last that was not 0"] = 0.0
    ahead: Annotated[Estimate, "1", "as studio/model/singer.py has it"] = singer.NOBODY


class Sees(NamedTuple):
    """What it sees: the radar's target, and the car that it listens to."""

    clock: Clock
    own: Own
    front: Annotated[Targets, "front_radar", 1]
    heard: Annotated[Inbox, "awareness", 1]


class Does(NamedTuple):
    """What it does."""

    command: Command


@compiled
def follow(p, h, u_ahead, own, d, rate):
    """Acceleration [m/s²] behind the target."""
    return p.k_a * u_ahead + p.k_v * rate + p.k_d * (d - p.standstill - h * own.speed)


@compiled
def decide(parameters, memory, sees):
    """One tick."""
    p, own, message, front, T = parameters, sees.own, sees.heard.message[0], sees.front.target[0], sees.clock.tick
    is_behind = sees.front.count > 0
    ahead = singer.followed(memory.ahead, front.range, front.rate, own.acceleration, T) if is_behind else singer.NOBODY
    linked = message.received and message.age <= p.timeout and (not is_behind or is_sender(p, own, front, message))
    h = p.headway if memory.headway < 0.0 else approach(memory.headway, p.headway if linked else p.fallback_headway, HEADWAY_RATE * T)
    u = p.cruise_gain * (own.set_speed - own.speed)
    if is_behind:
        u = min(u, follow(p, h, message.payload.intention if linked else ahead[2], own, ahead[0], ahead[1]))
    command = calmed(min(max(u, -p.deceleration_max), p.acceleration_max), memory.asked, CALM)
    return Memory(h, memory.asked if command == 0.0 else command, ahead), Does(accelerate(command))
