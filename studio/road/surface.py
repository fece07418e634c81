"""The place as triangles: road, markings, buildings, their shadows, ground.

Flat things lie in layers that are far enough apart not to flicker when seen from afar.
"""

from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass

import mapbox_earcut
import numpy as np
import shapely

from studio.road import curve
from studio.road.network import Building, Lane, Network
from studio.road.plane import polygon, polygons

GROUND, AREA, ROAD, MARKING, SHADOW = -0.12, -0.06, 0.0, 0.06, 0.12  # [m] heights of the layers
SUN = (-0.45, 0.35, -0.82)  # the direction its light goes: a forenoon sun in the south-east, 55° high
GROUND_MARGIN = 400.0  # [m] of ground around the map
LINE_WIDTH = 0.12  # [m] of lane markings in town (RMS: 0.12)
DASH, DASH_PERIOD = 3.0, 9.0  # [m] a lead line in town: 3 m line, 6 m gap (RMS)
STOP_LINE_WIDTH = 0.5  # [m] (RMS: 0.50)
EDGE_INSET = 0.1  # [m] of the edge line from the edge of the asphalt
MIDDLE_INSET = 1.0  # [m] of asphalt beyond a line, from which on it is one between directions
SMALLEST_ISLAND = 12.0  # [m²] a smaller hole in the asphalt is a slit between lanes that overlap
SEAM = 0.15  # [m] gaps narrower than twice this between lanes and junctions are closed
LONGEST_SHADOW = 120.0  # [m]


@dataclass(frozen=True, eq=False)
class Mesh:
    """Triangles: vertices float32[n, 3] [m], faces uint32[m, 3], counter-clockwise seen from outside."""

    vertices: np.ndarray
    faces: np.ndarray


def empty() -> Mesh:
    """No triangles."""
    return Mesh(np.empty((0, 3), np.float32), np.empty((0, 3), np.uint32))


def merged(meshes: list[Mesh]) -> Mesh:
    """All triangles in one mesh."""
    if not meshes:
        return empty()
    start = np.cumsum([0, *(len(mesh.vertices) for mesh in meshes[:-1])])
    faces = [mesh.faces + np.uint32(first) for mesh, first in zip(meshes, start, strict=True)]
    return Mesh(np.concatenate([mesh.vertices for mesh in meshes]), np.concatenate(faces))


def flat(form: shapely.Geometry, z: float, *, up: bool = True) -> Mesh:
    """A plane shape as triangles at height z [m], facing up or down."""
    meshes = [triangulated(polygon, z) for polygon in polygons(form)]
    mesh = merged(meshes)
    return mesh if up else Mesh(mesh.vertices, mesh.faces[:, ::-1].copy())


def triangulated(polygon: shapely.Polygon, z: float) -> Mesh:
    """A polygon as triangles at height z [m]."""
    rings = [np.array(ring.coords)[:-1, :2] for ring in (polygon.exterior, *polygon.interiors)]
    points = np.concatenate(rings)
    ends = np.cumsum([len(ring) for ring in rings]).astype(np.uint32)
    faces = mapbox_earcut.triangulate_float64(points, ends).reshape(-1, 3)
    vertices = np.column_stack([points, np.full(len(points), z)]).astype(np.float32)
    return Mesh(vertices, facing_up(points, faces.astype(np.uint32)))


def facing_up(points: np.ndarray, faces: np.ndarray) -> np.ndarray:
    """The triangles with their corners counter-clockwise seen from above."""
    a, b, c = points[faces[:, 0]], points[faces[:, 1]], points[faces[:, 2]]
    ab, ac = b - a, c - a
    clockwise = ab[:, 0] * ac[:, 1] - ab[:, 1] * ac[:, 0] < 0.0
    faces[clockwise] = faces[clockwise][:, ::-1]
    return faces


# -- road ------------------------------------------------------------------------------------------


def road_form(network: Network) -> shapely.Geometry:
    """The carriageway as one plane shape: lanes and junctions, with the seams and slits between them closed."""
    lanes = [strip(lane.centre, lane.width) for lane in network.lanes]
    joined = shapely.union_all([*lanes, junction_form(network)])
    closed = joined.buffer(SEAM, join_style="mitre").buffer(-SEAM, join_style="mitre").simplify(0.01)
    return shapely.union_all([without_slits(polygon) for polygon in polygons(closed)])


def without_slits(polygon: shapely.Polygon) -> shapely.Polygon:
    """The polygon without holes too small for an island."""
    islands = [hole for hole in polygon.interiors if shapely.Polygon(hole).area > SMALLEST_ISLAND]
    return shapely.Polygon(polygon.exterior, islands)


