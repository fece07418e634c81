"""The next messages of a unit reach nobody, whatever their kind."""

from pydantic import Field

from studio.kind.settings import Part, UnitName
from studio.world.effect import Drop

KIND = "action"
TITLE = "Drop the next messages"
MOMENTARY = True


class Settings(Part):
    """Whose, and how many."""

    unit: UnitName = Field(..., title="Unit", description="that sends")
    count: int = Field(1, ge=1, le=10_000, title="How many", json_schema_extra={"unit": "1"})


def effects(settings, place):
    """They are lost."""
    return [Drop(settings.unit, settings.count)]


def told(settings):
    """In words."""
    return f"drop the next {settings.count} messages of {settings.unit}"
