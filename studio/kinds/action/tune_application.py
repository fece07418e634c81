"""An application has other parameters while the entry acts, on one of its units or on all; with `until` it has its own again."""

from pydantic import Field

from studio.kind.settings import GroupName, Part, UnitName
from studio.world.effect import Tune

KIND = "action"
TITLE = "Tune an application"


class Settings(Part):
    """Which, where, and what."""

    application: GroupName = Field(..., title="Group of applications")
    unit: UnitName | None = Field(None, title="Unit", description="left out: all units of the group")
    parameters: dict = Field({}, title="Parameters", description="of the application; what is not given stays as the group has it")


def effects(settings, place):
    """Other parameters."""
    return [Tune(settings.application, settings.unit, dict(settings.parameters))]


def told(settings):
    """In words."""
    return f"{settings.application}: " + ", ".join(f"{name} {value}" for name, value in settings.parameters.items())