def junction_form(network: Network) -> shapely.Geometry:
    """The ground of all junctions."""
    return shapely.union_all(
        [shapely.make_valid(shapely.Polygon(junction.T)) for junction in network.junctions]
    )


def strip(centre: np.ndarray, width: float) -> shapely.Geometry:
    """A band of this width [m] along a line."""
    return shapely.LineString(centre.T).buffer(
        width / 2.0, cap_style="flat", join_style="mitre", mitre_limit=2.0
    )


def road_mesh(form: shapely.Geometry) -> Mesh:
    """The carriageway of this plane shape."""
    return flat(form, ROAD)


def beside(lane: Lane, offset: float) -> shapely.LineString:
    """The line along a lane, `offset` [m] to the left of its centre."""
    return shapely.LineString(lane.centre.T).offset_curve(offset, join_style="mitre")


def road_lines(network: Network, road: str) -> Iterator[shapely.Geometry]:
    """The dashes between the lanes of a road."""
    for lane in network.lanes_of(road)[:-1]:
        yield from dashes(beside(lane, network.middle * lane.width / 2.0))


def dashes(line: shapely.LineString) -> Iterator[shapely.Geometry]:
    """Dashes along a line; a line too short for one stays empty."""
    if line.geom_type != "LineString" or line.is_empty:
        return
    points = np.array(line.coords).T
    for start in np.arange(DASH, line.length - DASH, DASH_PERIOD):
        own = curve.stations(points)
        inside = points[:, (start < own) & (own < start + DASH)]
        ends = curve.along(points, np.array([start, start + DASH]))
        yield strip(np.column_stack([ends[:, :1], inside, ends[:, 1:]]), LINE_WIDTH)


def middle_line(network: Network, road: str) -> shapely.Geometry:
    """The line beside a road towards its middle; it is drawn where asphalt, the other direction's, lies beyond it."""
    inner = network.lanes_of(road)[-1]
    line = beside(inner, network.middle * inner.width / 2.0)
    return line.buffer(LINE_WIDTH / 2.0, cap_style="flat", join_style="mitre")


def edge_lines(network: Network, form: shapely.Geometry) -> shapely.Geometry:
    """A line along the edge of the asphalt, but not across the ends where the map is cut."""
    inner = form.buffer(-EDGE_INSET, join_style="mitre")
    line = inner.difference(inner.buffer(-LINE_WIDTH, join_style="mitre"))
    return line.difference(shapely.union_all([end for lane in loose_ends(network) for end in lane]))


def loose_ends(network: Network) -> Iterator[list[shapely.Geometry]]:
    """Bars over the ends of lanes where the map is cut."""
    fed = {connection.to_lane for connection in network.connections}
    feeding = {connection.from_lane for connection in network.connections}
    for lane in network.lanes:
        if not lane.internal:
            starts = [] if lane.id in fed else [lane.centre[:, :2]]
            ends = [] if lane.id in feeding else [lane.centre[:, -2:]]
            yield [
                across(points, at, lane.width)
                for points, at in [*((p, 0) for p in starts), *((p, 1) for p in ends)]
            ]


def across(points: np.ndarray, at: int, width: float) -> shapely.Geometry:
    """A bar over the end of a lane, a little narrower than the lane so that its edge lines stay."""
    direction = np.diff(points)[:, 0]
    direction = direction / np.hypot(*direction)
    left = np.array([-direction[1], direction[0]]) * (width / 2.0 - EDGE_INSET - LINE_WIDTH)
    return strip(np.column_stack([points[:, at] - left, points[:, at] + left]), 1.0)


def stop_line(network: Network, link: int) -> shapely.Geometry:
    """The bar before a signal, across its lane."""
    signals = network.signals
    heading, half = signals.link_heading[link], signals.link_width[link] / 2.0
    forward = np.array([np.cos(heading), np.sin(heading)])
    middle = np.array([signals.link_x[link], signals.link_y[link]]) - forward * STOP_LINE_WIDTH / 2.0
    left = np.array([-forward[1], forward[0]]) * half
    return strip(np.column_stack([middle - left, middle + left]), STOP_LINE_WIDTH)


# -- buildings -------------------------------------------------------------------------------------


def building_mesh(network: Network) -> Mesh:
    """Walls and roofs; every face has its own vertices, so that edges stay sharp."""
    return merged([solid(building) for building in network.scenery.buildings])


def building_meshes(network: Network) -> dict[str, Mesh]:
    """The same by mapped colour ("#rrggbb"); "" holds those without one."""
    colours = sorted({building.colour for building in network.scenery.buildings})
    return {
        colour: merged([solid(b) for b in network.scenery.buildings if b.colour == colour])
        for colour in colours
    }


