"""Ad hoc radio: every message reaches every unit in range, after a delay, or is lost.

Parameters as Massow & Radusch 2018, Table 3: mean delay, variation, loss rate, loss growing with distance, range. How buildings weaken a
signal stands in studio/model/radio.py.
"""

from pydantic import Field

from studio.compiled import compiled
from studio.kind.settings import Part, number
from studio.model import radio
from studio.world.view import Transmission

KIND = "radio"
TITLE = "Ad hoc radio with constant delay and loss"


class Settings(Part):
    """The ad hoc radio that all units share."""

    delay: float = number(0.02, unit="s", title="Delay", description="mean, sender's to receiver's application", ge=0, le=1)
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


def longest(settings):
    """The longest delay [s]."""
    return settings.delay + settings.delay_variation


def reach(settings):
    """The distance [m] beyond which nothing is heard."""
    return settings.range


@compiled
def transmit(settings, way, draw):
    """Whether a message is lost on its way, and how long it takes."""
    weakened = radio.attenuation(way.walls, way.inside) if settings.buildings > 0.0 else 0.0
    distance = radio.felt_distance(way.distance, weakened, settings.path_loss_exponent)
    lost = radio.is_lost(distance, settings.range, settings.loss, settings.loss_per_metre, draw.first)
    return Transmission(lost, radio.delay(settings.delay, settings.delay_variation, draw.second))
