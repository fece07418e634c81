"""The run ends: of a batch this world, the others go on."""

from studio.kind.settings import Part
from studio.world.effect import End

KIND = "action"
TITLE = "End the run"
MOMENTARY = True


class Settings(Part):
    """Nothing to set."""


def effects(settings, place):
    """The end."""
    return [End()]


def told(settings):
    """In words."""
    return "the run ends"
