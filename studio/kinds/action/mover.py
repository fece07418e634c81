"""Somebody appears, moves along a line and is gone: on foot, on a bicycle, or a box of any size. It may stand, too.

Sensors see it, drivers brake for it once it is in their way, and cars hit it. Who comes on foot to a zebra crossing without lights is let
cross, from 4 s before his first step onto it. It does not mind anybody. Its name is that of its entry, and `until` takes it away.
Sizes: the adult and the bicyclist of the Euro NCAP targets, 0.6 m by 0.5 m and 1.9 m by 0.6 m; 5 km/h is a walking, 8 km/h a running
person, 15 km/h a bicycle (Euro NCAP, AEB VRU test protocol).
"""

from itertools import pairwise
from typing import Annotated, Literal

from pydantic import Field, model_validator

from studio.kind.settings import Part, RouteName, number
from studio.world.effect import Walk

KIND = "action"
TITLE = "Somebody appears and moves"
MOVES = True
Corner = Annotated[tuple[float, float], Field(json_schema_extra={"unit": "m"})]
SIZES = {"pedestrian": (0.6, 0.5), "cyclist": (1.9, 0.6), "box": (1.0, 1.0)}  # [m] length and width

LEVEL = "where roads lie above each other, on which it begins, 1 on a bridge, -1 in a tunnel; left out: on the route, or the land"


class Settings(Part):
    """Who, where, and how fast."""

    who: Literal["pedestrian", "cyclist", "box"] = Field("pedestrian", title="Who")
    route: RouteName | None = Field(None, title="Along the route", description="left out: the line is given on the map")
    line: list[Corner] = Field(
        [(0.0, -6.0), (0.0, 6.0)],
        min_length=1,
        max_length=200,
        title="Line",
        description="its corners: station along the route and how far to its left, or east and north on the map; one: it stands there",
    )
    speed: float = number(1.39, unit="m/s", title="Speed", ge=0, le=30)
    level: int | None = Field(None, ge=-10, le=10, title="Level", description=LEVEL)
    stays: bool = Field(True, title="Stays", description="at the end of its line; else it is gone")
    length: float | None = Field(None, gt=0.05, le=20, title="Length", json_schema_extra={"unit": "m"})
    width: float | None = Field(None, gt=0.05, le=5, title="Width", json_schema_extra={"unit": "m"})

    @model_validator(mode="after")
    def goes_on(self):
        if self.route is not None and self.level is not None:
            raise ValueError("a line along a route begins on the level of the route: leave out the level")
        if any(one == other for one, other in pairwise(self.line)):
            raise ValueError("two corners of the line that follow each other must not be one")
        return self


def effects(settings, place):
    """One who moves."""
    length, width = SIZES[settings.who]
    size = (settings.length or length, settings.width or width)
    line, height = place.on_map(settings.route, settings.line), place.height(settings.route, settings.line[0][0])
    return [Walk(settings.who, line, settings.speed, settings.stays, size, settings.level, height)]


def told(settings):
    """In words."""
    return f"{settings.who} appears" if len(settings.line) == 1 else f"{settings.who} moves with {settings.speed:g} m/s"
