"""The lights at the end of a road show a colour, whatever their programme says: a fault, or a signal for those who come.

Other approaches of the junction go on with their programme; what that means for those who cross is the scenario's business.
"""

from typing import Literal

from pydantic import Field

from studio.kind.settings import Part, SignalName
from studio.world.effect import Lights

KIND = "action"
TITLE = "Have a light show a colour"


class Settings(Part):
    """Which, and what they show."""

    road: SignalName = Field(..., title="Road", description="with the lights at its end")
    shows: Literal["red", "red_amber", "green", "amber"] = Field("red", title="Shows")


def effects(settings, place):
    """Lights."""
    return [Lights(settings.road, settings.shows)]


def told(settings):
    """In words."""
    return f"the lights of {settings.road} show {settings.shows.replace('_', ' and ')}"
