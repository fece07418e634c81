"""Some time has passed since another condition held for the first time, whether it still does or not."""

from pydantic import Field

from studio.compiled import compiled
from studio.kind.settings import Part, number
from studio.kind.slot import AnyCondition
from studio.world.condition import ROUNDING

KIND = "condition"
TITLE = "Some time after another condition"


class Settings(Part, defer_build=True):
    """Which, and how long after."""

    of: AnyCondition = Field(..., title="This")
    delay: float = number(..., unit="s", title="Time after it", ge=0, le=3600)


@compiled
def joins(settings, parts):
    """From the tick on at which it first held."""
    return parts.time >= parts.met + settings.delay - ROUNDING


def never(settings, place):
    """Not when the other never does, or the run is over before."""
    too_long = f"the run lasts {place.duration:g} s" if settings.delay >= place.duration else ""
    return place.never(settings.of) or too_long
