"""Deck cameras: what the cameras of a whole parking deck see together, in the coordinates of the map.

They hang under the ceiling, so that nothing hides anything, and their pictures are joined: everybody on the deck once, whoever stands
nearest to the middle first, up to 24. There are no tracks: who is who is left to whoever uses it. Figures of camera localisation in
garages: 10 to 20 Hz, 0.1 to 0.2 m, 0.1 to 0.25 s (J. Einsiedler et al., indoor micro navigation utilizing local infrastructure-based
positioning, IV 2012); the noise of heading and length is estimated. Gaps: `drop_out` for single looks, `missed` for single cars, the action
`sensor_fault` for a longer one.
"""

from math import atan2, pi
from typing import Annotated, NamedTuple

from studio.compiled import inlined
from studio.kind.preset import Preset
from studio.kind.sensor import Sensor
from studio.kind.settings import number
from studio.world.passes.sight import LONG, MIDDLE_X, MIDDLE_Y, TURNED_COS, TURNED_SIN
from studio.world.view import draw, draw_four, look, report, target

KIND = "sensor"
TITLE = "Cameras of a parking deck"
CAPACITY = 24
PLACE, MISS = range(2)  # draws


class Settings(Sensor):
    """What they see, and how well."""

    range: float = number(60.0, unit="m", title="Reach", description="around their middle; 0 sees nothing", ge=0, le=500)
    noise: float = number(0.15, unit="m", title="Noise of the place", description="standard deviation, each way", ge=0, le=5)
    heading_noise: float = number(0.03, unit="rad", title="Noise of the heading", description="standard deviation", ge=0, le=1)
    length_noise: float = number(0.1, unit="m", title="Noise of the length", description="standard deviation", ge=0, le=5)
    missed: float = number(0.0, unit="1", title="Missed", description="share of the looks at which somebody is not found", ge=0, le=1)


PRESETS = {
    "garage": Preset("Garage", "J. Einsiedler et al., IV 2012", {"delay": 0.18, "delay_variation": 0.04, "period": 0.07}),
}


class Reading(NamedTuple):
    """One target."""

    x: Annotated[float, "m", "east, of the middle of its outline, in the coordinates of the map"] = 0.0
    y: Annotated[float, "m", "north, likewise"] = 0.0
    heading: Annotated[float, "rad", "counter-clockwise from east"] = 0.0
    length: Annotated[float, "m", "of its outline"] = 0.0


@inlined
def write(view, me, settings, i, slot, out):
    """Target `slot`, the body in column i."""
    sight = view.sight
    x, y = sight[MIDDLE_X, i], sight[MIDDLE_Y, i]
    a, b, c, d = draw_four(view, me, PLACE, slot)
    east = me.eye_x + x * me.eye_cosine - y * me.eye_sine + settings.noise * a
    north = me.eye_y + x * me.eye_sine + y * me.eye_cosine + settings.noise * b
    heading = me.eye_heading + atan2(sight[TURNED_SIN, i], sight[TURNED_COS, i]) + settings.heading_noise * c
    report(out, me, slot, Reading(east, north, heading, max(sight[LONG, i] + settings.length_noise * d, 0.0)))


@inlined
def measure(view, me, settings, memory, out):
    """One look: all on the deck, the nearest first."""
    seen, slot = look(view, me, settings.range, pi, 0.0, CAPACITY, True), 0
    for j in range(seen):
        if settings.missed <= 0.0 or draw(view, me, MISS, j) >= settings.missed:
            write(view, me, settings, target(view, j), slot, out)
            slot += 1
    return slot
