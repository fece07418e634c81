"""Trees: those that are mapped, and as many as a park needs to look like one."""

import numpy as np
import shapely
import viser

from studio.road.network import Network
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
    region = _plantable(network)
    planted = _grid(region)
    mapped = network.scenery.trees
    if len(mapped.T) and len(planted.T):
        near = shapely.MultiPoint(mapped.T).buffer(0.5 * SPACING)
        planted = planted[:, ~shapely.contains_xy(near, *planted)]
    free = ~shapely.contains_xy(_lanes(network, 0.6), *mapped) if len(mapped.T) else np.zeros(0, bool)
    return np.concatenate([mapped[:, free], planted], axis=1)


def _plantable(network: Network) -> shapely.Geometry:
    areas = network.scenery.areas
    green = shapely.union_all([_polygon(area) for area in areas if area.kind == "green"])
    taken = [_polygon(area).buffer(2.0) for area in areas if area.kind != "green"]
    taken += [_polygon(building).buffer(3.5) for building in network.scenery.buildings]
    taken += [
        shapely.Polygon(junction.T).buffer(CLEARANCE)
        for junction in network.junctions
        if junction.shape[1] > 2
    ]
    return green.difference(shapely.union_all([*taken, _lanes(network, CLEARANCE)]))


def _polygon(thing) -> shapely.Geometry:
    return shapely.make_valid(shapely.Polygon(thing.outline.T, [hole.T for hole in thing.holes]))


def _lanes(network: Network, clearance: float) -> shapely.Geometry:
    strips = [
        shapely.LineString(lane.centre.T).buffer(lane.width / 2.0 + clearance) for lane in network.lanes
    ]
    return shapely.union_all(strips)


def _grid(region: shapely.Geometry) -> np.ndarray:
    if region.is_empty:
        return np.zeros((2, 0))
    spacing = max(SPACING, np.sqrt(region.area / MOST))
    x0, y0, x1, y1 = region.bounds
    x, y = (axis.ravel() for axis in np.meshgrid(np.arange(x0, x1, spacing), np.arange(y0, y1, spacing)))
    # a fixed seed: the same map has the same trees
    shift = np.random.default_rng(7).uniform(-0.42, 0.42, (2, len(x))) * spacing
    x, y = x + shift[0], y + shift[1]
    inside = shapely.contains_xy(region, x, y)
    return np.stack([x[inside], y[inside]])


def sizes(count: int) -> tuple[np.ndarray, np.ndarray]:
    """Scales float32[n, 3] and quaternions float32[n, 4] that make each tree its own."""
    chance = np.random.default_rng(11)
    scale = chance.uniform(0.8, 1.35, (count, 1)) * chance.uniform(0.9, 1.1, (count, 3))
    half = chance.uniform(0.0, np.pi, count)
    turns = np.stack([np.cos(half), 0 * half, 0 * half, np.sin(half)], axis=1)
    return scale.astype(np.float32), turns.astype(np.float32)


def plant(
    server: viser.ViserServer, network: Network, *, foot: float, shade: float
) -> list[viser.SceneNodeHandle]:
    """Put the trees of a network and their shadows on the server, at the heights `foot` and `shade` [m]."""
    spots = places(network).T
    if len(spots) == 0:
        return []
    scales, turns = sizes(len(spots))
    thrown = spots - CROWN_HEIGHT * scales[:, 2:] * SUN[:2] / SUN[2]
    crowns = glb(tree(), Material())
    patches = glb(shadow(), Material(unlit=True, blend=True))
    level = np.tile(np.float32([1.0, 0.0, 0.0, 0.0]), (len(spots), 1))
    options = {"batched_scales": scales, "cast_shadow": False, "receive_shadow": False}
    add = server.scene.add_batched_glb
    return [
        add("/city/trees", crowns, turns, _at_height(spots, foot), lod=FAR, **options),
        add("/city/tree_shadows", patches, level, _at_height(thrown, shade), lod="off", **options),
    ]


def _at_height(spots: np.ndarray, height: float) -> np.ndarray:
    return np.column_stack([spots, np.full(len(spots), height)]).astype(np.float32)
