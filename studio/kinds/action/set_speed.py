"""A vehicle drives to a speed with a constant acceleration or deceleration, and gives the pedals back once it has it."""

from pydantic import Field

from studio.compiled import compiled
from studio.kind.settings import Part, VehicleName, number
from studio.world.condition import ROUNDING
from studio.world.maneuver import PEDALS, drive, over

KIND = "action"
TITLE = "Drive to a speed"
TAKES = PEDALS


class Settings(Part):
    """Who, how fast, and how quickly."""

    vehicle: VehicleName = Field(..., title="Vehicle")
    speed: float = number(..., unit="m/s", title="Speed", ge=0, le=70)
    acceleration: float = number(1.0, unit="m/s²", title="Acceleration", description="or deceleration", gt=0, le=10)
    duration: float = number(60.0, unit="s", title="Longest duration", description="for a speed that it cannot reach", gt=0, le=600)


@compiled
def act(settings, sees):
    """Less in the last half second, so that the speed is met and not passed."""
    missing = settings.speed - sees.speed
    if abs(missing) < 0.05 or sees.elapsed >= settings.duration - ROUNDING:
        return over()
    return drive(min(max(2.0 * missing, -settings.acceleration), settings.acceleration))


def told(settings):
    """In words."""
    return f"drive to {settings.speed:g} m/s"


def fastest(settings):
    """What the vehicle must be able to drive [m/s]."""
    return settings.speed
