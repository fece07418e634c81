"""Cooperative adaptive cruise control: the car ahead tells what it is about to do.

    h du/dt = -u + k_p e + k_d de/dt + u_ahead(t - theta),    e = d - (r + h v)

J. Ploeg, N. van de Wouw, H. Nijmeijer, Lp string stability of cascaded systems, IEEE Trans. Control Systems Technology
22 (2014) 786, Eqs. 5 to 9; gains of their test cars. The feed-forward is the acceleration that the car ahead has REQUESTED:
with the measured one a CAM carries, no headway below 1 s is string stable even without delay.

When the link is silent for longer than `timeout`, the feed-forward is dropped and the headway rises to
`fallback_headway`: what is left is an ACC, and an ACC needs the longer gap. The headway in force moves by 0.1 s in a second, so that
losing the link is no jolt; so does one that the script tunes: from 0.6 s to 1.6 s it takes ten seconds.
"""

from typing import Annotated, NamedTuple

from pydantic import BaseModel, ConfigDict, Field

from studio.application.contract import ACCELERATION, Clock, Command, Inbox, Own, Targets, accelerate
from studio.compiled import compiled

KIND = "application"
TITLE = "Cooperative adaptive cruise control (Ploeg)"
COMMANDS = ACCELERATION


class Parameters(BaseModel):
    """What is tuned."""

    model_config = ConfigDict(extra="forbid")

    headway: float = Field(0.6, ge=0.1, le=5.0, title="Time headway", description="h", json_schema_extra={"unit": "s"})
    standstill: float = Field(2.5, ge=0.0, le=20.0, title="Standstill distance", description="r", json_schema_extra={"unit": "m"})
    k_p: float = Field(0.2, ge=0.0, le=5.0, title="Gain on the gap", description="k_p", json_schema_extra={"unit": "1/s²"})
    k_d: float = Field(0.7, ge=0.0, le=5.0, title="Gain on its change", description="k_d", json_schema_extra={"unit": "1/s"})
    timeout: float = Field(
        0.5,
        gt=0.0,
        le=5.0,
        title="Link time-out",
        description="age of a message after which it is not trusted",
        json_schema_extra={"unit": "s"},
    )
    fallback_headway: float = Field(1.6, ge=0.1, le=5.0, title="Headway without link", json_schema_extra={"unit": "s"})
    cruise_gain: float = Field(
        0.5, gt=0.0, le=3.0, title="Cruise gain", description="on the set speed, road free", json_schema_extra={"unit": "1/s"}
    )
    acceleration_max: float = Field(2.0, gt=0.0, le=5.0, title="Strongest acceleration", json_schema_extra={"unit": "m/s²"})
    deceleration_max: float = Field(8.0, gt=0.0, le=10.0, title="Strongest deceleration", json_schema_extra={"unit": "m/s²"})


class Memory(NamedTuple):
    """The request, which integrates, and the headway in force."""

    u: Annotated[float, "m/s²"] = 0.0
    headway: Annotated[float, "s"] = -1.0  # negative before the first tick


class Sees(NamedTuple):
    """What it sees: the radar's target, and the car that it listens to."""

    clock: Clock
    own: Own
    front: Annotated[Targets, "front_radar", 1]
    heard: Annotated[Inbox, "awareness", 1]


class Does(NamedTuple):
    """What it does."""

    command: Command


HEADWAY_RATE = 0.1  # [s/s] how fast the headway in force moves to the wanted one, so that losing the link is no jolt


@compiled
def approach(value, target, change):
    """`value` moved towards `target` by at most `change`."""
    return value + min(max(target - value, -change), change)


@compiled
def ploeg_rate(p, h, u, u_ahead, own, front):
    """du/dt [m/s³]."""
    e = front.range - (p.standstill + h * own.speed)
    de = front.rate - h * own.acceleration
    return (-u + p.k_p * e + p.k_d * de + u_ahead) / h


@compiled
def decide(parameters, memory, sees):
    """One tick."""
    p, own, message = parameters, sees.own, sees.heard.message[0]
    linked = message.age <= p.timeout
    wanted = p.headway if linked else p.fallback_headway
    h = p.headway if memory.headway < 0.0 else approach(memory.headway, wanted, HEADWAY_RATE * sees.clock.tick)
    u_ahead = message.payload.intention if linked and message.received else 0.0
    u_cruise = p.cruise_gain * (own.set_speed - own.speed)
    if sees.front.count > 0:
        u = memory.u + sees.clock.tick * ploeg_rate(p, h, memory.u, u_ahead, own, sees.front.target[0])
        u = min(u, u_cruise)
    else:
        u = u_cruise
    u = min(max(u, -p.deceleration_max), p.acceleration_max)
    return Memory(u, h), Does(accelerate(u))
