"""A row of objects is put along a stretch; drivers brake for what stands in their way."""

from typing import Literal

from pydantic import Field

from studio.kind.settings import number
from studio.kind.stretch import Stretch
from studio.world.effect import Row

KIND = "action"
TITLE = "Put objects on the road"


class Settings(Stretch):
    """Where, which, and how far from each other."""

    what: Literal["cones", "barriers"] = Field("cones", title="What", description="a radar sees barriers, and no cones")
    spacing: float = number(5.0, unit="m", title="Spacing", ge=0.5, le=100)
    offset: float = number(0.0, unit="m", title="Offset", description="to the left of the line of route or lane", ge=-20, le=20)


def effects(settings, place):
    """One row."""
    return [Row(settings, settings.what, settings.spacing, settings.offset)]


def told(settings):
    """In words."""
    return f"{settings.what} on the road"
