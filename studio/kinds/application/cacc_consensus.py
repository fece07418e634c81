"""Cooperative adaptive cruise control by consensus: every car agrees with those ahead about its place, and with the leader about speed.

    u = -b (v - v_0) + (k/n) sum over j of (d_j - (j + 1) (r + h v_0) - j L),    j = 0 ... n - 1

d_j gap to the car j + 1 places ahead, L length of a car, v_0 the leader's speed: M. di Bernardo, A. Salvi, S. Santini, Distributed
consensus strategy for platooning of vehicles in the presence of time-varying heterogeneous communication delays, IEEE Trans. ITS 16
(2015) 102, Eq. 7, with equal weights. The nearest is measured by radar, as studio/model/singer.py
estimates it; the others are where their messages say, drawn on by what they have
driven since, which makes up for the delay as tau v_0 does in the paper. Satellite errors move the car: they count 1/n of themselves.

`listens_to` names for each car those ahead, the nearest first and the leader last, up to four: `[leader]` for the second car, then
`[second, leader]`, `[third, second, leader]`, and `[fourth, third, second, leader]` and so on. Where one of them is silent for longer than
`timeout` it is left out; where the nearest or the leader is, or a stranger is ahead, the law is that of cacc_leader without a link.
"""

from math import sqrt
from typing import Annotated, NamedTuple

from studio.application.contract import ACCELERATION, Clock, Command, Inbox, Own, Targets, accelerate
from studio.compiled import compiled
from studio.kind.settings import number
from studio.kinds.application.cacc import CAR, HEADWAY_RATE, Estimate, Following, approach, calmed, is_sender
from studio.kinds.application.cacc_leader import alone, is_fresh
from studio.model import singer

KIND = "application"
TITLE = "Cooperative adaptive cruise control (consensus)"
COMMANDS = ACCELERATION
PLACES = 3  # ahead, whose distance counts
SLOW = 1.0  # [s] in which places by satellite come to count, so that their noise is not felt
CALM = 0.1  # [m/s²] four times what the noise of a radar makes of the request


class Parameters(Following):
    """What is tuned."""

    headway: float = number(0.4, unit="s", title="Time headway", description="h, of the leader's speed", ge=0, le=5)
    standstill: float = number(4.0, unit="m", title="Standstill distance", description="r", ge=0, le=20)
    speed_gain: float = number(2.5, unit="1/s", title="Gain on the leader's speed", description="b", ge=0, le=5)
    gap_gain: float = number(0.3, unit="1/s²", title="Gain on the places", description="k", ge=0, le=5)
    fallback_headway: float = number(1.6, unit="s", title="Headway without link", ge=0.1, le=5)


class Memory(NamedTuple):
    """The headway in force, what is asked of the car, and what is estimated of the car ahead."""

    headway: Annotated[float, "s"] = -1.0  # negative before the first tick
    beyond: Annotated[float, "m", "sum of how much too far behind all but the nearest it is"] = 0.0
    asked: Annotated[float, "m/s²", "last that was not 0"] = 0.0
    ahead: Annotated[Estimate, "1", "as studio/model/singer.py has it"] = singer.NOBODY


class Sees(NamedTuple):
    """What it sees: the radar's target, up to three cars ahead, and the leader as the last of all."""

    clock: Clock
    own: Own
    front: Annotated[Targets, "front_radar", 1]
    heard: Annotated[Inbox, "awareness", 4]


class Does(NamedTuple):
    """What it does."""

    command: Command


@compiled
def gap_to(own, message):
    """From the own front to the rear of a sender [m], by satellite, moved on by what it has driven since."""
    east, north = message.payload.x - own.gps_x, message.payload.y - own.gps_y
    return sqrt(east * east + north * north) + message.payload.speed * message.age - CAR


@compiled
def misplaced(p, h, v_0, own, heard):
    """How much too far behind those who are heard of the car is, but for the nearest [m], sum and number."""
    total, n = 0.0, 0
    for j in range(1, min(heard.count, PLACES)):
        if is_fresh(heard.message[j], p.timeout):
            total += gap_to(own, heard.message[j]) - (j + 1) * (p.standstill + h * v_0) - j * CAR
            n += 1
    return total, n


@compiled
def decide(parameters, memory, sees):
    """One tick."""
    p, own, front, heard, T = parameters, sees.own, sees.front.target[0], sees.heard, sees.clock.tick
    first, leader = heard.message[0], heard.message[max(heard.count, 1) - 1]
    is_behind = sees.front.count > 0
    ahead = singer.followed(memory.ahead, front.range, front.rate, own.acceleration, T) if is_behind else singer.NOBODY
    linked = is_fresh(first, p.timeout) and is_fresh(leader, p.timeout) and (not is_behind or is_sender(p, own, front, first))
    h = p.headway if memory.headway < 0.0 else approach(memory.headway, p.headway if linked else p.fallback_headway, HEADWAY_RATE * T)
    u, v_0 = p.cruise_gain * (own.set_speed - own.speed), leader.payload.speed
    total, n = misplaced(p, h, v_0, own, heard)
    beyond = memory.beyond + (total - memory.beyond) * T / (SLOW + T)
    if is_behind and linked:
        place = (ahead[0] - p.standstill - h * v_0 + beyond) / (n + 1)
        u = min(u, p.speed_gain * (v_0 - own.speed) + p.gap_gain * place)
    elif is_behind:
        u = min(u, alone(p.standstill, h, own, ahead[0], ahead[1], ahead[2]))
    command = calmed(min(max(u, -p.deceleration_max), p.acceleration_max), memory.asked, CALM)
    return Memory(h, beyond, memory.asked if command == 0.0 else command, ahead), Does(accelerate(command))
