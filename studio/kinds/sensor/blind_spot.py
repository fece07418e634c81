"""Blind-spot sensor: cars beside and behind, where they are and how long they are, the nearest first, each with a track.

One of these looks from a rear corner; `yaw` turns it. Cars hide each other, and so do buildings. The place is that of the middle of a
car's outline, seen from the middle of the own front bumper; place and length carry white noise. Reach, noise and rate as of the short
range radars in the rear corners that warn of lane changes: 24 and 77 GHz, up to 80 m, 0.2 m, 20 to 50 Hz (H. Winner et al., Handbook of
Driver Assistance Systems, 2016, ch. 17; 3GPP TR 22.837). How well a length is told is estimated.
"""

from math import pi
from typing import Annotated, NamedTuple

from studio.compiled import inlined
from studio.kind.preset import Preset
from studio.kind.sensor import Looking
from studio.kind.settings import number
from studio.vehicle.state import V_X
from studio.world.passes import track
from studio.world.passes.neighbour import COS, SIN
from studio.world.passes.sight import LONG, MIDDLE_X, MIDDLE_Y, WHO
from studio.world.passes.track import Tracks
from studio.world.view import draw_four, look, report, target

KIND = "sensor"
TITLE = "Blind-spot sensor"
CAPACITY = track.MOST
GAIN = 0.5  # of a track's existence, from look to look
NOISE = 0  # draws
Memory = Tracks


class Settings(Looking):
    """Where it looks, and how well."""

    forward: float = number(-4.2, unit="m", title="Mounted ahead", description="of the front bumper; negative behind it", ge=-30, le=5)
    left: float = number(0.8, unit="m", title="Mounted to the left", description="of the middle; negative to the right", ge=-3, le=3)
    yaw: float = number(2.2, unit="rad", title="Turned to the left", description="from straight ahead", ge=-pi, le=pi)
    opening_angle: float = number(2.6, unit="rad", title="Opening angle", description="from edge to edge", gt=0, le=2 * pi)
    range: float = number(60.0, unit="m", title="Reach", description="0 sees nothing", ge=0, le=500)
    noise: float = number(0.2, unit="m", title="Noise of the place", description="standard deviation, each way", ge=0, le=5)
    rate_noise: float = number(0.1, unit="m/s", title="Noise of the rate", description="standard deviation", ge=0, le=5)
    length_noise: float = number(0.3, unit="m", title="Noise of the length", description="standard deviation", ge=0, le=5)
    visible: float = number(
        0.2, unit="1", title="Share that must be seen", description="of the bearings of an outline, else it is hidden; 0: nothing hides",
        ge=0, le=1,
    )  # fmt: skip


SOURCE = "H. Winner et al., Handbook of Driver Assistance Systems, 2016, ch. 17; 3GPP TR 22.837"
TIMES = {"delay": 0.06, "delay_variation": 0.01, "period": 0.04}
PRESETS = {
    "left": Preset("Radar in the left rear corner", SOURCE, TIMES),
    "right": Preset("Radar in the right rear corner", SOURCE, {"left": -0.8, "yaw": -2.2} | TIMES),
}


class Reading(NamedTuple):
    """One car."""

    ahead: Annotated[float, "m", "its middle ahead of the own front bumper, negative behind"] = 0.0
    left: Annotated[float, "m", "its middle to the left, negative to the right"] = 0.0
    rate: Annotated[float, "m/s", "its speed minus the own one, along the own heading"] = 0.0
    length: Annotated[float, "m", "of the car"] = 0.0
    track: Annotated[float, "1", "number of its track, the same from look to look"] = 0.0
    existence: Annotated[float, "1", "how sure it is that it is there, 0 to 1"] = 0.0


@inlined
def write(view, me, settings, i, slot, out):
    """Target `slot`, the car in column i."""
    sight, v = view.sight, int(view.sight[WHO, i])
    east = me.eye_x + sight[MIDDLE_X, i] * me.eye_cosine - sight[MIDDLE_Y, i] * me.eye_sine - me.x
    north = me.eye_y + sight[MIDDLE_X, i] * me.eye_sine + sight[MIDDLE_Y, i] * me.eye_cosine - me.y
    ahead, left = east * me.cosine + north * me.sine - me.front, north * me.cosine - east * me.sine
    along = view.places[COS, v] * me.cosine + view.places[SIN, v] * me.sine
    t = track.follow(view, me, sight[WHO, i], GAIN)
    a, b, c, d = draw_four(view, me, NOISE, slot)
    report(
        out, me, slot,
        Reading(
            ahead + settings.noise * a,
            left + settings.noise * b,
            view.state[V_X, v] * along - me.speed + settings.rate_noise * c,
            max(sight[LONG, i] + settings.length_noise * d, 0.0),
            track.number(view, t),
            track.existence(view, t),
        ),
    )  # fmt: skip


@inlined
def measure(view, me, settings, memory, out):
    """One look: the cars that are seen, the nearest first."""
    seen, slot = look(view, me, settings.range, 0.5 * settings.opening_angle, settings.visible, CAPACITY, False), 0
    if seen == 0 and track.are_none(memory):
        return 0, memory
    track.begin(view, memory)
    for j in range(seen):
        i = target(view, j)
        if view.sight[WHO, i] >= 0.0:
            write(view, me, settings, i, slot, out)
            slot += 1
    return slot, track.end(view, GAIN)
