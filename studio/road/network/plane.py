"""Plane shapes: polygons out of whatever a geometry has become, and their rings as arrays."""

from collections.abc import Iterator

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry


def polygons(form: BaseGeometry) -> Iterator[shapely.Polygon]:
    """The polygons of a geometry, whatever it has become, outline counter-clockwise."""
    for part in shapely.get_parts(form):
        if part.geom_type == "Polygon" and part.area > 0.01:
            yield shapely.geometry.polygon.orient(part)
        elif part.geom_type in ("MultiPolygon", "GeometryCollection"):
            yield from polygons(part)


def lines(form: BaseGeometry) -> Iterator[np.ndarray]:
    """The lines of a geometry, float64[2, n]."""
    for part in shapely.get_parts(form):
        if part.geom_type == "LineString" and part.length > 0.0:
            yield np.array(part.coords, dtype=float)[:, :2].T.copy()
        elif part.geom_type in ("MultiLineString", "GeometryCollection"):
            yield from lines(part)


def ring(coordinates) -> np.ndarray:
    """An open ring, float64[2, n]."""
    return np.array(coordinates, dtype=float)[:-1, :2].T.copy()


def rings(form: shapely.Polygon) -> tuple[np.ndarray, tuple[np.ndarray, ...]]:
    """Outline and holes of a polygon."""
    return ring(form.exterior.coords), tuple(ring(hole.coords) for hole in form.interiors)


def polygon(thing) -> BaseGeometry:
    """The plane shape of something with `outline` and `holes`, mended if a ring crosses itself."""
    return shapely.make_valid(shapely.Polygon(thing.outline.T, [hole.T for hole in thing.holes]))


def rectangles(x, y, heading, length, width) -> np.ndarray:
    """Rectangles about centres [m], turned by `heading` [rad], as an array of polygons."""
    c, s = np.cos(heading), np.sin(heading)
    along, left = np.array([-1, 1, 1, -1])[:, None] * length / 2.0, np.array([-1, -1, 1, 1])[:, None] * width / 2.0
    corners = np.stack([x + along * c - left * s, y + along * s + left * c], axis=-1)
    return np.asarray(shapely.polygons(corners.transpose(1, 0, 2)))
