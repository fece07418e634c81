"""Another condition has held for some time without a break."""

from pydantic import Field

from studio.compiled import compiled
from studio.kind.settings import Part, number
from studio.kind.slot import AnyCondition
from studio.world.condition import ROUNDING

KIND = "condition"
TITLE = "For some time without a break"


class Settings(Part, defer_build=True):
    """Which, and how long."""

    of: AnyCondition = Field(..., title="This")
    duration: float = number(..., unit="s", title="Has held for", ge=0, le=3600)


@compiled
def joins(settings, parts):
    """Counted from the tick at which it began to hold; anew after every break."""
    return parts.time >= parts.since + settings.duration - ROUNDING


def never(settings, place):
    """Not when the other never does, or the run is over before."""
    too_long = f"the run lasts {place.duration:g} s" if settings.duration >= place.duration else ""
    return place.never(settings.of) or too_long
