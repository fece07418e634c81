"""A vehicle is steered along a line on the ground, whatever its route; its pedals stay with application or driver.

It steers for a point of the line ahead of it: the arc through that point (R. C. Coulter, Implementation of the pure pursuit path tracking
algorithm, CMU-RI-TR-92-01, 1992), seen from between the axles.
"""

from math import atan, cos, sin, sqrt
from typing import Annotated

from pydantic import Field

from studio.compiled import compiled
from studio.kind.settings import Part, Pooled, VehicleName, number
from studio.world.maneuver import WHEEL, over, steer

KIND = "action"
TITLE = "Follow a line"
TAKES = WHEEL
NEAREST = 3.0  # [m] the point that is steered for is at least so far away
ARRIVAL = 1.0  # [m] before its end the line is followed
Corner = Annotated[tuple[float, float], Field(json_schema_extra={"unit": "m"})]


class Settings(Part):
    """Who, and the line."""

    vehicle: VehicleName = Field(..., title="Vehicle")
    line: Annotated[list[Corner], Pooled()] = Field(
        [(0.0, 0.0), (100.0, 0.0)], min_length=2, max_length=1000, title="Line", description="its corners, east and north on the map"
    )
    preview: float = number(0.8, unit="s", title="Preview", description="how far ahead it steers for, at its speed", ge=0.2, le=5)


@compiled
def nearest(first, count, x, y, pool):
    """Segment and share of it that are nearest to a place [m]."""
    best, at, share = 1e30, first, 0.0
    for i in range(first, first + count - 1):
        dx, dy = pool[0, i + 1] - pool[0, i], pool[1, i + 1] - pool[1, i]
        squared = max(dx * dx + dy * dy, 1e-12)
        u = min(max(((x - pool[0, i]) * dx + (y - pool[1, i]) * dy) / squared, 0.0), 1.0)
        away = (pool[0, i] + u * dx - x) ** 2 + (pool[1, i] + u * dy - y) ** 2
        if away < best:
            best, at, share = away, i, u
    return at, share


@compiled
def ahead(first, count, at, share, distance, pool):
    """The point of the line that is a distance [m] beyond one of its places, its last one at most; how far it is along the line."""
    left = distance
    for i in range(at, first + count - 1):
        dx, dy = pool[0, i + 1] - pool[0, i], pool[1, i + 1] - pool[1, i]
        length, begin = sqrt(dx * dx + dy * dy), share if i == at else 0.0
        if left <= (1.0 - begin) * length:
            u = begin + left / max(length, 1e-9)
            return pool[0, i] + u * dx, pool[1, i] + u * dy, distance
        left -= (1.0 - begin) * length
    return pool[0, first + count - 1], pool[1, first + count - 1], distance - left


@compiled
def act(settings, sees):
    """Over at the end of the line."""
    first, count = int(settings.line[0]), int(settings.line[1])
    at, share = nearest(first, count, sees.x, sees.y, sees.pool)
    x, y, far = ahead(first, count, at, share, max(settings.preview * sees.speed, NEAREST), sees.pool)
    if far < ARRIVAL:
        return over()
    dx, dy = x - sees.x, y - sees.y
    aside = dy * cos(sees.heading) - dx * sin(sees.heading)
    return steer(atan(sees.wheelbase * 2.0 * aside / max(dx * dx + dy * dy, 1.0)))


def told(settings):
    """In words."""
    return f"follow a line of {len(settings.line)} points"
