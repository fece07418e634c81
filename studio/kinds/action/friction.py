"""The road becomes more or less slippery: ice, leaves, spilt oil, new asphalt."""

from typing import Literal

from pydantic import Field

from studio.kind.settings import number
from studio.kind.stretch import Stretch
from studio.world.effect import Slippery

KIND = "action"
TITLE = "Change the friction"


class Settings(Stretch):
    """Where, how wide, and how slippery."""

    friction: float = number(..., unit="1", title="Friction", description="over that of a dry test track", ge=0.02, le=1.5)
    width: float = number(3.5, unit="m", title="Width", ge=0.2, le=20)
    side: Literal["both", "left", "right"] = Field("both", title="Side", description="of the line of route or lane")


def effects(settings, place):
    """Slippery ground on both sides of the line, or on one."""
    left = 0.0 if settings.side == "right" else 0.5 * settings.width
    right = 0.0 if settings.side == "left" else 0.5 * settings.width
    return [Slippery(settings, settings.friction, left, right)]


def told(settings):
    """In words."""
    return f"friction {settings.friction:g}"
