"""The part of a map that is kept, with the roads that were built there: what scenery is laid out against."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from studio.road.formats.osm import Box, Thing
from studio.road.formats.way import Way
from studio.road.network import Net
from studio.road.network.outline import road_form


@dataclass(frozen=True, eq=False)
class Site:
    """The box, the car ways within it, and the network that was made of them."""

    box: Box
    ways: list[Way]
    net: Net
    left_hand: bool

    @cached_property
    def bounds(self) -> BaseGeometry:
        """The box as a plane shape [m]."""
        form = shapely.box(*self.box.bounds())
        shapely.prepare(form)
        return form

    @cached_property
    def road(self) -> BaseGeometry:
        """The carriageway as a plane shape [m]."""
        form = road_form(self.net)
        shapely.prepare(form)
        return form

    def line(self, of: Way | Thing) -> np.ndarray:
        """A mapped line in local metres, float64[2, n]."""
        return self.box.local(*np.array(of.points).T[::-1])

    def place(self, of: Thing) -> np.ndarray:
        """A mapped point in local metres, float64[2]."""
        return self.line(of)[:, 0]
