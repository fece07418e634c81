"""Single parking spaces: mapped ones with the heading in which one drives in, and those along kerbs that only tags tell of.

A mapped space says where it lies, not where its opening is: that is the side towards the nearest aisle or street. Along
streets, spaces are laid beside the kerb lane wherever the way's tags allow parking.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from studio.portable import arctan2, cross, dot, wrapped
from studio.road.formats.kind import area_kind
from studio.road.formats.osm import Survey, Thing
from studio.road.formats.way import Way, is_one_way, spot_of
from studio.road.network import SPACE_ROWS, Area, Building, Crossing, Lane, Road, curve
from studio.road.network.plane import polygon, rectangles
from studio.road.scenery.site import Site

USUAL = (5.0, 2.5)  # [m] length and width of a space (EAR 05), where only its point is mapped
SMALLEST = 4.0  # [m²] of a mapped space; what is smaller is for bicycles
SIDEWAYS = 0.5  # an aisle lies beside a space, not before it, if its way there is so much shorter along than across
AISLE = 15.0  # [m] what is farther off is not the space's own aisle
KERB_DEPTH = 6.0  # [m] that spaces along a kerb reach to the side
CLEAR = 5.0  # [m] without parking before and behind junctions and crossings (StVO § 12 (3) 1, § 26)
OVERHEAD = 3.0  # [m] a building that hangs higher leaves room below
TRUNK = 0.4  # [m] about a tree
DRIVEWAY = 2.0  # [m] free on both sides of a service way's line
# along a kerb: angle of the space to the lane [rad], step along it, length and width of a space [m] (RASt 06, EAR 05)
SLANT = np.radians(60.0)
KERBSIDE = {
    "parallel": (0.0, 5.7, 5.2, 2.0),
    "diagonal": (SLANT, 2.5 / np.sin(SLANT), 5.0, 2.5),
    "perpendicular": (np.pi / 2.0, 2.5, 5.0, 2.5),
}
ON_STREET = {"lane", "street_side", "on_kerb", "half_on_kerb", "shoulder", "yes"}


def mapped(found: Survey, site: Site, shapes) -> np.ndarray:
    """The mapped spaces of a site, float64[SPACE_ROWS, n]; `shapes` are pairs of mapped shape and plane form."""
    aisles = Aisles.of([*site.ways, *found.service], site)
    rows = [row for shape, form in shapes if area_kind(shape.tags) == "space" for row in in_area(shape.tags, form, aisles, site)]
    rows += [at_point(thing, aisles, site, found) for thing in found.points if thing.kind == "space"]
    table = np.array(rows).reshape(-1, SPACE_ROWS).T
    return table[:, shapely.contains_xy(site.bounds, *table[:2])]


# -- mapped spaces ---------------------------------------------------------------------------------


@dataclass(frozen=True, eq=False)
class Aisles:
    """The lines that one parks from: streets and service ways; `one_way` tells which are driven one way only."""

    tree: shapely.STRtree
    one_way: np.ndarray

    @classmethod
    def of(cls, ways: list[Way], site: Site) -> "Aisles":
        """Those of these ways."""
        return cls(shapely.STRtree([shapely.LineString(site.line(way).T) for way in ways]), np.array([is_one_way(way) for way in ways]))

    def beside(self, place: np.ndarray) -> tuple[np.ndarray, np.ndarray, bool] | None:
        """The nearest point of an aisle, its direction there, and whether it is one-way."""
        point = shapely.Point(place)
        found = self.tree.query_nearest(point, max_distance=AISLE, all_matches=False)
        if not len(found):
            return None
        line = self.tree.geometries[found[0]]
        s = line.project(point)
        foot, a, b = (np.array(line.interpolate(at).coords[0]) for at in (s, max(0.0, s - 0.5), min(line.length, s + 0.5)))
        return foot, (b - a) / max(1e-9, np.hypot(*(b - a))), bool(self.one_way[found[0]])


def in_area(tags: dict[str, str], form: BaseGeometry, aisles: Aisles, site: Site) -> Iterator[tuple[float, ...]]:
    """The spaces of a mapped outline: one, or as many side by side as its capacity says."""
    if form.area < SMALLEST:
        return
    corners = shapely.get_coordinates(shapely.minimum_rotated_rectangle(form))
    sides = np.diff(corners[:3], axis=0)
    long, short = sorted(sides, key=lambda side: -np.hypot(*side))
    text = tags.get("capacity", "")
    count = int(text) if text.isdigit() and 0 < int(text) <= np.hypot(*long) else 1
    each, middle = long / count, corners[:4].mean(axis=0)
    for i in range(count):
        place = middle + (i - (count - 1) / 2.0) * each
        axis, across = sorted((each, short), key=lambda side: -np.hypot(*side))
        yield (*place, inward(place, arctan2(axis[1], axis[0]), aisles, site), np.hypot(*axis), np.hypot(*across))


def inward(place: np.ndarray, axis: float, aisles: Aisles, site: Site) -> float:
    """The heading [rad] of a car in a space whose long side has this direction: away from its aisle, or along it with the traffic."""
    near = aisles.beside(place)
    if near is None:
        return float(axis)
    foot, along, one_way = near
    ahead, aside = np.array([np.cos(axis), np.sin(axis)]), foot - place
    if abs(dot(aside, ahead)) >= SIDEWAYS * abs(cross(ahead, aside)):
        turned = dot(aside, ahead) > 0.0
    else:
        right_of_it = cross(along, aside) > 0.0  # the space, seen along the aisle
        with_it = one_way or right_of_it != site.left_hand
        turned = (dot(along, ahead) > 0.0) != with_it
    return float(wrapped(axis + np.pi * turned))


def at_point(thing: Thing, aisles: Aisles, site: Site, found: Survey) -> tuple[float, ...]:
    """The space at a mapped point: of the usual size, straight away from its aisle."""
    place = site.place(thing)
    near = aisles.beside(place)
    away = place - near[0] if near is not None else np.array([1.0, 0.0])
    found.notes.guess("parking space", f"{USUAL[0]:g} m by {USUAL[1]:g} m", thing.spot, source="a point only", sure="low")
    return (*place, float(arctan2(away[1], away[0])), *USUAL)


# -- along kerbs -----------------------------------------------------------------------------------


def kerbs(tags: dict[str, str]) -> dict[str, str]:
    """How one parks on the "left" and "right" of a way: a key of `KERBSIDE`; no entry where one does not, or where it is mapped apart.

    >>> kerbs({"parking:lane:both": "parallel"})
    {'left': 'parallel', 'right': 'parallel'}
    >>> kerbs({"parking:right": "lane", "parking:right:orientation": "diagonal", "parking:left": "no"})
    {'right': 'diagonal'}
    """
    found = {}
    for side in ("left", "right"):
        old = tags.get(f"parking:lane:{side}", tags.get("parking:lane:both"))
        new = tags.get(f"parking:{side}", tags.get("parking:both"))
        turned = tags.get(f"parking:{side}:orientation", tags.get("parking:both:orientation", ""))
        if new in ON_STREET or old == "marked":
            found[side] = turned if turned in KERBSIDE else "parallel"
        elif old in KERBSIDE:
            found[side] = old
    return found


def along_kerbs(found: Survey, site: Site, taken: list[BaseGeometry]) -> np.ndarray:
    """The spaces beside the lanes of ways that allow parking, float64[SPACE_ROWS, n]; none on the road, a driveway or what is `taken`."""
    by_id = {way.id: way for way in site.ways if kerbs(way.tags)}
    note_kerbs(found, list(by_id.values()))
    rows = [np.empty((SPACE_ROWS, 0))]
    for road in site.net.roads.values():
        ways = [by_id[name] for name in site.net.origins.get(road.id, ()) if name in by_id]
        if ways and not road.internal:
            rows += rows_beside(road, ways, site)
    table = np.concatenate(rows, axis=1)
    table = table[:, shapely.contains_xy(site.bounds, *table[:2])]
    x, y, heading, length, width = table
    forms = rectangles(x, y, heading, length + 0.2, width - 0.2)
    driveways = [shapely.LineString(site.line(way).T).buffer(DRIVEWAY) for way in found.service]
    struck, _ = shapely.STRtree([*taken, *driveways]).query(forms, predicate="intersects")
    free = ~shapely.intersects(site.road, forms)
    free[struck] = False
    return without_overlap(table[:, free], forms[free])


def note_kerbs(found: Survey, ways: list[Way]) -> None:
    """Notes that places and sizes of the spaces along kerbs are guessed."""
    for way in ways:
        what = ", ".join(f"{side} {how}" for side, how in kerbs(way.tags).items())
        found.notes.guess("parking along a kerb", what, spot_of(way), source="parking:* of the way", sure="medium")


def taken_by(
    areas: tuple[Area, ...], buildings: tuple[Building, ...], crossings: tuple[Crossing, ...], spaces: np.ndarray, trees: np.ndarray
) -> list[BaseGeometry]:
    """The plane shapes on which no space is laid."""
    forms = [polygon(area) for area in areas if area.kind in ("parking", "water")]
    forms += [shapely.Polygon(building.outline.T) for building in buildings if building.base < OVERHEAD]
    forms += [reach(each) for each in crossings]
    return [*forms, *rectangles(*spaces), *(shapely.Point(tree).buffer(TRUNK) for tree in trees.T)]


def without_overlap(table: np.ndarray, forms: np.ndarray) -> np.ndarray:
    """The spaces without those that lie on an earlier one, as where two streets meet at a sharp angle."""
    earlier, later = shapely.STRtree(forms).query(forms, predicate="overlaps")
    keep = np.ones(len(forms), dtype=bool)
    for i, j in sorted(zip(earlier.tolist(), later.tolist(), strict=True)):
        if i < j and keep[i]:
            keep[j] = False
    return table[:, keep]


def reach(crossing: Crossing) -> BaseGeometry:
    """The ground about a crossing on which nobody parks, beyond both edges of the road too."""
    start, end = crossing.line.T
    beyond = (end - start) * KERB_DEPTH / max(1e-9, np.hypot(*(end - start)))
    return shapely.LineString([start - beyond, end + beyond]).buffer(CLEAR + crossing.width / 2.0, cap_style="flat")


def rows_beside(road: Road, ways: list[Way], site: Site) -> Iterator[np.ndarray]:
    """Rows of spaces on those sides of a road where its ways allow parking."""
    lanes = [site.net.lanes[lane] for lane in road.lanes]
    backward = road.id.startswith("-")
    for side in ("left", "right"):
        own = side if not backward else {"left": "right", "right": "left"}[side]  # of the way, seen along it
        at_kerb = side == ("left" if site.left_hand else "right")
        allowing = [way for way in ways if own in kerbs(way.tags) and (at_kerb or is_one_way(way))]
        for way in allowing:
            yield row(lanes[0] if at_kerb else lanes[-1], kerbs(way.tags)[own], way, side, site, alone=len(site.net.origins[road.id]) == 1)


def row(lane: Lane, how: str, way: Way, side: str, site: Site, *, alone: bool) -> np.ndarray:
    """Spaces beside one edge of a lane, as far as it is made of this way, float64[SPACE_ROWS, n]."""
    angle, step, length, width = KERBSIDE[how]
    sign = 1.0 if side == "left" else -1.0
    s = np.arange(CLEAR + step / 2.0, lane.length - CLEAR - step / 2.0, step)
    if not len(s):
        return np.empty((SPACE_ROWS, 0))
    heading = np.unwrap(arctan2(*np.diff(lane.centre)[::-1]))
    own = curve.stations(lane.centre)
    heading = np.interp(s, (own[:-1] + own[1:]) / 2.0, heading)
    deep = length * np.sin(angle) + width * np.cos(angle)
    away = sign * (lane.width / 2.0 + deep / 2.0 + 0.1)
    x, y = curve.along(lane.centre, s) + away * np.stack([-np.sin(heading), np.cos(heading)])
    if not alone:
        line = shapely.LineString(site.line(way).T)
        others = shapely.distance(line, shapely.points(x, y)) > abs(away) + 2.5 * lane.width * 2.0
        x, y, heading = x[~others], y[~others], heading[~others]
    return np.stack([x, y, wrapped(heading + sign * angle), np.full(len(x), length), np.full(len(x), width)])
