"""The contract of a driver, on one page.

A driver is a file with

    KIND         "driver"
    TITLE        one line for people
    Settings     what such a driver is like: a `Driver`, with settings of its own where it needs some
    decide       decide(settings, sees) -> Wish, with `@compiled` above it

`decide` is asked at every tick, for every vehicle that has such a driver. It gets the settings and what the driver sees as NamedTuples
of plain numbers, and says what the driver wants of pedals and steering wheel. It keeps nothing, so that a run can be repeated, cut and
batched. Who the driver minds on the road is found before: the settings of `Driver` are used for that.
"""

from math import inf
from typing import Annotated, NamedTuple

from studio.kind.settings import Part, number


class Driver(Part):
    """What every driver has: how hurried and how careful he is."""

    acceleration: float = number(1.4, unit="m/s²", title="Comfortable acceleration", gt=0.1, le=5)
    deceleration: float = number(2.0, unit="m/s²", title="Comfortable deceleration", gt=0.1, le=8)
    time_headway: float = number(1.2, unit="s", title="Wanted headway", ge=0.3, le=5)
    standstill_gap: float = number(2.0, unit="m", title="Gap at rest", ge=0.5, le=10)
    speed_factor: float = number(1.0, unit="1", title="Wanted over permitted speed", ge=0.3, le=1.5)


class Sees(NamedTuple):
    """What a driver knows at a tick. What is not there is infinitely far away."""

    speed: Annotated[float, "m/s"] = 0.0  # own
    yaw_rate: Annotated[float, "rad/s"] = 0.0  # own, left positive
    desired_speed: Annotated[float, "m/s"] = 0.0  # that limits, bends and sight permit, times the own speed factor
    ahead_gap: Annotated[float, "m"] = inf  # bumper to bumper, to the vehicle or object ahead that asks most
    ahead_speed: Annotated[float, "m/s"] = 0.0  # of the same; for one who crosses ahead, that with which one comes when he is gone
    first_gap: Annotated[float, "m"] = inf  # to the car that goes first at a merge or crossing, as if it drove ahead already
    first_speed: Annotated[float, "m/s"] = 0.0  # of the same
    stop_distance: Annotated[float, "m"] = inf  # from the front bumper to the next line where a light or those who go first ask for a stop
    offset: Annotated[float, "m"] = 0.0  # of the front axle from the path, left positive
    heading: Annotated[float, "rad"] = 0.0  # of the car minus that of the path at the front axle
    curvature: Annotated[float, "1/m"] = 0.0  # of the path where the car will be in a moment, left positive
    compliance: Annotated[float, "rad s²/m"] = 0.0  # slip angle of the front axle per lateral acceleration
    steering_max: Annotated[float, "rad"] = 0.0  # largest road wheel angle
    steering_rate: Annotated[float, "rad/s"] = 0.4  # fastest change of it
    wheelbase: Annotated[float, "m"] = 2.7
    understeer: Annotated[float, "rad s²/m"] = 0.0  # slip angle of the front axle less that of the rear one, per lateral acceleration
    sideways: Annotated[float, "m/s"] = 0.0  # speed of the front axle to the left of where the car points


class Wish(NamedTuple):
    """What a driver wants."""

    acceleration: Annotated[float, "m/s²"] = 0.0  # forward
    steering: Annotated[float, "rad"] = 0.0  # road wheel angle, left positive
