"""A vehicle accelerates or brakes: its forward acceleration is above, or below, a bound."""

from typing import Literal

from pydantic import Field

from studio.compiled import compiled
from studio.kind.settings import Part, VehicleName, number
from studio.vehicle.state import A_X
from studio.world.condition import is_about

KIND = "condition"
TITLE = "A vehicle accelerates or brakes"


class Settings(Part):
    """Who, and how much."""

    vehicle: VehicleName = Field(..., title="Vehicle")
    side: Literal["above", "below"] = Field("below", title="Side", description="of the acceleration")
    acceleration: float = number(..., unit="m/s²", title="Acceleration", description="forward; negative while it brakes", ge=-15, le=10)


@compiled
def holds(view, settings):
    """While the vehicle is about."""
    v = int(settings.vehicle)
    beyond = view.state[A_X, v] - settings.acceleration
    return is_about(view, v) and (beyond > 0.0 if settings.side == 0.0 else beyond < 0.0)
