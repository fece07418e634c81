"""Adaptive cruise control: keeps a time gap with the own radar alone.

    u = -((v - v_p) + lambda (h v + r - d))/h        R. Rajamani, Vehicle Dynamics and Control, 2nd ed., Eq. 6.18

v_p speed of the car ahead, d measured gap, h headway, r standstill distance. With a drive of time constant tau it is
string stable only for h >= 2 tau (Rajamani, section 6.6).

An error of the gap dies away in the time 1/lambda, whatever h and whoever brakes ahead: put u in and h v + r - d obeys e' = -lambda e. Who
starts nearer than h v + r stays too near for so long, and with a longer h starts with the greater error: a run that is to measure the law
starts at the gap that it keeps.

What is asked of the car may follow u slowly, for comfort and because tracking a target takes time: u_f' = (u - u_f)/T, which is a
drive that is slower by T.
"""

from typing import Annotated, NamedTuple

from pydantic import BaseModel, ConfigDict, Field

from studio.application.contract import ACCELERATION, Clock, Command, Own, Targets, accelerate
from studio.compiled import compiled
from studio.kind.preset import Preset

KIND = "application"
TITLE = "Adaptive cruise control (radar only)"
COMMANDS = ACCELERATION


class Parameters(BaseModel):
    """What is tuned."""

    model_config = ConfigDict(extra="forbid")

    headway: float = Field(1.2, ge=0.2, le=5.0, title="Time headway", description="h", json_schema_extra={"unit": "s"})
    standstill: float = Field(2.0, ge=0.0, le=20.0, title="Standstill distance", description="r", json_schema_extra={"unit": "m"})
    gap_gain: float = Field(
        0.1, gt=0.0, le=2.0, title="Gap gain", description="lambda; an error of the gap dies away in 1/lambda",
        json_schema_extra={"unit": "1/s"},
    )  # fmt: skip
    cruise_gain: float = Field(
        0.5, gt=0.0, le=3.0, title="Cruise gain", description="on the set speed, road free", json_schema_extra={"unit": "1/s"}
    )
    acceleration_max: float = Field(2.0, gt=0.0, le=5.0, title="Strongest acceleration", json_schema_extra={"unit": "m/s²"})
    deceleration_max: float = Field(8.0, gt=0.0, le=10.0, title="Strongest deceleration", json_schema_extra={"unit": "m/s²"})
    response_time: float = Field(
        0.0, ge=0.0, le=3.0, title="Response time", description="T, of the first-order lag of what is asked; 0 for none",
        json_schema_extra={"unit": "s"},
    )  # fmt: skip


OPENACC = (
    "estimated with front_radar's preset series_acc_radar, so that lag and gain from car to car are those of eleven series cars in "
    "OpenACC (JRC, ZalaZONE 2019; M. Makridis et al., TR-C 125 (2021) 103047): lag 1.3 to 1.9 s, gain 1.1 to 1.35 at time gaps of "
    "1.3 to 1.8 s, 0.9 to 1.05 at 2.3 to 2.6 s"
)
PRESETS = {
    "series": Preset("Series ACC", OPENACC, {"headway": 1.3, "gap_gain": 0.55, "response_time": 0.51, "deceleration_max": 3.5}),
}


class Memory(NamedTuple):
    """Nothing is remembered but the last request [m/s²]."""

    u: Annotated[float, "m/s²"] = 0.0


class Sees(NamedTuple):
    """What it sees."""

    clock: Clock
    own: Own
    front: Annotated[Targets, "front_radar", 1]


class Does(NamedTuple):
    """What it does."""

    command: Command


@compiled
def cruise(gain, v_set, v):
    """Acceleration [m/s²] towards the set speed [m/s]."""
    return gain * (v_set - v)


@compiled
def keep_gap(p, v, front):
    """Acceleration [m/s²] behind the target (Eq. 6.18); the target's speed is v + range rate."""
    spacing_error = p.headway * v + p.standstill - front.range
    return -(-front.rate + p.gap_gain * spacing_error) / p.headway


@compiled
def smoothed(T, u, before, tick):
    """The request after a tick [s] of the first-order lag: backward Euler, so that no T is too short for the tick."""
    return u if T <= 0.0 else before + (u - before) * tick / (T + tick)


@compiled
def decide(parameters, memory, sees):
    """One tick."""
    p, own = parameters, sees.own
    u = cruise(p.cruise_gain, own.set_speed, own.speed)
    if sees.front.count > 0:
        u = min(u, keep_gap(p, own.speed, sees.front.target[0]))
    u = smoothed(p.response_time, min(max(u, -p.deceleration_max), p.acceleration_max), memory.u, sees.clock.tick)
    return Memory(u), Does(accelerate(u))
