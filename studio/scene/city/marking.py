"""What is painted on the ground: lines between lanes, stop lines, arrows, crossings, and parking spaces, as one mesh.

Sizes are those of the German guidelines for road markings (RMS-1): lines in town 0.12 m, zebra 0.50 m on and off, the
lines of a crossing with lights 0.50 m on and 0.20 m off, arrows 5 m long.
"""

from collections import defaultdict
from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from studio.road.network import Crossing, Lane, Network, curve
from studio.road.network.outline import junction_form, strip
from studio.road.network.plane import polygons
from studio.scene.city.line import LINE_WIDTH, MIDDLE_INSET, edge_lines, middle_line, road_lines, stop_line
from studio.scene.city.mesh import Mesh, empty, flat, merged

STRIPE = 0.5  # [m] of a zebra, and as much between two
BROKEN, GAP = 0.5, 0.2  # [m] of the lines of a crossing with lights
STOPPED_BY = 0.6  # [m] lane markings end before a painted crossing
ARROW_LENGTH, ARROW_BEFORE, ARROW_ROOM = 5.0, 4.0, 14.0  # [m] of an arrow, from its tip to the lane's end, of lane it needs
INSIDE = 0.5  # [m] from a junction's edge, where lanes reach into it
AISLE_ARROWS = 14.0  # [m] between the arrows of a one-way aisle
SPACE_LINE = 0.1  # [m]
TURNS = {"straight": "straight", "left": "left", "right": "right", "slight_left": "left", "slight_right": "right"}


class Marks(NamedTuple):
    """What is painted at certain places: arrows, bars before lights, and crossings."""

    arrows: list[Mesh]
    bars: list[BaseGeometry]
    crossings: list[Crossing]


def marks_of(network: Network) -> Marks:
    """All of a map."""
    bars = [stop_line(network, link) for link in range(len(network.signals))]
    shown = [crossing for crossing in network.scenery.crossings if crossing.marking != "none"]
    return Marks([mesh for mesh, *_ in arrows(network)], bars, shown)


def marking_mesh(network: Network, form: BaseGeometry, marks: Marks) -> Mesh:
    """Everything that is painted on a road of this plane shape, and the lines of parking spaces beside it."""
    pieces = painted(network, form, marks)
    quick = is_quad(pieces)
    others = [flat(each) for each in pieces[~quick]]
    return merged([quad_mesh(pieces[quick]), *others, space_mesh(network.scenery.spaces), *marks.arrows])


def painted(network: Network, form: BaseGeometry, marks: Marks) -> np.ndarray:
    """All lines and crossings as plane shapes; lane markings keep off junctions and painted crossings."""
    roads = [road.id for road in network.roads.values() if not road.internal]
    middles = shapely.union_all([middle_line(network, road) for road in roads])
    junctions = junction_form(network)
    middles = middles.intersection(form.buffer(-MIDDLE_INSET)).difference(junctions)
    dashes = outside([line for road in roads for line in road_lines(network, road)], junctions.buffer(-INSIDE))
    covered = [ground_of(crossing).buffer(STOPPED_BY, join_style="mitre") for crossing in marks.crossings]
    lines = without(np.array([*dashes, *marks.bars, *polygons(middles), *polygons(edge_lines(network, form))]), covered)
    crossed = np.array([piece for crossing in marks.crossings for piece in crossing_pieces(crossing)], dtype=object)
    return np.concatenate([lines, within(crossed, form)])


def outside(pieces: list[BaseGeometry], form: BaseGeometry) -> np.ndarray:
    """The pieces whose middle does not lie on a plane shape."""
    shapely.prepare(form)
    known = np.array(pieces, dtype=object)
    return known[~shapely.contains(form, shapely.centroid(known))]


