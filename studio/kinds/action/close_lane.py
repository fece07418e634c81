"""A lane is closed with cones and barriers; cars are led onto the nearest open lane, and stop where there is none."""

from studio.kind.stretch import LaneStretch
from studio.world.effect import Closing

KIND = "action"
TITLE = "Close a lane"


class Settings(LaneStretch):
    """Which lane, from where to where."""


def effects(settings, place):
    """A closing, which brings its cones and barriers."""
    return [Closing(settings)]


def told(settings):
    """In words."""
    return f"lane {settings.lane} of {settings.road} closed"
