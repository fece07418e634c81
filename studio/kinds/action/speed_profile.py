"""A vehicle drives a profile of speeds over time, for instance one that was measured: straight lines between its points.

The acceleration that it asks for is the slope of the profile, and what takes back the difference between the profile and its own speed
within a second. So it lags by what its engine and brakes need, and its speed does not drift away.
"""

from itertools import pairwise
from typing import Annotated

from pydantic import Field, model_validator

from studio.compiled import compiled
from studio.kind.settings import Part, Pooled, VehicleName
from studio.world.condition import ROUNDING
from studio.world.maneuver import PEDALS, drive, over

KIND = "action"
TITLE = "Drive a profile of speeds"
TAKES = PEDALS
GAIN = 1.0  # [1/s] acceleration for a missing speed
STAND = -0.5  # [m/s²] asked for where the profile stands still: the brakes hold
Point = Annotated[tuple[float, float], Field(json_schema_extra={"unit": "s, m/s"})]


class Settings(Part):
    """Who, and the profile."""

    vehicle: VehicleName = Field(..., title="Vehicle")
    points: Annotated[list[Point], Pooled()] = Field(
        [(0.0, 20.0), (10.0, 20.0)], min_length=2, max_length=20_000, title="Points", description="seconds since it began, speed [m/s]"
    )

    @model_validator(mode="after")
    def is_a_profile(self):
        times = [time for time, _ in self.points]
        if times[0] < 0.0 or any(later <= earlier for earlier, later in pairwise(times)):
            raise ValueError("the times of the points must begin at 0 s or later, and rise")
        if any(not 0.0 <= speed <= 70.0 for _, speed in self.points):
            raise ValueError("the speeds of the points must lie between 0 and 70 m/s")
        return self


@compiled
def place(time, first, count, pool):
    """The last point that a time [s] has come to, but for the very last."""
    low, high = first, first + count - 2
    while low < high:
        middle = (low + high + 1) // 2
        if pool[0, middle] <= time:
            low = middle
        else:
            high = middle - 1
    return low


@compiled
def act(settings, sees):
    """Over at the last point; before the first its speed is held."""
    first, count = int(settings.points[0]), int(settings.points[1])
    if sees.elapsed >= sees.pool[0, first + count - 1] - ROUNDING:
        return over()
    i = place(sees.elapsed, first, count, sees.pool)
    slope = (sees.pool[1, i + 1] - sees.pool[1, i]) / (sees.pool[0, i + 1] - sees.pool[0, i])
    since = sees.elapsed - sees.pool[0, i]
    slope = slope if since >= 0.0 else 0.0
    wanted = sees.pool[1, i] + slope * max(since, 0.0)
    return drive(slope + GAIN * (wanted - sees.speed) + (STAND if wanted == 0.0 and slope <= 0.0 else 0.0))


def told(settings):
    """In words."""
    return f"drive {len(settings.points)} speeds in {settings.points[-1][0]:g} s"


def fastest(settings):
    """What the vehicle must be able to drive [m/s]."""
    return max(speed for _, speed in settings.points)
