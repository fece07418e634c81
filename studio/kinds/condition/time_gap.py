"""The time gap of a vehicle to what is ahead on its path is under a bound: the gap over its own speed."""

from pydantic import Field

from studio.compiled import compiled
from studio.kind.settings import Part, VehicleName, number
from studio.vehicle.state import V_X
from studio.world.condition import is_about
from studio.world.table.mind import GAP

KIND = "condition"
TITLE = "A vehicle follows closely"


class Settings(Part):
    """Who, and how closely."""

    vehicle: VehicleName = Field(..., title="Vehicle")
    below: float = number(..., unit="s", title="Time gap below", gt=0, le=60)


@compiled
def holds(view, settings):
    """Never while nothing is ahead, or the vehicle stands."""
    v = int(settings.vehicle)
    return is_about(view, v) and view.mind[GAP, v] < settings.below * view.state[V_X, v]
