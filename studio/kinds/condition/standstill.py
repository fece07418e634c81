"""A vehicle stands. Below 0.1 m/s the studio tells of a car that it waits, and so does this."""

from pydantic import Field

from studio.compiled import compiled
from studio.kind.settings import Part, VehicleName
from studio.vehicle.state import V_X
from studio.world.condition import is_about

KIND = "condition"
TITLE = "A vehicle stands"
STANDING = 0.1  # [m/s]


class Settings(Part):
    """Who."""

    vehicle: VehicleName = Field(..., title="Vehicle")


@compiled
def holds(view, settings):
    """While it does."""
    v = int(settings.vehicle)
    return is_about(view, v) and abs(view.state[V_X, v]) < STANDING
