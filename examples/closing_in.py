"""A vehicle closes in: its time to collision with what is ahead falls below a value.

J. C. Hayward, Near miss determination through use of a scale of danger, 1972. What is ahead, and how fast it is, is what the driver saw.
"""

from pydantic import Field

from studio.compiled import compiled
from studio.kind.settings import Part, VehicleName, number
from studio.vehicle.state import V_X
from studio.world.condition import is_about
from studio.world.table.mind import AHEAD_SPEED, GAP

KIND = "condition"
TITLE = "A vehicle closes in"
SLOW = 0.1  # [m/s] that nobody calls closing in


class Settings(Part):
    """Who, and how soon it would hit."""

    vehicle: VehicleName = Field(..., title="Vehicle")
    below: float = number(3.0, unit="s", title="Time to collision below", gt=0, le=60)


@compiled
def holds(view, settings):
    """Never while nothing is ahead: then the gap is not a number."""
    v = int(settings.vehicle)
    closing = view.state[V_X, v] - view.mind[AHEAD_SPEED, v]
    return is_about(view, v) and closing > SLOW and view.mind[GAP, v] < settings.below * closing
