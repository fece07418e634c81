"""Draws a place by hand: streets and areas in local metres, written as an OpenStreetMap file like any other map.

    drawing = Drawing(); drawing.way([(0, 0), (100, 0)], highway="residential"); drawing.write(path)

Points at the same place (to the millimetre) are one node, so that what is drawn through the same point is joined there.
"""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from studio.errors import MapError
from studio.road.formats.osm import GENERATOR, Box, element, tags

Point = tuple[float, float]
Place = Sequence[float] | np.ndarray
MIDDLE = (52.0, 10.0)  # [deg] where drawn places lie: in Germany, where one drives on the right


class Drawing:
    """Nodes, ways and their tags; in names of tags "__" stands for ":"."""

    def __init__(self, *, reach: float) -> None:
        """An empty drawing that reaches so far from its middle to every side [m]."""
        self.box = Box(*MIDDLE, *MIDDLE).around(reach)
        self.nodes: dict[Point, dict[str, str]] = {}
        self.numbers: dict[Point, int] = {}
        self.ways: list[tuple[list[Point], dict[str, str]]] = []

    def node(self, place: Place, **text: str) -> Point:
        """A point with these tags; a point that is there already gets them too."""
        key = (round(float(place[0]), 3) + 0.0, round(float(place[1]), 3) + 0.0)
        self.numbers.setdefault(key, len(self.numbers) + 1)
        self.nodes.setdefault(key, {}).update(named(text))
        return key

    def way(self, places: Sequence[Place], **text: str) -> None:
        """A line through places."""
        self.ways.append(([self.node(place) for place in places], named(text)))

    def area(self, places: Sequence[Place], **text: str) -> None:
        """The area within a ring of places."""
        self.way([*places, places[0]], **text)

    def rectangle(self, x0: float, y0: float, x1: float, y1: float, **text: str) -> None:
        """An area along the axes."""
        self.area([(x0, y0), (x1, y0), (x1, y1), (x0, y1)], **text)

    def xml(self) -> str:
        """The drawing as OSM XML."""
        degrees = self.box.degrees(np.array(list(self.nodes)).T)
        lines = ['<?xml version="1.0" encoding="UTF-8"?>', f'<osm version="0.6" generator="{GENERATOR}">']
        box = {"minlat": self.box.south, "minlon": self.box.west, "maxlat": self.box.north, "maxlon": self.box.east}
        lines += element("bounds", {name: f"{value:.7f}" for name, value in box.items()}, [])
        for (place, text), (longitude, latitude) in zip(self.nodes.items(), degrees, strict=True):
            lines += element(
                "node", {"id": self.numbers[place], "version": 1, "lat": f"{latitude:.9f}", "lon": f"{longitude:.9f}"}, tags(text)
            )
        for number, (places, text) in enumerate(self.ways, start=1):
            lines += element(
                "way", {"id": number, "version": 1}, [*(f'<nd ref="{self.numbers[place]}"/>' for place in places), *tags(text)]
            )
        return "\n".join([*lines, "</osm>", ""])

    def write(self, path: Path) -> None:
        """Writes the file.

        Raises:
            MapError: its name does not end in .osm, or the disk does not take it.
        """
        if not path.name.endswith(".osm"):
            raise MapError(f"{path}: a generated map is written as .osm; choose a name with this ending")
        try:
            path.write_text(self.xml(), encoding="utf-8")
        except OSError as error:
            raise MapError(f"{path}: the map cannot be written ({error.strerror or error})") from None


def named(text: dict[str, str]) -> dict[str, str]:
    """Tags with their real names."""
    return {key.replace("__", ":"): value for key, value in text.items()}
