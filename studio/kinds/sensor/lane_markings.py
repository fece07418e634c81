"""Lane markings: the own lane as a camera reports it, by the distances to its left and right edge, heading and curvature.

The lane is that of the car's path, with the width that the map gives; within junctions nothing is marked, and nothing is reported. Seen is
the lane up to `look_ahead`, or to the next junction. Noise as of series cameras: 0.05 to 0.1 m, 0.2 to 0.3 °, 30 Hz, 0.08 to 0.12 s,
40 to 80 m (J. C. McCall, M. M. Trivedi, Video-based lane estimation, IEEE Trans. ITS 7 (2006) 20; rounded, the curvature is estimated).
"""

from typing import Annotated, NamedTuple

from studio.compiled import inlined
from studio.kind.preset import Preset
from studio.kind.sensor import Sensor
from studio.kind.settings import number
from studio.road.ways.path import PATH_CURVATURE, PATH_SPACING
from studio.world.table.chart import BENT, JUNCTION, LANE_WIDTH
from studio.world.table.mind import D_PSI, OFFSET, STATION
from studio.world.view import draw_four, report

KIND = "sensor"
TITLE = "Lane markings by camera"
NOISE = 0  # draws


class Settings(Sensor):
    """How far it sees, and how well."""

    look_ahead: float = number(60.0, unit="m", title="Look-ahead", description="as far as the lane is seen", ge=1, le=200)
    noise: float = number(0.05, unit="m", title="Noise of the distances", description="standard deviation", ge=0, le=2)
    heading_noise: float = number(0.004, unit="rad", title="Noise of the heading", description="standard deviation", ge=0, le=0.5)
    curvature_noise: float = number(0.0001, unit="1/m", title="Noise of the curvature", description="standard deviation", ge=0, le=0.1)


PRESETS = {
    "camera": Preset(
        "Series camera", "J. C. McCall, M. M. Trivedi 2006; rounded", {"delay": 0.1, "delay_variation": 0.01, "period": 0.033}
    ),
}


class Reading(NamedTuple):
    """The own lane."""

    left: Annotated[float, "m", "from the middle of the car to the left edge of its lane"] = 0.0
    right: Annotated[float, "m", "from the middle of the car to the right edge"] = 0.0
    heading: Annotated[float, "rad", "of the car against the lane at its front axle, left positive"] = 0.0
    curvature: Annotated[float, "1/m", "of the lane, mean over what is seen of it, left positive"] = 0.0
    look_ahead: Annotated[float, "m", "how far the lane is seen"] = 0.0


@inlined
def mean_curvature(view, first, last):
    """Of the path [1/m] from one point to another, both counted."""
    bent = view.chart[BENT, last] - view.chart[BENT, first] + view.points[PATH_CURVATURE, first]
    return bent / (last - first + 1)


@inlined
def measure(view, me, settings, memory, out):
    """The lane at one tick; a station has none."""
    v = me.vehicle
    if v < 0:
        return 0
    end = view.path_first[v] + view.path_count[v] - 1
    here = min(view.path_first[v] + int(max(view.mind[STATION, v], 0.0) / PATH_SPACING), end)
    ahead, half = min(settings.look_ahead, view.chart[JUNCTION, here]), 0.5 * view.chart[LANE_WIDTH, here]
    if ahead <= 0.0:
        return 0
    aside, end = view.mind[OFFSET, v], min(here + int(ahead / PATH_SPACING), end)
    a, b, c, d = draw_four(view, me, NOISE)
    report(
        out, me, 0,
        Reading(
            half - aside + settings.noise * a,
            half + aside + settings.noise * b,
            view.mind[D_PSI, v] + settings.heading_noise * c,
            mean_curvature(view, here, end) + settings.curvature_noise * d,
            ahead,
        ),
    )  # fmt: skip
    return 1
