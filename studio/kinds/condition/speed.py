"""A vehicle is faster, or slower, than a speed."""

from typing import Literal

from pydantic import Field

from studio.compiled import compiled
from studio.kind.settings import Part, VehicleName, number
from studio.vehicle.state import V_X
from studio.world.condition import is_about

KIND = "condition"
TITLE = "A vehicle is faster or slower"


class Settings(Part):
    """Who, and how fast."""

    vehicle: VehicleName = Field(..., title="Vehicle")
    side: Literal["above", "below"] = Field("below", title="Side", description="of the speed")
    speed: float = number(..., unit="m/s", title="Speed", ge=0, le=70)


@compiled
def holds(view, settings):
    """While the vehicle is about."""
    v = int(settings.vehicle)
    beyond = view.state[V_X, v] - settings.speed
    return is_about(view, v) and (beyond > 0.0 if settings.side == 0.0 else beyond < 0.0)
