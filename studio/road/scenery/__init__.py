"""What lies and stands beside the road: buildings with their parts, ground, trees, walls, posts, crossings, parking."""

import re
from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from studio.road.formats.kind import BARRIERS, POSTS, area_kind, metres
from studio.road.formats.osm import Box, Shape, Survey
from studio.road.network import Area, Building, Post, Scenery, Wall
from studio.road.network.plane import lines, polygon, polygons, rings
from studio.road.scenery import parking
from studio.road.scenery.crossing import crossings
from studio.road.scenery.site import Site

LEVEL = 3.0  # [m] one floor
USUAL_HEIGHT = 9.0  # [m] three floors, where nothing is mapped
GROUNDS = ("sand", "square", "parking", "green", "water")  # from below
TREE_SPACING = 9.0  # [m] in a row
BOLLARD_SPACING = 1.8  # [m] in a line
KERB = 0.3  # [m] between the road and a wall
PASSAGE = 4.5  # [m] clear height over a road (StVZO § 32: vehicles are 4.00 m high at the most)
TOUCH = 0.5  # [m²] of a building on the road is a matter of the mapper's pencil
LARGEST_HEIGHT = 900.0  # [m] above this the tag is a slip
COLOURS = {
    "white": "#f4f4f2",
    "grey": "#9a9a98",
    "gray": "#9a9a98",
    "black": "#303030",
    "brown": "#8a6a4f",
    "red": "#a8483c",
    "yellow": "#d9c27a",
    "beige": "#d8cbb0",
    "green": "#6f8a62",
    "blue": "#5f7d9c",
    "silver": "#b8bcc0",
    "gold": "#d4af37",
    "orange": "#cf8a4a",
    "pink": "#d9a8a4",
    "tan": "#c9ad86",
}


def scenery(found: Survey, site: Site) -> Scenery:
    """Everything beside the roads of a site; what is guessed or skipped is noted."""
    shapes = [(shape, shape_form(shape, site.box)) for shape in found.shapes]
    shapes = [(shape, form) for shape, form in shapes if not form.is_empty and form.intersects(site.bounds)]
    standing, ground = tuple(passable(buildings(shapes, site.bounds), site.road)), tuple(areas(shapes, site.bounds))
    crossed, planted, spaces = tuple(crossings(found, site)), trees(found, site), parking.mapped(found, site, shapes)
    beside = parking.along_kerbs(found, site, parking.taken_by(ground, standing, crossed, spaces, planted))
    return Scenery(
        buildings=standing,
        areas=ground,
        trees=planted,
        spaces=np.concatenate([spaces, beside], axis=1),
        along_kerbs=beside.shape[1],
        crossings=crossed,
        walls=tuple(walls(found, site)),
        posts=tuple(posts(found, site)),
    )


def shape_form(shape: Shape, box: Box) -> BaseGeometry:
    """A mapped shape in local metres, mended if its ring crosses itself."""
    rings = [box.local(*np.array(ring).T[::-1]).T for ring in shape.rings]
    form = shapely.Polygon(rings[0], [ring for ring in rings[1:] if len(ring) > 3]) if len(rings[0]) > 3 else None
    return shapely.make_valid(form) if form is not None else shapely.Polygon()


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


def passable(standing: Iterator[Building], road: BaseGeometry) -> Iterator[Building]:
    """The buildings with a passage where one stands over the road; what is too low for one ends at the kerb."""
    for building in standing:
        form = polygon(building)
        over = road.intersection(form) if building.base < PASSAGE and road.intersects(form) else shapely.Polygon()
        if over.area < TOUCH:
            yield building
            continue
        for one in polygons(form.difference(over.buffer(KERB, join_style="mitre"))):
            yield cut_to(building, one)
        if building.height > PASSAGE + 1.0:
            for one in polygons(form.intersection(over.buffer(KERB, join_style="mitre"))):
                yield replace(cut_to(building, one), base=PASSAGE)


def cut_to(building: Building, form: shapely.Polygon) -> Building:
    """The building, cut to a plane shape."""
    outline, holes = rings(form)
    return replace(building, outline=outline, holes=holes)


def is_told_by_parts(form: BaseGeometry, tree: shapely.STRtree) -> bool:
    """Whether building parts stand on most of an outline: then they are the building, and the outline is not drawn."""
    near = tree.geometries[tree.query(form, predicate="intersects")]
    return len(near) > 0 and shapely.union_all(near).intersection(form).area > 0.5 * form.area


def prisms(shape: Shape, form: BaseGeometry) -> Iterator[Building]:
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
    """Ground of another colour, cut at the bounds."""
    for shape, form in shapes:
        kind = area_kind(shape.tags)
        if kind in GROUNDS:
            for one in polygons(form.intersection(bounds)):
                yield Area(kind, *rings(one))


# -- what stands upright ---------------------------------------------------------------------------


def trees(found: Survey, site: Site) -> np.ndarray:
    """Positions of the trees of a site, float64[2, n]; a row of trees has one every `TREE_SPACING`."""
    single = [site.place(thing) for thing in found.points if thing.kind == "tree"]
    rows = [spaced(site.line(thing), TREE_SPACING) for thing in found.lines if thing.kind == "tree_row"]
    places = np.concatenate([np.reshape(single, (-1, 2)).T, *rows], axis=1)
    return places[:, shapely.contains_xy(site.bounds, *places)]


def spaced(line: np.ndarray, spacing: float) -> np.ndarray:
    """Points along a line from its start to its end, about `spacing` [m] apart, float64[2, n]."""
    form = shapely.LineString(line.T)
    count = max(1, round(form.length / spacing))
    return shapely.get_coordinates(shapely.line_interpolate_point(form, np.linspace(0.0, form.length, count + 1))).T


def walls(found: Survey, site: Site) -> Iterator[Wall]:
    """Walls, fences and hedges of a site; none stands on the road."""
    free = site.bounds.difference(site.road.buffer(KERB))
    shapely.prepare(free)
    for thing in found.lines:
        if thing.kind in BARRIERS:
            height, thickness = BARRIERS[thing.kind]
            form = shapely.LineString(site.line(thing).T)
            for line in lines(form if free.contains(form) else form.intersection(free)):
                yield Wall(thing.kind, line, metres(thing.tags.get("height", "")) or height, thickness)


def posts(found: Survey, site: Site) -> Iterator[Post]:
    """Lamps, poles and bollards of a site; none stands on the road."""
    things = [(thing, site.line(thing)) for thing in found.points if thing.kind in POSTS]
    things += [(thing, spaced(site.line(thing), BOLLARD_SPACING)) for thing in found.lines if thing.kind in POSTS]
    for thing, places in things:
        height, thickness = POSTS[thing.kind]
        free = shapely.contains_xy(site.bounds, *places) & ~shapely.contains_xy(site.road, *places)
        for x, y in places[:, free].T.tolist():
            yield Post(thing.kind, x, y, metres(thing.tags.get("height", "")) or height, thickness)
