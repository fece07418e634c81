"""Odometry: the way since the start, by wheel speeds and a yaw rate sensor, whose errors add up.

    s += (1 + k) v dt,   psi += (r + b + n) dt,   x += ds cos(psi),   y += ds sin(psi)

k is the error of the scale (tyre radius), drawn once; b the offset of the yaw rate sensor, drawn once; n its white noise. Errors of 1 to
2 % of the distance are usual (the scale), 0.1 °/s the offset of a series sensor that has been calibrated at rest (estimated).
"""

from math import cos, sin, sqrt
from typing import Annotated, NamedTuple

from studio.compiled import inlined
from studio.kind.sensor import Sensor
from studio.kind.settings import number
from studio.model.random import normal
from studio.world.view import draw_normal, report

KIND = "sensor"
TITLE = "Odometry"
SCALE, OFFSET, YAW = range(3)  # draws
ONCE = 0  # what is drawn once for the run is drawn as at the first tick


class Settings(Sensor):
    """How large its errors are."""

    scale_error: float = number(0.01, unit="1", title="Error of the scale", description="standard deviation; drawn once", ge=0, le=0.2)
    yaw_offset: float = number(
        0.0017, unit="rad/s", title="Offset of the yaw rate", description="standard deviation; drawn once", ge=0, le=0.1
    )
    yaw_noise: float = number(0.002, unit="rad/s", title="Noise of the yaw rate", description="standard deviation at a tick", ge=0, le=0.5)


class Memory(NamedTuple):
    """The way so far."""

    time: Annotated[float, "s"] = -1.0
    distance: Annotated[float, "m"] = 0.0
    x: Annotated[float, "m"] = 0.0
    y: Annotated[float, "m"] = 0.0
    heading: Annotated[float, "rad"] = 0.0


class Reading(NamedTuple):
    """The way since the start, from the place and along the heading of the start."""

    distance: Annotated[float, "m", "driven"] = 0.0
    x: Annotated[float, "m", "ahead of the start"] = 0.0
    y: Annotated[float, "m", "to the left of the start"] = 0.0
    heading: Annotated[float, "rad", "against that of the start, left positive"] = 0.0


@inlined
def once(view, me, draw):
    """A number of the standard normal distribution that stays the same for the run."""
    return normal(view.seed[me.world], view.entity[me.unit], me.stream + draw, ONCE, 1)


@inlined
def measure(view, me, settings, memory, out):
    """One step further, with the speed and yaw rate of now since the last look."""
    dt = view.time - memory.time if memory.time >= 0.0 else 0.0
    ds = (1.0 + settings.scale_error * once(view, me, SCALE)) * me.speed * dt
    rate = me.yaw_rate + settings.yaw_offset * once(view, me, OFFSET)
    turned = rate * dt + settings.yaw_noise * draw_normal(view, me, YAW) * sqrt(dt * view.tick)
    heading = memory.heading + turned
    x, y = memory.x + ds * cos(heading - 0.5 * turned), memory.y + ds * sin(heading - 0.5 * turned)
    report(out, me, 0, Reading(memory.distance + abs(ds), x, y, heading))
    return 1, Memory(view.time, memory.distance + abs(ds), x, y, heading)
