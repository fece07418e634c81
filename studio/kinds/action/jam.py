"""The radio is jammed in an area: units in it hear nothing while the entry acts, and the messages count as lost for that."""

from pydantic import Field

from studio.kind.area import Area
from studio.kind.settings import Part
from studio.world.effect import Jam

KIND = "action"
TITLE = "Jam the radio in an area"


class Settings(Part):
    """Where."""

    area: Area = Field(..., title="Area")


def effects(settings, place):
    """Nothing is heard there."""
    return [Jam(settings.area)]


def told(settings):
    """In words."""
    return "radio jammed"
