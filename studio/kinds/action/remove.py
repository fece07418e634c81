"""A vehicle is taken away: it takes no part any more, until it is put somewhere."""

from pydantic import Field

from studio.kind.settings import Part, VehicleName
from studio.world.effect import Removal

KIND = "action"
TITLE = "Take a vehicle away"
MOMENTARY = True


class Settings(Part):
    """Who."""

    vehicle: VehicleName = Field(..., title="Vehicle")


def effects(settings, place):
    """It is gone."""
    return [Removal(settings.vehicle)]


def told(settings):
    """In words."""
    return f"{settings.vehicle} is taken away"
