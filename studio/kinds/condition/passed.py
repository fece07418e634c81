"""A vehicle has passed a place: its centre of gravity is at a station of its route, or beyond."""

from typing import Annotated

from pydantic import Field

from studio.compiled import compiled
from studio.kind.settings import Part, StationOf, VehicleName, number
from studio.world.condition import is_about, station

KIND = "condition"
TITLE = "A vehicle has passed a place"


class Settings(Part):
    """Who, and where."""

    vehicle: VehicleName = Field(..., title="Vehicle", description="whose centre of gravity passes the station")
    along: Annotated[float, StationOf("vehicle")] = number(..., unit="m", title="Along its route", ge=0)


@compiled
def holds(view, settings):
    """While the vehicle is about."""
    v = int(settings.vehicle)
    return is_about(view, v) and station(view, v) >= settings.along