def without(pieces: np.ndarray, covered: Sequence[BaseGeometry]) -> np.ndarray:
    """The pieces cut where something covers them."""
    piece, cover = shapely.STRtree(covered).query(pieces, predicate="intersects")
    for i in np.unique(piece):
        pieces[i] = pieces[i].difference(shapely.union_all([covered[j] for j in cover[piece == i]]))
    return pieces[~shapely.is_empty(pieces)]


def within(pieces: np.ndarray, form: BaseGeometry) -> np.ndarray:
    """The parts of the pieces that lie on this plane shape."""
    shapely.prepare(form)
    over = ~shapely.contains(form, pieces)
    pieces[over] = shapely.intersection(pieces[over], form)
    return pieces[~shapely.is_empty(pieces)]


def is_quad(pieces: np.ndarray) -> np.ndarray:
    """Which shapes have four corners and no hole: their triangles need no search."""
    simple = shapely.get_type_id(pieces) == shapely.GeometryType.POLYGON
    return simple & (shapely.get_num_interior_rings(pieces) == 0) & (shapely.get_num_coordinates(pieces) == 5)


def quad_mesh(pieces: np.ndarray) -> Mesh:
    """Strips of four corners as two triangles each, facing up."""
    if not len(pieces):
        return empty()
    corners = shapely.get_coordinates(shapely.orient_polygons(pieces)).reshape(-1, 5, 2)[:, :4]
    return quads_of(np.concatenate([corners, np.zeros((len(corners), 4, 1))], axis=2))


# -- crossings -------------------------------------------------------------------------------------


def ground_of(crossing: Crossing) -> BaseGeometry:
    """The strip from edge to edge that walkers use."""
    return strip(crossing.line, crossing.width)


def crossing_pieces(crossing: Crossing) -> Iterator[BaseGeometry]:
    """The stripes of a zebra, or the two broken lines of a crossing with lights."""
    length = float(np.hypot(*(crossing.line[:, 1] - crossing.line[:, 0])))
    if crossing.marking == "zebra":
        for start in centred(length, STRIPE, STRIPE):
            yield strip(curve.along(crossing.line, np.array([start, start + STRIPE])), crossing.width)
    elif crossing.marking == "lines":
        for side in (-1.0, 1.0):
            line = shifted(crossing.line, side * (crossing.width - LINE_WIDTH) / 2.0)
            for start in centred(length, BROKEN, GAP):
                yield strip(curve.along(line, np.array([start, start + BROKEN])), LINE_WIDTH)


