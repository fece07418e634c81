"""A vehicle holds a speed, or is held where it stands, whatever its application and its driver want."""

from pydantic import Field

from studio.compiled import compiled
from studio.kind.settings import Part, VehicleName, number
from studio.world.condition import ROUNDING
from studio.world.maneuver import PEDALS, drive, over

KIND = "action"
TITLE = "Hold a speed"
TAKES = PEDALS
GAIN = 1.0  # [1/s] acceleration for a missing speed
STAND = -0.5  # [m/s²] asked for where nothing is to move: the brakes hold


class Settings(Part):
    """Who, which speed, and how long."""

    vehicle: VehicleName = Field(..., title="Vehicle")
    speed: float = number(0.0, unit="m/s", title="Speed", description="0: it stands, and is held", ge=0, le=70)
    acceleration: float = number(2.0, unit="m/s²", title="Acceleration", description="or deceleration, at most", gt=0, le=10)
    duration: float = number(10.0, unit="s", title="Duration", gt=0, le=3600)


@compiled
def act(settings, sees):
    """Over with its time."""
    if sees.elapsed >= settings.duration - ROUNDING:
        return over()
    wanted = GAIN * (settings.speed - sees.speed) + (STAND if settings.speed == 0.0 else 0.0)
    return drive(min(max(wanted, -settings.acceleration), settings.acceleration))


def told(settings):
    """In words."""
    return f"hold {settings.speed:g} m/s" if settings.speed > 0.0 else "stand"


def fastest(settings):
    """What the vehicle must be able to drive [m/s]."""
    return settings.speed
