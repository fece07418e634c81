"""A vehicle brakes with a constant deceleration, whatever its application and its driver want, and is held once it stands."""

from pydantic import Field

from studio.compiled import compiled
from studio.kind.settings import Part, VehicleName, number
from studio.world.condition import ROUNDING
from studio.world.maneuver import PEDALS, drive, over

KIND = "action"
TITLE = "Brake"
TAKES = PEDALS


class Settings(Part):
    """Who, how hard, and how long."""

    vehicle: VehicleName = Field(..., title="Vehicle")
    deceleration: float = number(6.0, unit="m/s²", title="Deceleration", gt=0, le=10)
    duration: float = number(3.0, unit="s", title="Duration", gt=0, le=600)
    to_speed: float = number(
        0.0,
        unit="m/s",
        title="Down to",
        description="ends earlier at this speed; the brakes still need their time to release; 0: to a stand, and held there to the end",
        ge=0,
        le=70,
    )


@compiled
def act(settings, sees):
    """Over with its time, or once its speed is reached; one that stands goes on being braked."""
    if sees.elapsed >= settings.duration - ROUNDING or 0.0 < settings.to_speed >= sees.speed:
        return over()
    return drive(-settings.deceleration)


def told(settings):
    """In words."""
    return f"brake with {settings.deceleration:g} m/s²"
