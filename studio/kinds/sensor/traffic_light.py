"""Traffic light: what the next light on the own way shows, and how far its stop line is, as a camera that reads lights reports it.

A light may be misread at a look; it is then reported as dark, and the noise of the distance grows with it. Reach and rate as of series
cameras, how often a light is misread is estimated.
"""

from typing import Annotated, NamedTuple

from studio.compiled import inlined
from studio.kind.sensor import Sensor
from studio.kind.settings import number
from studio.model.sight import grown
from studio.road.network.signals import AMBER, GREEN, RED, RED_AMBER
from studio.vehicle.parameter import FRONT
from studio.world.table.mind import STATION
from studio.world.view import draw, draw_normal, report

KIND = "sensor"
TITLE = "Traffic light ahead"
DISTANCE, MISREAD = range(2)  # draws


class Settings(Sensor):
    """How far it reads lights, and how well."""

    reach: float = number(100.0, unit="m", title="Reach", description="to the stop line", ge=0, le=300)
    noise: float = number(0.5, unit="m", title="Noise of the distance", description="standard deviation", ge=0, le=10)
    growth: float = number(0.02, unit="1", title="Growth of the noise", description="per metre of distance", ge=0, le=0.5)
    misread: float = number(0.0, unit="1", title="Misread", description="share of the looks at which the light seems dark", ge=0, le=1)


class Reading(NamedTuple):
    """The next light; one of the colours is 1, none when it is misread."""

    distance: Annotated[float, "m", "from the front bumper to the stop line"] = 0.0
    red: Annotated[float, "1", "1 while it shows red, also with amber"] = 0.0
    amber: Annotated[float, "1", "1 while it shows amber, also with red"] = 0.0
    green: Annotated[float, "1", "1 while it shows green"] = 0.0


@inlined
def flag(shown, one, other):
    """1 while a light shows one of two things, else 0."""
    return 1.0 if shown in (one, other) else 0.0


@inlined
def measure(view, me, settings, memory, out):
    """The next stop line with a light within reach."""
    v = me.vehicle
    if v < 0:
        return 0
    bumper = view.mind[STATION, v] + view.parameter[FRONT, v]
    for i in range(view.stop_first[v], view.stop_first[v] + view.stop_count[v]):
        distance = view.stop_station[i] - bumper
        if 0.0 < distance <= settings.reach:
            shown = view.shown[view.stop_link[i]]
            if settings.misread > 0.0 and draw(view, me, MISREAD) < settings.misread:
                shown = -1
            seen = max(distance + grown(settings.noise, settings.growth, distance) * draw_normal(view, me, DISTANCE), 0.0)
            report(out, me, 0, Reading(seen, flag(shown, RED, RED_AMBER), flag(shown, AMBER, RED_AMBER), flag(shown, GREEN, GREEN)))
            return 1
    return 0
