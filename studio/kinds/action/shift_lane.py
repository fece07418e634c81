"""The line of a lane is moved sideways, and the cars on it."""

from studio.kind.settings import number
from studio.kind.stretch import LaneStretch
from studio.world.effect import Shift

KIND = "action"
TITLE = "Shift a lane"


class Settings(LaneStretch):
    """Which lane, from where to where, and how far."""

    offset: float = number(..., unit="m", title="Offset", description="to the left", ge=-5, le=5)


def effects(settings, place):
    """A shift."""
    return [Shift(settings, settings.offset)]


def told(settings):
    """In words."""
    return f"lane {settings.lane} of {settings.road} shifted by {settings.offset:g} m"
