"""A time has come."""

from studio.compiled import compiled
from studio.kind.settings import Part, number
from studio.world.condition import ROUNDING

KIND = "condition"
TITLE = "At a time"


class Settings(Part):
    """The time."""

    at: float = number(0.0, unit="s", title="Time", ge=0, le=3600)


@compiled
def holds(view, settings):
    """From the tick on that it is."""
    return view.time >= settings.at - ROUNDING


def never(settings, place):
    """Not when the run is over before."""
    return f"the run ends at {place.duration:g} s" if settings.at >= place.duration else ""


def moment(settings):
    """It is known beforehand."""
    return settings.at
