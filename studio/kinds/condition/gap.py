"""What is ahead of a vehicle on its path is nearer than a distance: another vehicle, or an object."""

from pydantic import Field

from studio.compiled import compiled
from studio.kind.settings import Part, VehicleName, number
from studio.world.condition import is_about
from studio.world.table.mind import GAP

KIND = "condition"
TITLE = "A vehicle has come near what is ahead"


class Settings(Part):
    """Who, and how near."""

    vehicle: VehicleName = Field(..., title="Vehicle")
    below: float = number(..., unit="m", title="Gap below", description="bumper to bumper", gt=0, le=1000)


@compiled
def holds(view, settings):
    """Never while nothing is ahead: then the gap is not a number."""
    v = int(settings.vehicle)
    return is_about(view, v) and view.mind[GAP, v] < settings.below
