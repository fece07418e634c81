"""Region camera: an infrastructure's camera that says where the cars and objects in its field are, in the coordinates of the map.

It stands at a station, high above, or looks down on a deck: with `visible` 0 nothing hides anything, with more of it outlines and buildings
do. Every target has a track. Figures of camera localisation in garages: 10 to 20 Hz, 0.1 to 0.2 m, 0.1 to 0.25 s (J. Einsiedler et al.,
indoor micro navigation utilizing local infrastructure-based positioning, IV 2012); the noise of heading and speed is estimated.
"""

from math import atan2, pi
from typing import Annotated, NamedTuple

from studio.compiled import inlined
from studio.kind.preset import Preset
from studio.kind.sensor import Looking
from studio.kind.settings import number
from studio.model.sight import far, grown
from studio.world.passes import track
from studio.world.passes.sight import LONG, MIDDLE_X, MIDDLE_Y, TURNED_COS, TURNED_SIN, WHO, speed_of
from studio.world.passes.track import Tracks
from studio.world.view import draw, draw_four, look, report, target

KIND = "sensor"
TITLE = "Camera of an infrastructure"
CAPACITY = track.MOST
PLACE, LENGTH, MISS = range(3)  # draws
Memory = Tracks


class Settings(Looking):
    """What it sees, and how well."""

    opening_angle: float = number(2.0 * pi, unit="rad", title="Opening angle", description="from edge to edge", gt=0, le=2 * pi)
    range: float = number(40.0, unit="m", title="Reach", description="0 sees nothing", ge=0, le=500)
    noise: float = number(0.15, unit="m", title="Noise of the place", description="standard deviation, each way", ge=0, le=5)
    growth: float = number(0.0, unit="1", title="Growth of this noise", description="per metre of distance", ge=0, le=0.5)
    heading_noise: float = number(0.03, unit="rad", title="Noise of the heading", description="standard deviation", ge=0, le=1)
    speed_noise: float = number(0.2, unit="m/s", title="Noise of the speed", description="standard deviation", ge=0, le=5)
    length_noise: float = number(0.3, unit="m", title="Noise of the length", description="standard deviation", ge=0, le=5)
    visible: float = number(
        0.0, unit="1", title="Share that must be seen", description="of the bearings of an outline, else it is hidden; 0: nothing hides",
        ge=0, le=1,
    )  # fmt: skip
    missed: float = number(0.0, unit="1", title="Missed", description="share of the looks at which a target is not found", ge=0, le=1)
    gain: float = number(0.5, unit="1", title="Gain of the existence", description="from look to look", gt=0, le=1)


PRESETS = {
    "garage": Preset("Garage or crossing", "J. Einsiedler et al., IV 2012", {"delay": 0.18, "delay_variation": 0.04, "period": 0.07}),
}


class Reading(NamedTuple):
    """One target."""

    x: Annotated[float, "m", "east, of the middle of its outline, in the coordinates of the map"] = 0.0
    y: Annotated[float, "m", "north, likewise"] = 0.0
    heading: Annotated[float, "rad", "counter-clockwise from east"] = 0.0
    speed: Annotated[float, "m/s", "along its heading"] = 0.0
    length: Annotated[float, "m", "of its outline"] = 0.0
    track: Annotated[float, "1", "number of its track, the same from look to look"] = 0.0
    existence: Annotated[float, "1", "how sure it is that it is there, 0 to 1"] = 0.0


@inlined
def write(view, me, settings, i, slot, out):
    """Target `slot`, the body in column i."""
    sight = view.sight
    x, y = sight[MIDDLE_X, i], sight[MIDDLE_Y, i]
    sigma = grown(settings.noise, settings.growth, far(x, y))
    a, b, c, d = draw_four(view, me, PLACE, slot)
    e, _, _, _ = draw_four(view, me, LENGTH, slot)
    east = me.eye_x + x * me.eye_cosine - y * me.eye_sine + sigma * a
    north = me.eye_y + x * me.eye_sine + y * me.eye_cosine + sigma * b
    heading = me.eye_heading + atan2(sight[TURNED_SIN, i], sight[TURNED_COS, i]) + settings.heading_noise * c
    speed = speed_of(view, sight[WHO, i]) + settings.speed_noise * d
    length = max(sight[LONG, i] + settings.length_noise * e, 0.0)
    t = track.follow(view, me, sight[WHO, i], settings.gain)
    report(out, me, slot, Reading(east, north, heading, speed, length, track.number(view, t), track.existence(view, t)))


@inlined
def measure(view, me, settings, memory, out):
    """One look: all in the field, the nearest first."""
    seen, slot = look(view, me, settings.range, 0.5 * settings.opening_angle, settings.visible, CAPACITY, True), 0
    if seen == 0 and track.are_none(memory):
        return 0, memory
    track.begin(view, memory)
    for j in range(seen):
        if settings.missed <= 0.0 or draw(view, me, MISS, j) >= settings.missed:
            write(view, me, settings, target(view, j), slot, out)
            slot += 1
    return slot, track.end(view, settings.gain)
