"""The limit is lowered on all lanes of a stretch; drivers slow down before it."""

from studio.kind.settings import number
from studio.kind.stretch import Stretch
from studio.world.effect import Limit

KIND = "action"
TITLE = "Lower the limit"


class Settings(Stretch):
    """Where, and to which speed."""

    speed: float = number(..., unit="m/s", title="Limit", ge=1, le=70)


def effects(settings, place):
    """A limit."""
    return [Limit(settings, settings.speed)]


def told(settings):
    """In words."""
    return f"limit {settings.speed:g} m/s"
