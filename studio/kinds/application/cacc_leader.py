"""Cooperative adaptive cruise control at a constant distance, by what the car ahead and the leader tell.

    u = alpha_1 u_p + alpha_2 u_0 + alpha_3 (v - v_p) + alpha_4 (v - v_0) + alpha_5 (D - d)
    alpha_1 = 1 - C_1,  alpha_2 = C_1,  alpha_4 = -C_1 (xi + sqrt(xi² - 1)) omega,  alpha_3 = -2 xi omega - alpha_4,  alpha_5 = -omega²

D wanted and d measured gap, as studio/model/singer.py estimates it and its rate, index p the car ahead and 0 the leader: R. Rajamani,
Vehicle Dynamics and Control, 2nd ed., Eqs. 7.39 to 7.44; C_1 = 0.5, xi = 1, omega = 0.2 1/s as Plexe has them (M. Segata et al., VNC
2014). A distance that does not grow with speed is string stable only because all hear the leader: whoever listens to the car ahead alone
amplifies, whatever the gains.

`listens_to` names for each car the one ahead, then the leader: `[leader, [second, leader], [third, leader]]`. When one of both
is silent for longer than `timeout`, or a stranger is ahead, the gap grows by a headway up to `fallback_headway`, and the acceleration ahead
is estimated as well: u = a_p + k_v (v_p - v) + k_d (d - D - h v), gains of B. van Arem et al., IEEE Trans.
ITS 7 (2006) 429.
"""

from math import sqrt
from typing import Annotated, NamedTuple

from studio.application.contract import ACCELERATION, Clock, Command, Inbox, Own, Targets, accelerate
from studio.compiled import compiled
from studio.kind.settings import number
from studio.kinds.application.cacc import HEADWAY_RATE, Estimate, Following, approach, calmed, is_sender
from studio.model import singer

KIND = "application"
TITLE = "Cooperative adaptive cruise control (leader and predecessor)"
COMMANDS = ACCELERATION
CALM = 0.05  # [m/s²] four times what the noise of a radar makes of the request
K_V, K_D = 0.58, 0.1  # [1/s], [1/s²] without a link


class Parameters(Following):
    """What is tuned."""

    distance: float = number(5.0, unit="m", title="Distance", description="D, the same at every speed", ge=1, le=50)
    leadership: float = number(0.5, unit="1", title="Weight of the leader", description="C_1", ge=0, le=0.99)
    damping: float = number(1.0, unit="1", title="Damping", description="xi", ge=1, le=5)
    bandwidth: float = number(0.2, unit="1/s", title="Bandwidth", description="omega", gt=0, le=5)
    fallback_headway: float = number(1.6, unit="s", title="Headway without link", ge=0, le=5)


class Memory(NamedTuple):
    """The headway in force, what is asked of the car, and what is estimated of the car ahead."""

    headway: Annotated[float, "s"] = 0.0
    asked: Annotated[float, "m/s²", "last that was not 0"] = 0.0
    ahead: Annotated[Estimate, "1", "as studio/model/singer.py has it"] = singer.NOBODY


class Sees(NamedTuple):
    """What it sees: the radar's target, the car ahead, and the leader."""

    clock: Clock
    own: Own
    front: Annotated[Targets, "front_radar", 1]
    heard: Annotated[Inbox, "awareness", 2]


class Does(NamedTuple):
    """What it does."""

    command: Command


@compiled
def weights(p):
    """alpha_1 [1], alpha_2 [1], alpha_3 [1/s], alpha_4 [1/s], alpha_5 [1/s²]."""
    alpha_4 = -p.leadership * (p.damping + sqrt(p.damping * p.damping - 1.0)) * p.bandwidth
    return 1.0 - p.leadership, p.leadership, -2.0 * p.damping * p.bandwidth - alpha_4, alpha_4, -p.bandwidth * p.bandwidth


@compiled
def together(p, own, d, rate, ahead, leader):
    """Acceleration [m/s²] by what both tell; the distance to the car ahead and its change are the radar's."""
    a_1, a_2, a_3, a_4, a_5 = weights(p)
    by_ahead = a_1 * ahead.intention - a_3 * rate + a_5 * (p.distance - d)
    return by_ahead + a_2 * leader.intention + a_4 * (own.speed - leader.speed)


@compiled
def alone(distance, h, own, d, rate, a_ahead):
    """Acceleration [m/s²] behind a car that accelerates with a_ahead [m/s²], as it is estimated."""
    return a_ahead + K_V * rate + K_D * (d - distance - h * own.speed)


@compiled
def is_fresh(message, timeout):
    """Whether a message counts."""
    return message.received and message.age <= timeout


@compiled
def decide(parameters, memory, sees):
    """One tick."""
    p, own, front, T = parameters, sees.own, sees.front.target[0], sees.clock.tick
    first, leader = sees.heard.message[0], sees.heard.message[max(sees.heard.count, 1) - 1]
    is_behind = sees.front.count > 0
    ahead = singer.followed(memory.ahead, front.range, front.rate, own.acceleration, T) if is_behind else singer.NOBODY
    linked = is_fresh(first, p.timeout) and is_fresh(leader, p.timeout) and (not is_behind or is_sender(p, own, front, first))
    h = approach(memory.headway, 0.0 if linked else p.fallback_headway, HEADWAY_RATE * T)
    u = p.cruise_gain * (own.set_speed - own.speed)
    if is_behind and linked and h == 0.0:
        u = min(u, together(p, own, ahead[0], ahead[1], first.payload, leader.payload))
    elif is_behind:
        u = min(u, alone(p.distance, h, own, ahead[0], ahead[1], first.payload.intention if linked else ahead[2]))
    command = calmed(min(max(u, -p.deceleration_max), p.acceleration_max), memory.asked, CALM)
    return Memory(h, memory.asked if command == 0.0 else command, ahead), Does(accelerate(command))
