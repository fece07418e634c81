"""Two come near each other, or apart: the gap between their outlines, the shortest way between them, is under or over a distance."""

from typing import Literal

from pydantic import Field, model_validator

from studio.compiled import compiled
from studio.kind.settings import BodyName, Part, number
from studio.world.condition import body, outline_gap

KIND = "condition"
TITLE = "Two are near each other, or apart"


class Settings(Part):
    """Which two, and how near."""

    vehicle: BodyName = Field(..., title="Vehicle", description="or somebody that an entry of the script brings")
    other: BodyName = Field(..., title="The other")
    side: Literal["above", "below"] = Field("below", title="Side", description="of the distance")
    distance: float = number(..., unit="m", title="Distance", description="between their outlines; 0 while they touch", ge=0, le=10_000)

    @model_validator(mode="after")
    def are_two(self):
        if self.vehicle == self.other:
            raise ValueError(f"`vehicle` and `other` are both {self.vehicle!r}: nobody has a distance to himself; name two")
        return self


@compiled
def holds(view, settings):
    """While both are there."""
    one, other = body(view, int(settings.vehicle)), body(view, int(settings.other))
    if not (one.is_there and other.is_there):
        return False
    beyond = outline_gap(one, other, 0.0) - settings.distance
    return beyond > 0.0 if settings.side == 0.0 else beyond < 0.0