def centred(length: float, on: float, off: float) -> np.ndarray:
    """Where pieces of length `on` start that have `off` between them, as many as fit and in the middle [m]."""
    count = int((length + off + 1e-9) // (on + off))
    return (length - count * on - (count - 1) * off) / 2.0 + np.arange(count) * (on + off)


def shifted(line: np.ndarray, offset: float) -> np.ndarray:
    """A straight line moved to its left by `offset` [m]."""
    along = line[:, 1] - line[:, 0]
    return line + offset * np.array([-along[1], along[0]])[:, None] / np.hypot(*along)


# -- arrows ----------------------------------------------------------------------------------------

# corners of the arrows, x ahead and y to the left [m]: a stem, and a triangle for each direction
STEM = [(0.0, -0.08), (3.4, -0.08), (3.4, 0.08), (0.0, 0.08)]
HEADS = {
    "straight": [[(3.4, -0.35), (5.0, 0.0), (3.4, 0.35)]],
    "left": [[(2.4, 0.08), (3.1, 0.75), (2.9, 0.75), (2.0, 0.08)], [(2.5, 0.7), (3.4, 0.7), (2.95, 1.35)]],
}
HEADS["right"] = [[(x, -y) for x, y in reversed(piece)] for piece in HEADS["left"]]


def arrows(network: Network) -> Iterator[tuple[Mesh, int, float]]:
    """Arrows on lanes that lead elsewhere than their neighbours, and along one-way aisles; lane and station of their middle."""
    ways = defaultdict(set)
    for connection in network.connections:
        if connection.direction in TURNS:
            ways[connection.from_lane].add(TURNS[connection.direction])
    for road in network.roads.values():
        lanes = [] if road.internal else list(network.lanes_of(road.id))
        if len({frozenset(ways[lane.id]) for lane in lanes}) > 1:
            for lane in lanes:
                if ways[lane.id] and lane.length > ARROW_ROOM:
                    yield arrow_at(lane, lane.length - ARROW_BEFORE, ways[lane.id])
        if road.kind == "service" and len(lanes) == 1 and not has_opposite(network, road.id):
            for tip in np.arange(AISLE_ARROWS / 2.0, lanes[0].length - 1.0, AISLE_ARROWS):
                yield arrow_at(lanes[0], max(tip, ARROW_LENGTH), {"straight"})


def has_opposite(network: Network, road: str) -> bool:
    """Whether the same way is driven in the other direction too."""
    return (road[1:] if road.startswith("-") else f"-{road}") in network.roads


def arrow_at(lane: Lane, tip: float, ways: set[str]) -> tuple[Mesh, int, float]:
    """An arrow, its lane and the station of its middle [m]."""
    return arrow(lane, tip, ways), lane.id, tip - ARROW_LENGTH / 2.0


def arrow(lane: Lane, tip: float, ways: set[str]) -> Mesh:
    """An arrow on a lane whose tip lies at this arc length [m]."""
    base, ahead = curve.along(lane.centre, np.array([tip - ARROW_LENGTH, tip])).T
    t = (ahead - base) / max(1e-9, np.hypot(*(ahead - base)))
    stem = STEM if "straight" in ways else [STEM[0], (2.4, -0.08), (2.4, 0.08), STEM[3]]
    pieces = [stem, *(each for way in sorted(ways) for each in HEADS[way])]
    forward, left = t, np.array([-t[1], t[0]])
    return merged([flat(shapely.Polygon([base + x * forward + y * left for x, y in piece])) for piece in pieces])


# -- parking spaces --------------------------------------------------------------------------------


def space_mesh(spaces: np.ndarray) -> Mesh:
    """The lines around all spaces; neighbours share theirs."""
    x, y, heading, length, width = spaces
    c, s = np.cos(heading), np.sin(heading)
    sides = []
    for sign in (-1.0, 1.0):
        sides.append((x - sign * s * width / 2.0, y + sign * c * width / 2.0, heading, length, SPACE_LINE + 0.0 * width))
        sides.append((x + sign * c * length / 2.0, y + sign * s * length / 2.0, heading, SPACE_LINE + 0.0 * length, width))
    return merged([quads(*side) for side in sides])


def space_ground(spaces: np.ndarray, *, margin: float) -> Mesh:
    """The ground of all spaces, wider by a margin [m] on every side."""
    x, y, heading, length, width = spaces
    return quads(x, y, heading, length + 2.0 * margin, width + 2.0 * margin)


def quads(x, y, heading, length, width) -> Mesh:
    """Rectangles about centres, facing up."""
    c, s = np.cos(heading), np.sin(heading)
    along, left = np.array([-1, 1, 1, -1])[:, None] * length / 2.0, np.array([-1, -1, 1, 1])[:, None] * width / 2.0
    corners = np.stack([x + along * c - left * s, y + along * s + left * c, np.zeros(along.shape)], axis=-1)
    return quads_of(corners.transpose(1, 0, 2))


def quads_of(corners: np.ndarray) -> Mesh:
    """Convex quads [n, 4, 3], counter-clockwise, as a mesh."""
    first = 4 * np.arange(len(corners), dtype=np.uint32)[:, None]
    faces = np.concatenate([first + np.array(corner, dtype=np.uint32) for corner in ((0, 1, 2), (0, 2, 3))])
    return Mesh(corners.reshape(-1, 3).astype(np.float32), faces.astype(np.uint32))