def footprint(building: Building) -> shapely.Polygon:
    """The ground that a building stands on, or hangs over."""
    return shapely.Polygon(building.outline.T, [hole.T for hole in building.holes])


def solid(building: Building) -> Mesh:
    """One building: roof, walls, and an underside where it hangs in the air."""
    roof = flat(footprint(building), building.height)
    floor = [flat(footprint(building), building.base, up=False)] if building.base > 0.0 else []
    sides = [walls(ring, building.base, building.height) for ring in (building.outline, *building.holes)]
    return merged([roof, *floor, *sides])


def walls(ring: np.ndarray, base: float, top: float) -> Mesh:
    """A quad for every edge of a ring; the ring runs counter-clockwise around what is solid."""
    a, b = ring, np.roll(ring, -1, axis=1)
    low, high = np.full(ring.shape[1], base), np.full(ring.shape[1], top)
    corners = [np.vstack([a, low]), np.vstack([b, low]), np.vstack([b, high]), np.vstack([a, high])]
    vertices = np.stack(corners, axis=2).transpose(1, 2, 0).reshape(-1, 3).astype(np.float32)
    first = 4 * np.arange(ring.shape[1], dtype=np.uint32)[:, None]
    return Mesh(vertices, np.concatenate([first + [0, 1, 2], first + [0, 2, 3]]).astype(np.uint32))


def shadow_mesh(network: Network, sun: tuple[float, float, float] = SUN) -> Mesh:
    """The shadows of all buildings on flat ground as one shape, so that none is drawn twice.

    Args:
        network: the map.
        sun: the direction that light travels, a unit vector that points down.
    """
    buildings = network.scenery.buildings
    pieces = [piece for building in buildings for piece in cast_pieces(footprint(building), building, sun)]
    standing = [footprint(building) for building in buildings if building.base == 0.0]
    return flat(shapely.union_all(pieces).difference(shapely.union_all(standing)), SHADOW)


def cast(form: shapely.Polygon, building: Building, sun: tuple[float, float, float]) -> shapely.Geometry:
    """The shadow of a prism."""
    return shapely.union_all(cast_pieces(form, building, sun))


def cast_pieces(form: shapely.Polygon, building: Building, sun: tuple[float, float, float]) -> list[shapely.Geometry]:
    """The shadow of a prism: its footprint swept from the underside's shadow to the roof's, edge by edge."""
    length = np.array([sun[0], sun[1]]) / -sun[2]
    length *= min(1.0, LONGEST_SHADOW / max(1e-9, building.height * np.hypot(*length)))
    near, far = building.base * length, building.height * length
    a = np.array(form.exterior.coords)
    swept = shapely.polygons(np.stack([a[:-1] + near, a[1:] + near, a[1:] + far, a[:-1] + far], axis=1))
    ends = [shapely.affinity.translate(form, *near), shapely.affinity.translate(form, *far)]
    return [*ends, *swept[shapely.area(swept) > 0.0]]


# -- ground ----------------------------------------------------------------------------------------


def ground_mesh(network: Network) -> Mesh:
    """The plain that the map lies on."""
    x0, y0, x1, y1 = network.bounds
    return flat(
        shapely.box(x0 - GROUND_MARGIN, y0 - GROUND_MARGIN, x1 + GROUND_MARGIN, y1 + GROUND_MARGIN), GROUND
    )


def area_meshes(network: Network) -> dict[str, Mesh]:
    """Ground of other colours, each kind as one mesh; none lies on another."""
    forms = area_forms(network)
    return {kind: flat(form, AREA) for kind, form in forms.items()}


def area_forms(network: Network) -> dict[str, shapely.Geometry]:
    """All areas by kind, cut where they overlap: the smaller one lies on the larger one, a pond in its park."""
    areas = network.scenery.areas
    forms = np.array([polygon(area) for area in areas])
    tree = shapely.STRtree(forms)
    size = shapely.area(forms) if len(forms) else np.empty(0)
    rank = np.empty(len(forms))
    rank[np.argsort(-size, kind="stable")] = np.arange(len(forms))
    shown = defaultdict(list)
    for i, (area, form) in enumerate(zip(areas, forms, strict=True)):
        above = [forms[j] for j in tree.query(form, predicate="intersects") if rank[j] > rank[i]]
        shown[area.kind].append(form.difference(shapely.union_all(above)) if above else form)
    return {kind: shapely.union_all(pieces) for kind, pieces in shown.items()}
