"""Satellite receiver: position with a slow error, white noise and the shadow of buildings, and the heading of the way over ground.

The slow error of each axis is a Gauss-Markov process (studio/model/satellite.py), larger where buildings hide the sky; white noise comes
on top. The heading is that of the velocity over ground, whose noise is `speed_noise` each way: over speed it is an error of the angle, and
below 0.5 m/s the last heading is kept.

Presets: a plain receiver 1.5 to 3 m with correlation times from 10 s to half an hour, with corrections (DGNSS) 0.5 to 1 m, with carrier
phase (RTK) 0.02 m (ION, Navigation; P. D. Groves, Principles of GNSS, Inertial, and Multisensor Integrated Navigation Systems, 2013,
ch. 9 and 10). How much larger errors are between houses, and the delays, are estimated.
"""

from math import atan2, sqrt
from typing import Annotated, NamedTuple

from studio.compiled import inlined
from studio.kind.preset import Preset
from studio.kind.sensor import Sensor
from studio.kind.settings import number
from studio.model import satellite
from studio.world.passes.satellite import sky_over
from studio.world.view import draw_four, report

KIND = "sensor"
TITLE = "Satellite receiver with heading"
PLACE, SPEED = range(2)  # draws
SLOW = 0.5  # [m/s] below this the heading over ground says nothing


class Settings(Sensor):
    """How large its errors are."""

    drift: float = number(1.5, unit="m", title="Slow error", description="standard deviation under an open sky, each way", ge=0, le=100)
    correlation_time: float = number(60.0, unit="s", title="Correlation time", description="of the slow error", ge=0.1, le=100_000)
    noise: float = number(0.3, unit="m", title="White noise", description="standard deviation, each way", ge=0, le=100)
    canyon_factor: float = number(
        5.0, unit="1", title="Factor without sky", description="by how much the slow error is larger where buildings hide the whole sky",
        ge=1, le=100,
    )  # fmt: skip
    speed_noise: float = number(0.05, unit="m/s", title="Noise of the velocity", description="standard deviation, each way", ge=0, le=5)


SOURCE = "P. D. Groves, Principles of GNSS, 2013, ch. 9 and 10; delays and factors without sky estimated"
PRESETS = {
    "gnss": Preset("Plain receiver", SOURCE, {"delay": 0.1, "delay_variation": 0.02, "period": 0.1}),
    "dgnss": Preset("With corrections", SOURCE, {"drift": 0.7, "noise": 0.2, "delay": 0.1, "delay_variation": 0.02, "period": 0.1}),
    "rtk": Preset("With carrier phase", SOURCE, {
        "drift": 0.015, "correlation_time": 30.0, "noise": 0.01, "canyon_factor": 50.0, "speed_noise": 0.02, "delay": 0.05, "period": 0.05,
    }),
}  # fmt: skip


class Memory(NamedTuple):
    """The slow errors over their standard deviation, when they were so, and the heading that was told."""

    east: Annotated[float, "1"] = 0.0
    north: Annotated[float, "1"] = 0.0
    time: Annotated[float, "s"] = -1.0
    heading: Annotated[float, "rad"] = 0.0
    sky: Annotated[float, "1"] = 1.0


class Reading(NamedTuple):
    """Where it takes itself to be."""

    x: Annotated[float, "m", "east position of the centre of gravity, in the coordinates of the map"] = 0.0
    y: Annotated[float, "m", "north position, likewise"] = 0.0
    heading: Annotated[float, "rad", "of the way over ground, counter-clockwise from east"] = 0.0
    speed: Annotated[float, "m/s", "over ground"] = 0.0
    sigma: Annotated[float, "m", "standard deviation that it gives for its position, each way"] = 0.0


@inlined
def sky_of(view, me, memory):
    """Share of the sky that is open, as it was when it was looked at last."""
    if memory.time >= 0.0 and not satellite.looks_up(memory.time, view.time, view.entity[me.unit]):
        return memory.sky
    return sky_over(view.shadow, view.place_of[me.world], me.x, me.y)


@inlined
def course(memory, east, north):
    """The heading over ground, and the speed."""
    speed = sqrt(east * east + north * north)
    return (atan2(north, east) if speed > SLOW else memory.heading), speed


@inlined
def measure(view, me, settings, memory, out):
    """A position; at the first look the slow error is drawn as if it had long been running."""
    phi = satellite.kept(view.time - memory.time, settings.correlation_time) if memory.time >= 0.0 else 0.0
    a, b, c, d = draw_four(view, me, PLACE)
    e, f, _, _ = draw_four(view, me, SPEED)
    z_east, z_north = satellite.drift(memory.east, phi, a), satellite.drift(memory.north, phi, b)
    sky = sky_of(view, me, memory)
    sigma = satellite.spread(settings.drift, settings.canyon_factor, sky)
    x = me.x + sigma * z_east + settings.noise * c
    y = me.y + sigma * z_north + settings.noise * d
    east = me.speed * me.cosine + settings.speed_noise * e
    north = me.speed * me.sine + settings.speed_noise * f
    heading, speed = course(memory, east, north)
    report(out, me, 0, Reading(x, y, heading, speed, sqrt(sigma * sigma + settings.noise * settings.noise)))
    return 1, Memory(z_east, z_north, view.time, heading, sky)
