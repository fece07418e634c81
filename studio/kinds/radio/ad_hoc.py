"""Ad hoc radio: every message reaches every unit in range, after a delay, or is lost.

Parameters as Massow & Radusch 2018, Table 3: mean delay, variation, loss rate, loss growing with distance, range. How buildings weaken a
signal stands in studio/model/radio/propagation.py. Bit rate and largest message are those of ETSI ITS-G5 (EN 302 663: 6 Mbit/s;
TS 102 636-4-1: 1398 bytes).
"""

from pydantic import Field

from studio.compiled import compiled
from studio.kind.settings import Part, number
from studio.model.radio import chance, propagation
from studio.world.view import Transmission

KIND = "radio"
TITLE = "Ad hoc radio with constant delay and loss"


class Settings(Part):
    """The ad hoc radio that all units share."""

    delay: float = number(
        0.02, unit="s", title="Delay", description="mean, sender's to receiver's application, besides the time on the air", ge=0, le=1
    )
    delay_variation: float = number(0.005, unit="s", title="Variation of the delay", description="half width", ge=0, le=1)
    loss: float = number(0.01, unit="1", title="Loss rate", ge=0, le=1)
    loss_per_metre: float = number(0.0, unit="1/m", title="Loss per distance", ge=0, le=0.1)
    range: float = number(300.0, unit="m", title="Range", gt=0, le=5000)
    buildings: bool = Field(
        True,
        title="Shadowed by buildings",
        description="9 dB a wall and 0.4 dB a metre inside (Sommer et al., WONS 2011) count as distance",
    )
    path_loss_exponent: float = number(
        2.0,
        unit="1",
        title="Path loss exponent",
        description="how fast power falls with distance, which makes the shadow a distance: 2 in free space, 2.7 to 3 in cities",
        ge=1.5,
        le=6,
    )
    bit_rate: float = number(
        6e6, unit="bit/s", title="Bit rate", description="a message is on the air for as long as its size needs", ge=1e5, le=1e10
    )
    largest: int = number(1400, unit="byte", title="Largest message", description="that the radio takes", ge=50, le=2304)


def longest(settings):
    """The longest delay [s]."""
    return settings.delay + settings.delay_variation + 8.0 * settings.largest / settings.bit_rate


def largest(settings):
    """The largest message [bytes]."""
    return settings.largest


def reach(settings):
    """The distance [m] beyond which nothing is heard."""
    return settings.range


@compiled
def transmit(settings, way, draw):
    """Whether a message is lost on its way, and how long it takes."""
    weakened = propagation.attenuation(way.walls, way.inside) if settings.buildings > 0.0 else 0.0
    distance = propagation.felt_distance(way.distance, weakened, settings.path_loss_exponent)
    lost = chance.is_lost(distance, settings.range, settings.loss, settings.loss_per_metre, draw.first)
    return Transmission(lost, chance.delay(settings.delay, settings.delay_variation, draw.second) + 8.0 * way.size / settings.bit_rate)
