"""Platoon message: what a car in a platoon does and has asked of its actuators, ten times a second.

Feed-forward of the commanded acceleration is what makes short headways string stable (J. Ploeg et al., IEEE Trans. Control Systems
Technology 22 (2014) 786). Size and period: beacons of Plexe (M. Segata et al., VNC 2014), 200 bytes at 10 Hz.
"""

from typing import Annotated, NamedTuple

from studio.compiled import compiled
from studio.kind.settings import Part, number

KIND = "message"
TITLE = "Platoon: speed, acceleration and commanded acceleration"
SIZE = 200


class Settings(Part):
    """How often."""

    period: float = number(0.1, unit="s", title="Period", description="of one unit", ge=0.01, le=1)


class Payload(NamedTuple):
    """The sender."""

    x: Annotated[float, "m", "east position by its satellite receiver, with its errors"] = 0.0
    y: Annotated[float, "m", "north position, likewise"] = 0.0
    speed: Annotated[float, "m/s", "along the car"] = 0.0
    acceleration: Annotated[float, "m/s²", "that it has, forward"] = 0.0
    command: Annotated[float, "m/s²", "that was asked of its actuators"] = 0.0


@compiled
def beacon(own, settings):
    """What a car says of itself."""
    return Payload(own.gps_x, own.gps_y, own.speed, own.acceleration, own.request)
