"""Cooperative adaptive cruise control: the car ahead tells what it is about to do.

    h du/dt = -u + k_p e + k_d de/dt + u_ahead(t - theta),    e = d - (r + h v)

J. Ploeg, N. van de Wouw, H. Nijmeijer, Lp string stability of cascaded systems, IEEE Trans. Control Systems Technology
22 (2014) 786, Eqs. 5 to 9; gains of their test cars. The feed-forward is the acceleration that the car ahead has REQUESTED:
with the measured one a CAM carries, no headway below 1 s is string stable even without delay.

What is told counts only while its sender is the car that the radar sees: the way to where the message says that it is must be the radar's
range and a car's length, within `match`. Of several who are listened to it is the one that fits best, so that a platoon closes up behind
whoever is ahead when one leaves it or joins. Of a stranger who has cut in between nothing is known but what the radar sees.

When the link is silent for longer than `timeout`, or a stranger is ahead, the acceleration ahead is estimated from the radar
(studio/model/singer.py), and the headway rises to `degraded_headway`: degraded, with grace (J. Ploeg et al., IEEE Trans. ITS 16 (2015)
488). With `estimates` off nothing is fed forward: what is left is an ACC, whose headway is `fallback_headway`. Without feed-forward no
headway below sqrt(2/k_p) is string stable, 3.16 s with these gains; with the estimate it is 1.1 to 1.45 s for drives that lag by 0.1 to
0.5 s (tests/application/test_string_stability.py). The headway in force moves by 0.1 s in a second, so that losing the link is no jolt;
so does one that the script tunes: from 0.6 s to 1.6 s it takes ten seconds.

Noise of the radar must not make the car change between drive and brakes: a request of the other sign is none until it is worth `CALM`.
"""

from math import sqrt
from typing import Annotated, NamedTuple

from pydantic import Field

from studio.application.contract import ACCELERATION, Clock, Command, Inbox, Own, Targets, accelerate
from studio.compiled import compiled
from studio.kind.settings import Part, number
from studio.model import singer

KIND = "application"
TITLE = "Cooperative adaptive cruise control (Ploeg)"
COMMANDS = ACCELERATION


class Following(Part):
    """What every law of a platoon has, besides its own gains: when it trusts what it hears, and how it drives with nobody ahead."""

    timeout: float = number(0.5, unit="s", title="Link time-out", description="age after which a message is not trusted", gt=0, le=5)
    match: float = number(
        8.0, unit="m", title="Match", description="between where the sender is and where the radar sees the car ahead", gt=0, le=1000
    )
    cruise_gain: float = number(0.5, unit="1/s", title="Cruise gain", description="on the set speed, road free", gt=0, le=3)
    acceleration_max: float = number(2.0, unit="m/s²", title="Strongest acceleration", gt=0, le=5)
    deceleration_max: float = number(8.0, unit="m/s²", title="Strongest deceleration", gt=0, le=10)


class Parameters(Following):
    """What is tuned."""

    headway: float = number(0.6, unit="s", title="Time headway", description="h", ge=0.1, le=5)
    standstill: float = number(2.5, unit="m", title="Standstill distance", description="r", ge=0, le=20)
    k_p: float = number(0.2, unit="1/s²", title="Gain on the gap", description="k_p", ge=0, le=5)
    k_d: float = number(0.7, unit="1/s", title="Gain on its change", description="k_d", ge=0, le=5)
    estimates: bool = Field(True, title="Estimates", description="the acceleration ahead by radar, where no message tells it")
    degraded_headway: float = number(
        1.6, unit="s", title="Headway without link", description="while the acceleration ahead is estimated", ge=0.1, le=5
    )
    fallback_headway: float = number(
        3.2, unit="s", title="Headway of the radar alone", description="without link and without estimate", ge=0.1, le=5
    )


Estimate = tuple[float, float, float, float, float, float, float, float, float]


class Memory(NamedTuple):
    """The request, which integrates, the headway in force, what is asked of the car, and what is estimated of the car ahead."""

    u: Annotated[float, "m/s²"] = 0.0
    headway: Annotated[float, "s"] = -1.0  # negative before the first tick
    asked: Annotated[float, "m/s²", "last that was not 0"] = 0.0
    ahead: Annotated[Estimate, "1", "as studio/model/singer.py has it"] = singer.NOBODY


