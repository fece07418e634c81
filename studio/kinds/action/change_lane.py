"""A vehicle goes over to a line beside its path, a lane to the left for instance, drives along it, and comes back at the end.

The way aside is the quintic of minimum jerk (T. Flash, N. Hogan, The coordination of arm movements, 1985): from 0 to 1 over the time it
takes, 10 u³ - 15 u⁴ + 6 u⁵. It is followed with the curvature that it and the path have, and feedback of offset and heading with poles at
-omega: kappa = kappa_path + y''/v² - 2 omega/v (e_psi - y'/v) - omega²/v² (e - y). Whoever is ahead on its path is minded as before.
"""

from math import atan

from pydantic import Field

from studio.compiled import compiled
from studio.kind.settings import Part, VehicleName, number
from studio.world.condition import ROUNDING
from studio.world.maneuver import WHEEL, over, steer

KIND = "action"
TITLE = "Change the lane"
TAKES = WHEEL
OMEGA = 1.2  # [1/s] both poles of the error
SLOWEST = 3.0  # [m/s] a slower car is steered as if it drove so fast
SHARPEST = 0.2  # [1/m]


class Settings(Part):
    """Who, how far aside, how quickly, and for how long."""

    vehicle: VehicleName = Field(..., title="Vehicle")
    offset: float = number(3.5, unit="m", title="Offset", description="from its path, to the left; a lane is 3 to 3.75 m", ge=-15, le=15)
    time: float = number(4.0, unit="s", title="Time to go over", ge=1, le=30)
    duration: float = number(3600.0, unit="s", title="Duration", description="until it is back on its path", gt=0, le=3600)


@compiled
def aside(time, T):
    """Of a way of 1 m that takes the time T [s]: place, speed and acceleration at a time [s]."""
    u = min(max(time / T, 0.0), 1.0)
    dy, ddy = 30.0 * u * u * (1.0 - 2.0 * u + u * u), 60.0 * u * (1.0 - 3.0 * u + 2.0 * u * u)
    return u * u * u * (10.0 - 15.0 * u + 6.0 * u * u), dy / T, ddy / (T * T)


@compiled
def act(settings, sees):
    """Over with its duration, at the end of which it goes back."""
    if sees.elapsed >= settings.duration - ROUNDING:
        return over()
    T, v = min(settings.time, 0.5 * settings.duration), max(sees.speed, SLOWEST)
    out, back = aside(sees.elapsed, T), aside(sees.elapsed - (settings.duration - T), T)
    y, dy, ddy = settings.offset * (out[0] - back[0]), settings.offset * (out[1] - back[1]), settings.offset * (out[2] - back[2])
    error = 2.0 * OMEGA / v * (sees.heading_error - dy / v) + OMEGA * OMEGA / (v * v) * (sees.offset - y)
    kappa = min(max(sees.path_curvature + ddy / (v * v) - error, -SHARPEST), SHARPEST)
    return steer(atan(sees.wheelbase * kappa))


def told(settings):
    """In words."""
    return f"go over by {settings.offset:g} m"
