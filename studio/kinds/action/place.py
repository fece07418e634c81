"""A vehicle is put on its route at a station, rolling with a speed; also one that was taken away, or that has arrived."""

from typing import Annotated

from pydantic import Field

from studio.kind.settings import Part, StationOf, VehicleName, number
from studio.world.effect import Placement

KIND = "action"
TITLE = "Put a vehicle somewhere"
MOMENTARY = True


class Settings(Part):
    """Who, where, and how fast."""

    vehicle: VehicleName = Field(..., title="Vehicle")
    along: Annotated[float, StationOf("vehicle")] = number(..., unit="m", title="Along its route", ge=0)
    speed: float = number(0.0, unit="m/s", title="Speed", ge=0, le=70)


def effects(settings, place):
    """There it is."""
    return [Placement(settings.vehicle, settings.along, settings.speed)]


def told(settings):
    """In words."""
    return f"put at {settings.along:g} m with {settings.speed:g} m/s"


def fastest(settings):
    """What the vehicle must be able to drive [m/s]."""
    return settings.speed
