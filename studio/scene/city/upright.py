"""What stands upright beside the road, as plain solids: walls, fences, hedges, bollards, lamps and poles in one mesh."""

from functools import cache

import numpy as np

from studio.road.network import Network, Post, Wall
from studio.scene.colour import linear
from studio.scene.shape import Surface, box, cylinder, edged, joined, surface

WALLS = {
    "wall": "#b4aba0",
    "city_wall": "#a8937c",
    "retaining_wall": "#a7a39b",
    "fence": "#8d928e",
    "hedge": "#5b7a45",
    "guard_rail": "#b9bec2",
    "jersey_barrier": "#c2bfb8",
    "handrail": "#8a9096",
}
POSTS = {"bollard": "#5d5f62", "block": "#b5b0a8", "lamp": "#70767b", "flagpole": "#d4d7d9", "mast": "#9aa0a5", "pole": "#7a6a58"}
FOOT_SHADE = 0.78  # the foot sees less of the sky
LAMP = "#e9e6d8"


def uprights(network: Network) -> list[Surface]:
    """The solids of a network; none where nothing is mapped."""
    scenery = network.scenery
    return [*(barrier(wall) for wall in scenery.walls), *(post(each) for each in scenery.posts)]


def barrier(wall: Wall) -> Surface:
    """A cuboid for every stretch of a wall: two faces and the top, and the ends."""
    a, b = wall.line[:, :-1], wall.line[:, 1:]
    along = (b - a) / np.maximum(np.hypot(*(b - a)), 1e-9)
    left = np.stack([-along[1], along[0]]) * wall.thickness / 2.0
    foot = np.stack([a - left, b - left, b + left, a + left], axis=1)  # [2, corner, stretch], counter-clockwise
    count = foot.shape[2]
    low = np.concatenate([foot, np.zeros((1, 4, count))]).transpose(2, 1, 0)
    vertices = np.concatenate([low, low + [0.0, 0.0, wall.height]], axis=1).reshape(-1, 3)
    sides = [[i, (i + 1) % 4, (i + 1) % 4 + 4, i + 4] for i in range(4)] + [[4, 5, 6, 7]]
    triangles = np.array([corner for a, b, c, d in sides for corner in ((a, b, c), (a, c, d))])
    faces = (8 * np.arange(count)[:, None, None] + triangles).reshape(-1, 3)
    shade = np.tile(np.repeat([FOOT_SHADE, 1.0], 4), count)[:, None]
    return edged(surface(vertices, faces, shade * linear(WALLS[wall.kind])))


def post(each: Post) -> Surface:
    """A slim prism where it stands."""
    return prototype(each.kind, each.height, each.thickness).moved(x=each.x, y=each.y)


@cache
def prototype(kind: str, height: float, thickness: float) -> Surface:
    """A post about the origin; a lamp has a head, a pole for wires a bar, a block is a cuboid."""
    colour = POSTS[kind]
    if kind == "block":
        return box((thickness, thickness, height), colour).moved(z=height / 2.0)
    parts = [cylinder(thickness / 2.0, height, colour, segments=5)]
    if kind == "lamp":
        parts.append(box((0.5, 0.5, 0.25), LAMP).moved(z=height))
    elif kind == "pole":
        parts.append(box((0.15, 2.0, 0.15), colour).moved(z=height - 0.6))
    return joined(parts)
