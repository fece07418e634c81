"""What stands beside the road: buildings with their parts, green and water, trees."""

import re
from collections.abc import Iterator

import numpy as np
import shapely

from studio.road.network import Area, Building, Scenery
from studio.road.osm import Box, Shape, Survey, area_kind

LEVEL = 3.0  # [m] one floor
USUAL_HEIGHT = 9.0  # [m] three floors, where nothing is mapped
LARGEST_HEIGHT = 900.0  # [m] above this the tag is a slip
FEET = 0.3048  # [m]
COLOURS = {
    **{"white": "#f4f4f2", "grey": "#9a9a98", "gray": "#9a9a98", "black": "#303030", "brown": "#8a6a4f"},
    **{"red": "#a8483c", "yellow": "#d9c27a", "beige": "#d8cbb0", "green": "#6f8a62", "blue": "#5f7d9c"},
    **{"silver": "#b8bcc0", "gold": "#d4af37", "orange": "#cf8a4a", "pink": "#d9a8a4", "tan": "#c9ad86"},
}


def scenery(found: Survey, box: Box) -> Scenery:
    """Buildings, ground areas and trees within the box."""
    bounds = shapely.box(*box.bounds())
    shapes = [(shape, shape_form(shape, box)) for shape in found.shapes]
    shapes = [(shape, form) for shape, form in shapes if not form.is_empty and form.intersects(bounds)]
    return Scenery(
        buildings=tuple(buildings(shapes, bounds)),
        areas=tuple(areas(shapes, bounds)),
        trees=trees(found, box),
    )


def shape_form(shape: Shape, box: Box) -> shapely.Geometry:
    """A mapped shape in local metres, mended if its ring crosses itself."""
    rings = [box.local(*np.array(ring).T[::-1]).T for ring in shape.rings]
    form = (
        shapely.Polygon(rings[0], [ring for ring in rings[1:] if len(ring) > 3])
        if len(rings[0]) > 3
        else None
    )
    return shapely.make_valid(form) if form is not None else shapely.Polygon()


def polygons(form: shapely.Geometry) -> Iterator[shapely.Polygon]:
    """The polygons of a geometry, whatever it has become, outline counter-clockwise."""
    for part in shapely.get_parts(form):
        if part.geom_type == "Polygon" and part.area > 0.01:
            yield shapely.geometry.polygon.orient(part)
        elif part.geom_type in ("MultiPolygon", "GeometryCollection"):
            yield from polygons(part)


def ring(coordinates) -> np.ndarray:
    """An open ring, float64[2, n]."""
    return np.array(coordinates, dtype=float)[:-1, :2].T.copy()


def rings(form: shapely.Polygon) -> tuple[np.ndarray, tuple[np.ndarray, ...]]:
    """Outline and holes of a polygon."""
    return ring(form.exterior.coords), tuple(ring(hole.coords) for hole in form.interiors)


# -- buildings -------------------------------------------------------------------------------------


def buildings(shapes, bounds) -> Iterator[Building]:
    """What is drawn of buildings and their parts."""
    parts = [(shape, form) for shape, form in shapes if area_kind(shape.tags) == "part"]
    tree = shapely.STRtree([form for _, form in parts])
    for shape, form in shapes:
        kind = area_kind(shape.tags)
        drawn = kind == "part" or (kind == "building" and not is_told_by_parts(form, tree))
        if drawn and bounds.contains(form.centroid):
            yield from prisms(shape, form)


def is_told_by_parts(form: shapely.Geometry, tree: shapely.STRtree) -> bool:
    """Whether building parts stand on most of an outline: then they are the building, and the outline is not drawn."""
    near = tree.geometries[tree.query(form, predicate="intersects")]
    return len(near) > 0 and shapely.union_all(near).intersection(form).area > 0.5 * form.area


def prisms(shape: Shape, form: shapely.Geometry) -> Iterator[Building]:
    """The solids of one mapped building or part."""
    height, base = extent(shape.tags)
    for one in polygons(form):
        outline, holes = rings(one)
        yield Building(outline, holes, height, base, colour(shape.tags))


def extent(tags: dict[str, str]) -> tuple[float, float]:
    """Height of the top and of the underside above the ground [m]."""
    height = metres(tags.get("height", "")) or levels(tags.get("building:levels", "")) or USUAL_HEIGHT
    base = metres(tags.get("min_height", "")) or levels(tags.get("building:min_level", ""))
    return (height, base) if base < height <= LARGEST_HEIGHT else (USUAL_HEIGHT, 0.0)


def has_height(tags: dict[str, str]) -> bool:
    """Whether a height or a number of floors is mapped that can be read."""
    return bool(metres(tags.get("height", "")) or levels(tags.get("building:levels", "")))


def metres(text: str) -> float:
    """A mapped length [m]: "12", "12.5 m", "12,5" or "40'"; 0 for what cannot be read.

    >>> metres("12,5 m"), metres("10'"), metres("tall")
    (12.5, 3.048, 0.0)
    """
    found = re.match(r"\s*(\d+(?:[.,]\d+)?)\s*(m|ft|feet|')?", text)
    if not found:
        return 0.0
    value = float(found[1].replace(",", "."))
    return round(value * FEET, 6) if found[2] in ("ft", "feet", "'") else value


def levels(text: str) -> float:
    """Height of a mapped number of floors [m]."""
    return metres(text) * LEVEL


def colour(tags: dict[str, str]) -> str:
    """The mapped colour as "#rrggbb", or "" when none is mapped that is known."""
    text = (tags.get("building:colour") or tags.get("building:color") or "").strip().lower()
    if re.fullmatch(r"#[0-9a-f]{6}", text):
        return text
    if re.fullmatch(r"#[0-9a-f]{3}", text):
        return "#" + "".join(2 * digit for digit in text[1:])
    return COLOURS.get(text, "")


# -- ground ----------------------------------------------------------------------------------------


def areas(shapes, bounds) -> Iterator[Area]:
    """Green and water, cut at the bounds."""
    for shape, form in shapes:
        kind = area_kind(shape.tags)
        if kind in ("green", "water"):
            for one in polygons(form.intersection(bounds)):
                yield Area(kind, *rings(one))


def trees(found: Survey, box: Box) -> np.ndarray:
    """Positions of the trees within the box, float64[2, n]."""
    if not found.trees:
        return np.empty((2, 0))
    x0, y0, x1, y1 = box.bounds()
    x, y = box.local(*np.array(found.trees).T[::-1])
    inside = (x0 < x) & (x < x1) & (y0 < y) & (y < y1)
    return np.array([x[inside], y[inside]])
