"""What a unit sends, or what everybody sends, takes longer by a time while the entry acts."""

from pydantic import Field

from studio.kind.settings import Part, UnitName, number
from studio.world.effect import Delay

KIND = "action"
TITLE = "Delay messages"


class Settings(Part):
    """Whose, and by how much."""

    unit: UnitName | None = Field(None, title="Unit", description="that sends; left out: everybody")
    added_delay: float = number(..., unit="s", title="Delay", description="on top of that of the radio", ge=0, le=2)


def effects(settings, place):
    """Everything comes later."""
    return [Delay(settings.unit, settings.added_delay)]


def told(settings):
    """In words."""
    return f"messages {settings.added_delay:g} s later"
