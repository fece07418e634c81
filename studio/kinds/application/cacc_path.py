"""Cooperative adaptive cruise control of PATH's field tests: gap and speed difference set the speed.

    v_set = v + k_p e + k_d e',    e = d - (r + h v),    e' = v_p - v - h a,    u = (v_set - v)/T_step

V. Milanés, S. E. Shladover, Modeling cooperative and autonomous adaptive cruise control dynamic responses using experimental data,
Transportation Research C 48 (2014) 285, with their gains; r is 0 there. The speed is set once a control step, so the step is part of the
law: for ideal cars it is string stable from h = sqrt(2 T_step/k_p) on, 0.67 s at 0.1 s and 0.21 s at 0.01 s. What a control step of the
law is stays `step` here, however often the application is called.

Without a link it is the adaptive cruise control of the same cars, u = k_1 (d - r - h v) + k_2 (v_p - v) with 0.23 1/s² and 0.07 1/s, which
is string stable from h = 2.66 s on (k_1 h² + 2 k_2 h = 2). Their drivers had it at 1.1 to 2.2 s, where it amplifies by up to 1.59.
Gap and rate are those of the estimate of studio/model/singer.py: with these gains the noise of a radar would be felt.
"""

from typing import Annotated, NamedTuple

from studio.application.contract import ACCELERATION, Clock, Command, Inbox, Own, Targets, accelerate
from studio.compiled import compiled
from studio.kind.settings import number
from studio.kinds.application.cacc import HEADWAY_RATE, Estimate, Following, approach, calmed, is_sender
from studio.model import singer

KIND = "application"
TITLE = "Cooperative adaptive cruise control (PATH)"
COMMANDS = ACCELERATION
CALM = 0.3  # [m/s²] three times what the noise of a radar makes of the request; the gap is off by 7 cm for it
K_1, K_2 = 0.23, 0.07  # [1/s²], [1/s] of the adaptive cruise control


class Parameters(Following):
    """What is tuned."""

    headway: float = number(0.7, unit="s", title="Time headway", description="h", ge=0.1, le=5)
    standstill: float = number(2.0, unit="m", title="Standstill distance", description="r", ge=0, le=20)
    k_p: float = number(0.45, unit="1/s", title="Gain on the gap", description="k_p", ge=0, le=5)
    k_d: float = number(0.25, unit="1", title="Gain on its change", description="k_d", ge=0, le=5)
    step: float = number(0.1, unit="s", title="Control step", description="in which the set speed is reached", ge=0.01, le=1)
    fallback_headway: float = number(2.7, unit="s", title="Headway without link", ge=0.1, le=5)


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
def cooperative(p, h, d, rate, own):
    """Acceleration [m/s²] that reaches the set speed within a control step."""
    e, de = d - p.standstill - h * own.speed, rate - h * own.acceleration
    return (p.k_p * e + p.k_d * de) / p.step


@compiled
def alone(p, h, d, rate, own):
    """Acceleration [m/s²] without a link."""
    return K_1 * (d - p.standstill - h * own.speed) + K_2 * rate


@compiled
def decide(parameters, memory, sees):
    """One tick."""
    p, own, message, front, T = parameters, sees.own, sees.heard.message[0], sees.front.target[0], sees.clock.tick
    is_behind = sees.front.count > 0
    ahead = singer.followed(memory.ahead, front.range, front.rate, own.acceleration, T) if is_behind else singer.NOBODY
    linked = message.received and message.age <= p.timeout and (not is_behind or is_sender(p, own, front, message))
    h = p.headway if memory.headway < 0.0 else approach(memory.headway, p.headway if linked else p.fallback_headway, HEADWAY_RATE * T)
    u = p.cruise_gain * (own.set_speed - own.speed)
    if is_behind and linked:
        u = min(u, cooperative(p, h, ahead[0], ahead[1], own))
    elif is_behind:
        u = min(u, alone(p, h, ahead[0], ahead[1], own))
    command = calmed(min(max(u, -p.deceleration_max), p.acceleration_max), memory.asked, CALM)
    return Memory(h, memory.asked if command == 0.0 else command, ahead), Does(accelerate(command))
