"""Awareness: what every unit says of itself, again and again, as the cooperative awareness messages of ETSI EN 302 637-2 do.

They carry, besides what the standard asks for, the acceleration that was requested of the own actuators: what string-stable platoons
need (J. Ploeg et al., IEEE Trans. Control Systems Technology 22 (2014) 786). Size: 200 to 400 bytes with certificate are measured.
"""

from typing import Annotated, NamedTuple

from studio.compiled import compiled
from studio.kind.settings import Part, number

KIND = "message"
TITLE = "Awareness: place, speed, acceleration and intention of a unit"
SIZE = 300


class Settings(Part):
    """How often."""

    period: float = number(0.1, unit="s", title="Period", description="of one unit", ge=0.01, le=2)


class Payload(NamedTuple):
    """The sender."""

    x: Annotated[float, "m", "east position by its satellite receiver, with its errors"] = 0.0
    y: Annotated[float, "m", "north position, likewise"] = 0.0
    speed: Annotated[float, "m/s", "along the car"] = 0.0
    acceleration: Annotated[float, "m/s²", "forward"] = 0.0
    intention: Annotated[float, "m/s²", "asked of its actuators by application or script; where a person drives, its acceleration"] = 0.0


@compiled
def beacon(own, settings):
    """What a unit says of itself."""
    return Payload(own.gps_x, own.gps_y, own.speed, own.acceleration, own.request)