class Sees(NamedTuple):
    """What it sees: the radar's target, and the cars that it listens to."""

    clock: Clock
    own: Own
    front: Annotated[Targets, "front_radar", 1]
    heard: Annotated[Inbox, "awareness", 4]


class Log(NamedTuple):
    """What is recorded."""

    linked: Annotated[float, "1", "1 while a message of the car ahead counts"] = 0.0
    headway: Annotated[float, "s", "in force"] = 0.0
    ahead: Annotated[float, "m/s²", "acceleration of the car ahead that is fed forward"] = 0.0


class Does(NamedTuple):
    """What it does."""

    command: Command
    log: Log


CAR = 4.5  # [m] from the middle of one car to its rear, and from the front of the next to its middle
CALM = 0.01  # [m/s²] twice what the noise of a radar makes of the request
HEADWAY_RATE = 0.1  # [s/s] how fast the headway in force moves to the wanted one, so that losing the link is no jolt


@compiled
def approach(value, target, change):
    """`value` moved towards `target` by at most `change`."""
    return value + min(max(target - value, -change), change)


@compiled
def lagged(p, h, u, u_ahead, own, front, T):
    """The request [m/s²] after a tick T [s], of the lag h: backward Euler, whose lag at low frequencies is h itself."""
    e = front.range - (p.standstill + h * own.speed)
    de = front.rate - h * own.acceleration
    return (h * u + T * (p.k_p * e + p.k_d * de + u_ahead)) / (h + T)


@compiled
def mismatch(own, front, message):
    """By how much [m] the car that the radar sees is farther or nearer than the sender of a message says that it is."""
    east, north = message.payload.x - own.gps_x, message.payload.y - own.gps_y
    told = sqrt(east * east + north * north) + message.payload.speed * message.age
    return abs(told - front.range - CAR)


@compiled
def is_sender(p, own, front, message):
    """Whether the car that the radar sees is the one that has sent the message."""
    return mismatch(own, front, message) <= p.match


@compiled
def sender_of(p, own, front, is_behind, heard):
    """Which of those heard lately the radar sees: the one that fits best; with nobody ahead the first; -1 for none."""
    best, least = -1, p.match
    for i in range(heard.count):
        message = heard.message[i]
        if message.received and message.age <= p.timeout:
            off = mismatch(own, front, message) if is_behind else 0.0
            if off < least or (off <= least and best < 0):
                best, least = i, off
    return best


@compiled
def calmed(u, asked, calm):
    """What is asked of the car [m/s²], which must not change between drive and brakes for less than `calm` [m/s²]."""
    return 0.0 if u * asked < 0.0 and abs(u) < calm else u


@compiled
def decide(parameters, memory, sees):
    """One tick."""
    p, own, front, T = parameters, sees.own, sees.front.target[0], sees.clock.tick
    is_behind = sees.front.count > 0
    ahead = singer.followed(memory.ahead, front.range, front.rate, own.acceleration, T) if is_behind else singer.NOBODY
    i = sender_of(p, own, front, is_behind, sees.heard)
    linked, message = i >= 0, sees.heard.message[max(i, 0)]
    wanted = p.headway if linked else p.degraded_headway if p.estimates else p.fallback_headway
    h = p.headway if memory.headway < 0.0 else approach(memory.headway, wanted, HEADWAY_RATE * T)
    u_ahead = message.payload.intention if linked else ahead[2] if p.estimates else 0.0
    u_cruise = p.cruise_gain * (own.set_speed - own.speed)
    u = min(lagged(p, h, memory.u, u_ahead, own, front, T), u_cruise) if is_behind else u_cruise
    u = min(max(u, -p.deceleration_max), p.acceleration_max)
    command = calmed(u, memory.asked, CALM)
    does = Does(accelerate(command), Log(1.0 if linked else 0.0, h, u_ahead if is_behind else 0.0))
    return Memory(u, h, memory.asked if command == 0.0 else command, ahead), does
