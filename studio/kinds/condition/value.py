"""A value is over, or under, a bound: of what an application logs, a sensor measures, or a vehicle is or does.

The name is that of its trace in the record: `follower_1.platoon.spacing_error`, `ego.front.range`, `ego.speed`. It is the value of the
tick before; where there is none, it is neither over nor under anything.
"""

from typing import Literal

from pydantic import Field

from studio.compiled import compiled
from studio.kind.settings import Part, ValueName, number

KIND = "condition"
TITLE = "A value is over or under a bound"


class Settings(Part):
    """Which, and the bound."""

    name: ValueName = Field(..., title="Value", description="unit and quantity, as the record names them")
    side: Literal["above", "below"] = Field("above", title="Side", description="of the bound")
    bound: float = number(..., unit="1", title="Bound", description="in the unit of the value", ge=-1e9, le=1e9)


@compiled
def holds(view, settings):
    """While it is."""
    value = view.values[int(settings.name)]
    return value > settings.bound if settings.side == 0.0 else value < settings.bound
