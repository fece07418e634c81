"""The time to a collision is under a bound, if both go on as they do: the gap over the speed with which it shrinks.

Without `other` it is that to what is ahead on the own path, bumper to bumper (J. C. Hayward, Near-miss determination through use of a
scale of danger, 1972); with it that between the outlines of the two, each going straight on.
"""

from pydantic import Field, model_validator

from studio.compiled import compiled
from studio.kind.settings import BodyName, Part, VehicleName, number
from studio.vehicle.state import V_X
from studio.world.condition import body, is_about, outline_gap
from studio.world.table.mind import AHEAD_SPEED, GAP

KIND = "condition"
TITLE = "A collision is near"
SHORT = 0.01  # [s] over which the gap is seen to shrink


class Settings(Part):
    """Who, with whom, and how near."""

    vehicle: VehicleName = Field(..., title="Vehicle")
    other: BodyName | None = Field(None, title="The other", description="left out: what is ahead on the path of the vehicle")
    below: float = number(..., unit="s", title="Time below", gt=0, le=60)

    @model_validator(mode="after")
    def are_two(self):
        if self.vehicle == self.other:
            raise ValueError(f"`vehicle` and `other` are both {self.vehicle!r}: nobody hits himself; name another, or leave `other` out")
        return self


@compiled
def holds(view, settings):
    """Never while the gap does not shrink."""
    v = int(settings.vehicle)
    if not is_about(view, v):
        return False
    if settings.other != settings.other:
        gap, closing = view.mind[GAP, v], view.state[V_X, v] - view.mind[AHEAD_SPEED, v]
    else:
        one, other = body(view, v), body(view, int(settings.other))
        if not other.is_there:
            return False
        gap = outline_gap(one, other, 0.0)
        closing = (gap - outline_gap(one, other, SHORT)) / SHORT
    return closing > 0.0 and gap < settings.below * closing
