"""Object sensor: the cars and barriers in its field as a list, the nearest first, each with a track (studio/world/passes/track.py).

What is nearer hides what is behind it, and so do buildings: of the bearings that an outline covers, a share of `visible` must be seen.
Measured is the nearest point that is seen: its range, rate and azimuth, with noise that grows with the distance. A target may be missed at
a look; its existence falls then, and rises when it is seen. Of a car that hides another one the radar sees no more than the near one:
echoes under a car are not simulated.

Presets: 3GPP TR 22.837, as for the front radar; delays, growth of noise and the camera's figures are estimated.
"""

from math import atan2
from typing import Annotated, NamedTuple

from studio.compiled import inlined
from studio.kind.preset import Preset
from studio.kind.sensor import Looking
from studio.kind.settings import number
from studio.model.sight import far, grown
from studio.world.passes import track
from studio.world.passes.sight import SEEN_X, SEEN_Y, TURNED_COS, TURNED_SIN, WHO, speed_of
from studio.world.passes.track import Tracks
from studio.world.view import draw, draw_four, look, report, target

KIND = "sensor"
TITLE = "Object sensor with tracks"
CAPACITY = track.MOST
NOISE, MISS = range(2)  # draws
Memory = Tracks


class Settings(Looking):
    """What it sees, and how well."""

    range_noise: float = number(0.15, unit="m", title="Noise of the range", description="standard deviation", ge=0, le=10)
    rate_noise: float = number(0.05, unit="m/s", title="Noise of the range rate", description="standard deviation", ge=0, le=5)
    azimuth_noise: float = number(0.002, unit="rad", title="Noise of the azimuth", description="standard deviation", ge=0, le=0.5)
    range_growth: float = number(0.001, unit="1", title="Growth of the range noise", description="per metre of distance", ge=0, le=0.5)
    rate_growth: float = number(0.0, unit="1/s", title="Growth of the rate noise", description="per metre of distance", ge=0, le=0.1)
    azimuth_growth: float = number(
        0.0, unit="rad/m", title="Growth of the azimuth noise", description="per metre of distance", ge=0, le=0.01
    )
    visible: float = number(
        0.2, unit="1", title="Share that must be seen", description="of the bearings of an outline, else it is hidden; 0: nothing hides",
        ge=0, le=1,
    )  # fmt: skip
    missed: float = number(0.0, unit="1", title="Missed", description="share of the looks at which a target is not found", ge=0, le=1)
    gain: float = number(0.5, unit="1", title="Gain of the existence", description="from look to look", gt=0, le=1)
    cones: bool = number(False, unit="1", title="Sees cones", description="of plastic, as cameras do and radars do not")


TR_22837 = "3GPP TR 22.837; delay and growth estimated"
PRESETS = {
    "long_range_radar": Preset("Long range radar", TR_22837, {
        "range": 250.0, "opening_angle": 0.35, "range_noise": 0.15, "range_growth": 0.001, "rate_noise": 0.05, "azimuth_noise": 0.0017,
        "delay": 0.08, "delay_variation": 0.01, "period": 0.06, "missed": 0.02,
    }),
    "short_range_radar": Preset("Short range radar", TR_22837, {
        "range": 80.0, "opening_angle": 2.4, "range_noise": 0.05, "range_growth": 0.001, "rate_noise": 0.1, "azimuth_noise": 0.017,
        "delay": 0.06, "delay_variation": 0.01, "period": 0.04, "missed": 0.02,
    }),
    "camera": Preset("Camera", "range noise 5 % of the range, 30 Hz, delay 0.08 to 0.12 s: estimated, as usual for one camera", {
        "range": 120.0, "opening_angle": 0.9, "range_noise": 0.3, "range_growth": 0.05, "rate_noise": 0.3, "rate_growth": 0.01,
        "azimuth_noise": 0.003, "delay": 0.1, "delay_variation": 0.01, "period": 0.033, "missed": 0.05, "visible": 0.3, "cones": True,
    }),
}  # fmt: skip


class Reading(NamedTuple):
    """One target."""

    range: Annotated[float, "m", "from the sensor to the nearest point of it that is seen"] = 0.0
    rate: Annotated[float, "m/s", "change of the range, negative when coming nearer"] = 0.0
    azimuth: Annotated[float, "rad", "of that point from the direction of the sensor, left positive"] = 0.0
    track: Annotated[float, "1", "number of its track, the same from look to look"] = 0.0
    existence: Annotated[float, "1", "how sure it is that it is there, 0 to 1"] = 0.0
    lasted: Annotated[float, "s", "since its track began"] = 0.0


@inlined
def rate_of(view, me, i):
    """Change of the distance [m/s] to the nearest point that is seen of the body in column i."""
    sight = view.sight
    x, y = sight[SEEN_X, i], sight[SEEN_Y, i]
    c, s = me.cosine * me.eye_cosine + me.sine * me.eye_sine, me.sine * me.eye_cosine - me.cosine * me.eye_sine
    speed = speed_of(view, sight[WHO, i])
    ahead, aside = speed * sight[TURNED_COS, i] - me.speed * c, speed * sight[TURNED_SIN, i] - me.speed * s
    return (ahead * x + aside * y) / max(far(x, y), 1e-6)


@inlined
def write(view, me, settings, i, slot, out):
    """Target `slot`, the body in column i, with its noise."""
    t = track.follow(view, me, view.sight[WHO, i], settings.gain)
    x, y = view.sight[SEEN_X, i], view.sight[SEEN_Y, i]
    r = far(x, y)
    u, v, w, _ = draw_four(view, me, NOISE, slot)
    seen = r + grown(settings.range_noise, settings.range_growth, r) * u
    rate = rate_of(view, me, i) + grown(settings.rate_noise, settings.rate_growth, r) * v
    azimuth = atan2(y, x) + grown(settings.azimuth_noise, settings.azimuth_growth, r) * w
    report(
        out, me, slot,
        Reading(max(seen, 0.0), rate, azimuth, track.number(view, t), track.existence(view, t), track.lasted(view, t)),
    )  # fmt: skip


@inlined
def measure(view, me, settings, memory, out):
    """One look: all that is seen, the nearest first."""
    cones, slot = settings.cones > 0.0, 0
    seen = look(view, me, settings.range, 0.5 * settings.opening_angle, settings.visible, CAPACITY, cones)
    if seen == 0 and track.are_none(memory):
        return 0, memory
    track.begin(view, memory)
    for j in range(seen):
        if settings.missed <= 0.0 or draw(view, me, MISS, j) >= settings.missed:
            write(view, me, settings, target(view, j), slot, out)
            slot += 1
    return slot, track.end(view, settings.gain)
