"""An application does not run while the entry acts, on one of its units or on all; with `until` it starts again where it was.

What it commanded is its driver's meanwhile. One that is to start later is stopped from the beginning until then.
"""

from pydantic import Field

from studio.kind.settings import GroupName, Part, UnitName
from studio.world.effect import Switch

KIND = "action"
TITLE = "Stop an application"


class Settings(Part):
    """Which, and where."""

    application: GroupName = Field(..., title="Group of applications")
    unit: UnitName | None = Field(None, title="Unit", description="left out: all units of the group")


def effects(settings, place):
    """It is off."""
    return [Switch(settings.application, settings.unit)]


def told(settings):
    """In words."""
    return f"{settings.application} stops" + (f" on {settings.unit}" if settings.unit else "")
