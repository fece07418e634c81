"""A vehicle is in an area: the middle of its outline is within a circle, a polygon, or a stretch of a lane."""

from pydantic import Field

from studio.compiled import compiled
from studio.kind.area import Area
from studio.kind.settings import BodyName, Part
from studio.world.condition import body, is_within

KIND = "condition"
TITLE = "A vehicle is in an area"


class Settings(Part):
    """Who, and where."""

    vehicle: BodyName = Field(..., title="Vehicle", description="or somebody that an entry of the script brings")
    area: Area = Field(..., title="Area")


@compiled
def holds(view, settings):
    """While it is there."""
    who = body(view, int(settings.vehicle))
    return who.is_there and is_within(view, who.x, who.y, settings.area)


def never(settings, place):
    """Not in one that lies beside the map."""
    return "the area lies off the map" if place.is_off_map(settings.area) else ""
