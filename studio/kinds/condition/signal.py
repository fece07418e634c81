"""Lights show a colour: those at the end of a road, all lanes of which show the same, or the next ones on the way of a vehicle."""

from math import inf
from typing import Literal

from pydantic import Field, model_validator

from studio.compiled import compiled
from studio.kind.settings import Part, SignalName, VehicleName
from studio.vehicle.parameter import FRONT
from studio.world.condition import is_about
from studio.world.table.mind import STATION

KIND = "condition"
TITLE = "A light shows a colour"


class Settings(Part):
    """Which lights, and what they show."""

    road: SignalName | None = Field(None, title="Road", description="with the lights at its end")
    vehicle: VehicleName | None = Field(None, title="Vehicle", description="whose next lights they are")
    shows: Literal["red", "red_amber", "green", "amber"] = Field("red", title="Shows")

    @model_validator(mode="after")
    def names_one(self):
        if (self.road is None) == (self.vehicle is None):
            raise ValueError("give either `road` or `vehicle`")
        return self


def never(settings, place):
    """Not where there are none."""
    return "" if place.lit else "there are no lights on this map"


@compiled
def next_light(view, v):
    """The number of the first light ahead of a vehicle's front; -1 when there is none."""
    best, nearest = -1, inf
    for i in range(view.stop_first[v], view.stop_first[v] + view.stop_count[v]):
        distance = view.stop_station[i] - view.mind[STATION, v] - view.parameter[FRONT, v]
        if 0.0 < distance < nearest:
            best, nearest = view.stop_link[i], distance
    return best


@compiled
def holds(view, settings):
    """What they have shown since the tick before; the colours count as in the programmes of signals."""
    light = -1
    if settings.road == settings.road:
        light = int(settings.road)
    elif is_about(view, int(settings.vehicle)):
        light = next_light(view, int(settings.vehicle))
    return light >= 0 and view.shown[light] == int(settings.shows)
