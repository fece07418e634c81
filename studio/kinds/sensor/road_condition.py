"""Road condition: how slippery the road is at a spot before the car, as an optical sensor tells it by what the surface sends back.

Water, snow and ice take up near infrared light of different wavelengths, from which the film on the road and by it a friction is told (M.
Jonsson, J. Casselgren, B. Thörnberg, Road surface status classification using spectral analysis of NIR camera images, IEEE Sensors Journal
15 (2015) 1641). It is a guess: what the film is it sees, what the tyre makes of it it does not. So it tells how unsure it is, `sigma`.

Friction is relative to the dry test track of the tyres, as `weather.friction` is: 1 dry, 0.6 wet, 0.3 snow, 0.1 ice. What lies farther
ahead than the spot it does not know.
"""

from typing import Annotated, NamedTuple

from studio.compiled import inlined
from studio.kind.preset import Preset
from studio.kind.sensor import Sensor
from studio.kind.settings import number
from studio.world.view import draw_normal, friction_on, report

KIND = "sensor"
TITLE = "Road condition"
NOISE = 0  # draws


class Settings(Sensor):
    """Where it looks, and how sure it is."""

    ahead: float = number(5.0, unit="m", title="Spot ahead", description="of the front bumper", ge=0, le=50)
    noise: float = number(0.04, unit="1", title="Noise of the friction", description="standard deviation", ge=0, le=0.5)


PRESETS = {"optical": Preset("Optical sensor", "10 Hz, 0.1 s late, 0.04: estimated, as a share of what separates wet from dry", {
    "delay": 0.1, "period": 0.1,
})}  # fmt: skip


class Reading(NamedTuple):
    """The road at the spot."""

    friction: Annotated[float, "1", "over that of a dry test track"] = 1.0
    sigma: Annotated[float, "1", "standard deviation of it"] = 0.0


@inlined
def measure(view, me, settings, memory, out):
    """The spot at one tick; a station has none."""
    if me.vehicle < 0:
        return 0
    away = me.front + settings.ahead
    true = friction_on(me.world, me.x + away * me.cosine, me.y + away * me.sine, view.weather, view.pieces)
    report(out, me, 0, Reading(max(true + settings.noise * draw_normal(view, me, NOISE), 0.0), settings.noise))
    return 1
