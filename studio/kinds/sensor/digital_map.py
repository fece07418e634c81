"""Digital map: what a map unit tells of the road where it takes the car to be, as wrong as its position is.

The position is that of the car's satellite receiver (`gps` of the vehicle). Its error along the road moves the place on it, and its error
across the lane that the car is taken to be in, when it is larger than half a lane. The map itself is right. How good the receiver is under
the sky that it has, `sigma`, it knows and tells; a single error it does not know.
"""

from math import cos, floor, sin, sqrt
from typing import Annotated, NamedTuple

from studio.compiled import inlined
from studio.kind.preset import Preset
from studio.kind.sensor import Sensor
from studio.model.satellite import spread
from studio.road.ways.path import PATH_HEADING, PATH_SPACING
from studio.world.table.chart import JUNCTION, LANE_WIDTH, LANES_LEFT, LANES_RIGHT, LIMIT
from studio.world.table.mind import OFFSET, STATION
from studio.world.table.unit import CANYON, DRIFT_SIGMA, GPS_SIGMA, OWN_X, OWN_Y, SKY
from studio.world.view import report

KIND = "sensor"
TITLE = "Digital map"


class Settings(Sensor):
    """When it tells; what it tells is as wrong as the position."""


PRESETS = {"series": Preset("Map unit", "10 Hz, 0.1 s late: estimated, as usual with a plain receiver", {"delay": 0.1, "period": 0.1})}


class Reading(NamedTuple):
    """The road at the place where the car is taken to be."""

    lanes_left: Annotated[float, "1", "lanes of the same direction to the left of the own one"] = 0.0
    lanes_right: Annotated[float, "1", "lanes of the same direction to the right of the own one"] = 0.0
    width: Annotated[float, "m", "of the own lane"] = 0.0
    junction: Annotated[float, "m", "to the next junction on the own way, 0 within one, 1e6 where none comes"] = 0.0
    limit: Annotated[float, "m/s", "speed that is allowed there"] = 0.0
    heading: Annotated[float, "rad", "of the road there, along the own way, counter-clockwise from east"] = 0.0
    sigma: Annotated[float, "m", "standard deviation of the position that it goes by, each way"] = 0.0


@inlined
def sigma_of(view, v):
    """Standard deviation [m] of the satellite position: of its slow error under the sky that it has, and of its noise."""
    slow = spread(view.receiver[DRIFT_SIGMA, v], view.receiver[CANYON, v], view.satellite[SKY, v])
    return sqrt(slow * slow + view.receiver[GPS_SIGMA, v] * view.receiver[GPS_SIGMA, v])


@inlined
def measure(view, me, settings, memory, out):
    """The map where the car takes itself to be; a station has no way."""
    v = me.vehicle
    if v < 0:
        return 0
    first, end = view.path_first[v], view.path_first[v] + view.path_count[v] - 1
    true = min(first + int(max(view.mind[STATION, v], 0.0) / PATH_SPACING), end)
    east, north = view.unit[OWN_X, me.unit] - me.x, view.unit[OWN_Y, me.unit] - me.y
    c, s = cos(view.points[PATH_HEADING, true]), sin(view.points[PATH_HEADING, true])
    station = view.mind[STATION, v] + east * c + north * s
    here = min(first + int(max(station, 0.0) / PATH_SPACING), end)
    left, right, width = view.chart[LANES_LEFT, here], view.chart[LANES_RIGHT, here], view.chart[LANE_WIDTH, here]
    aside = view.mind[OFFSET, v] + north * c - east * s
    moved = min(max(floor(aside / width + 0.5), -right), left) if width > 0.0 else 0.0
    report(
        out, me, 0,
        Reading(
            left - moved, right + moved, width, view.chart[JUNCTION, here], view.chart[LIMIT, here],
            view.points[PATH_HEADING, here], sigma_of(view, v),
        ),
    )  # fmt: skip
    return 1
