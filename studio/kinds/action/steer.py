"""A vehicle is steered with an angle of its road wheels, held or swinging as a sine; its pedals stay with application or driver."""

from math import pi, sin

from pydantic import Field

from studio.compiled import compiled
from studio.kind.settings import Part, VehicleName, number
from studio.world.condition import ROUNDING
from studio.world.maneuver import WHEEL, over, steer

KIND = "action"
TITLE = "Steer"
TAKES = WHEEL


class Settings(Part):
    """Who, how far, and how long."""

    vehicle: VehicleName = Field(..., title="Vehicle")
    angle: float = number(
        0.02, unit="rad", title="Angle", description="of the road wheels, to the left; of a sine its peak", ge=-0.6, le=0.6
    )
    frequency: float = number(0.0, unit="1/s", title="Frequency", description="of the sine; 0: the angle is held", ge=0, le=5)
    duration: float = number(1.0, unit="s", title="Duration", gt=0, le=600)


@compiled
def act(settings, sees):
    """Over with its time."""
    if sees.elapsed >= settings.duration - ROUNDING:
        return over()
    return steer(settings.angle * (sin(2.0 * pi * settings.frequency * sees.elapsed) if settings.frequency > 0.0 else 1.0))


def told(settings):
    """In words."""
    return f"steer {settings.angle:g} rad"
