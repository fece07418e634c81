"""Trees: those that are mapped, and as many as a park needs to look like one."""

from collections.abc import Sequence

import numpy as np
import shapely
import viser
from shapely.geometry.base import BaseGeometry

from studio.road.network import Network
from studio.road.network.outline import strip
from studio.road.network.plane import polygon, polygons, rectangles
from studio.scene.city.area import area_forms
from studio.scene.colour import linear
from studio.scene.glb import Material, glb
from studio.scene.light import SUN
from studio.scene.shape import Surface, ball, cylinder, joined, surface

MOST = 2000
SPACING = 9.0  # [m] at the closest
CLEARANCE = 3.5  # [m] from the edge of a lane to a trunk
CROWN_HEIGHT = 5.5  # [m] of the middle of the crown, whose shadow falls
FAR = ((90.0, 0.35),)  # beyond 90 m, a third of the triangles will do
TRUNK, CROWN, CROWN_TOP = "#6b5846", "#5f7f47", "#77965a"


def tree() -> Surface:
    """A tree about 9 m high: a trunk and a crown of two round masses."""
    crown = ball((2.5, 2.6, 2.4), CROWN, segments=11).moved(z=5.4)
    top = ball((1.8, 1.7, 1.9), CROWN_TOP, segments=10).moved(x=0.35, y=-0.3, z=7.2)
    return joined([cylinder(0.22, 3.6, TRUNK, segments=6), crown, top])


def shadow(*, darkness: float = 0.34) -> Surface:
    """The shadow of a crown: a soft round patch in the plane z = 0."""
    angle = np.linspace(0.0, 2.0 * np.pi, 16, endpoint=False)
    rings = [np.column_stack([r * np.cos(angle), r * np.sin(angle), 0 * angle]) for r in (1.5, 2.9)]
    here = np.arange(16)
    after = (here + 1) % 16
    faces = [np.stack([np.full(16, 32), here, after], 1), np.stack([here, here + 16, after + 16], 1)]
    faces.append(np.stack([here, after + 16, after], 1))
    opacity = np.repeat([darkness, 0.0, darkness], [16, 16, 1])
    colors = np.column_stack([np.tile(linear("#10151c"), (33, 1)), opacity])
    return surface(np.concatenate([*rings, [[0.0, 0.0, 0.0]]]), np.concatenate(faces), colors)


def places(network: Network) -> np.ndarray:
    """Where trees stand, float64[2, n] [m]: mapped ones first, then a jittered grid over the green."""
    mapped, lanes = network.scenery.trees, _lanes(network)
    mapped = mapped[:, _clear(mapped, lanes, 0.6)]
    planted = _planted(network, lanes)
    return np.concatenate([mapped, planted[:, _clear(planted, [shapely.Point(at) for at in mapped.T], 0.5 * SPACING)]], axis=1)


def _planted(network: Network, lanes: list[BaseGeometry]) -> np.ndarray:
    """The trees of the green, clear of lanes, junctions, houses, and of other ground."""
    forms = area_forms(network)
    spots = _grid(forms.pop("green", shapely.Polygon()))
    junctions = [shapely.Polygon(junction.T) for junction in network.junctions if junction.shape[1] > 2]
    for things, distance in (
        ([part for form in forms.values() for part in polygons(form)], 2.0),
        ([polygon(building) for building in network.scenery.buildings], 3.5),
        ([*lanes, *junctions], CLEARANCE),
        (list(rectangles(*network.scenery.spaces)), 1.0),
    ):
        spots = spots[:, _clear(spots, things, distance)]
    return spots


def _clear(spots: np.ndarray, things: Sequence[BaseGeometry], distance: float) -> np.ndarray:
    """Which spots lie farther than this [m] from all things."""
    clear = np.ones(spots.shape[1], dtype=bool)
    near, _ = shapely.STRtree(things).query(shapely.points(spots.T), predicate="dwithin", distance=distance)
    clear[near] = False
    return clear


def _lanes(network: Network) -> list[BaseGeometry]:
    return [strip(lane.centre, lane.width) for lane in network.lanes]


def _grid(region: BaseGeometry) -> np.ndarray:
    if region.is_empty:
        return np.zeros((2, 0))
    spacing = max(SPACING, np.sqrt(region.area / MOST))
    x0, y0, x1, y1 = region.bounds
    x, y = (axis.ravel() for axis in np.meshgrid(np.arange(x0, x1, spacing), np.arange(y0, y1, spacing)))
    # a fixed seed: the same map has the same trees
    shift = np.random.default_rng(7).uniform(-0.42, 0.42, (2, len(x))) * spacing
    x, y = x + shift[0], y + shift[1]
    shapely.prepare(region)
    inside = shapely.contains_xy(region, x, y)
    return np.stack([x[inside], y[inside]])


def sizes(count: int) -> tuple[np.ndarray, np.ndarray]:
    """Scales float32[n, 3] and quaternions float32[n, 4] that make each tree its own."""
    chance = np.random.default_rng(11)
    scale = chance.uniform(0.8, 1.35, (count, 1)) * chance.uniform(0.9, 1.1, (count, 3))
    half = chance.uniform(0.0, np.pi, count)
    turns = np.stack([np.cos(half), 0 * half, 0 * half, np.sin(half)], axis=1)
    return scale.astype(np.float32), turns.astype(np.float32)


def plant(server: viser.ViserServer, places: np.ndarray, *, foot: float, shade: float) -> list[viser.SceneNodeHandle]:
    """Put trees at these places, float64[2, n], and their shadows on the server, at the heights `foot` and `shade` [m]."""
    spots = places.T
    if len(spots) == 0:
        return []
    scales, turns = sizes(len(spots))
    thrown = spots - CROWN_HEIGHT * scales[:, 2:] * SUN[:2] / SUN[2]
    crowns = glb(tree(), Material())
    patches = glb(shadow(), Material(unlit=True, blend=True))
    level = np.tile(np.array([1.0, 0.0, 0.0, 0.0], np.float32), (len(spots), 1))
    options = {"batched_scales": scales, "cast_shadow": False, "receive_shadow": False}
    add = server.scene.add_batched_glb
    return [
        add("/city/trees", crowns, turns, _at_height(spots, foot), lod=FAR, **options),
        add("/city/tree_shadows", patches, level, _at_height(thrown, shade), lod="off", **options),
    ]


def _at_height(spots: np.ndarray, height: float) -> np.ndarray:
    return np.column_stack([spots, np.full(len(spots), height)]).astype(np.float32)
