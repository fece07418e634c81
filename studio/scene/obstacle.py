"""Objects on the road on a viser server: a batch of cones, one of barriers, red and white; people on foot and on bicycles; boxes."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import viser

from studio.scene.glb import Material, glb
from studio.scene.shape import Surface, box, cylinder, joined, lathe

ORANGE, RED, WHITE, RUBBER, STEEL = "#e8501e", "#c8231c", "#f2f0ea", "#2b2c2e", "#8d9296"
BRICK, BARK, LEAVES = "#9a6a57", "#5b4636", "#4f7a3f"
JEANS, JACKET, SKIN, CARDBOARD = "#3b4a63", "#b0322b", "#c99a7b", "#a9814f"
HIDDEN = np.array([0.0, 0.0, -500.0], np.float32)
CONE_BANDS = np.array([[0.115, 0.04], [0.094, 0.25], [0.074, 0.42], [0.062, 0.52], [0.047, 0.65], [0.03, 0.75], [0.0, 0.75]])
LENGTH, BOARD, STRIPES = 1.5, 0.25, 6  # [m] of a barrier, [m] height of its boards, stripes of a board


class Place(NamedTuple):
    """An object: one of `SHAPES`, where it stands [m], the heading of its length [rad], and its length and width [m], which those of
    `STRETCHED` obey."""

    kind: str
    x: float
    y: float
    heading: float
    size: tuple[float, float] = (1.0, 1.0)


def cone() -> Surface:
    """A traffic cone 0.75 m high: a dark foot, and bands that turn about the upright axis."""
    kinds = np.tile([0, 1, 0, 1, 0, 0], (10, 1))
    turned = lathe(CONE_BANDS[::-1], kinds[:, ::-1], [ORANGE, WHITE])
    upright = Surface(turned.vertices[:, [2, 0, 1]], turned.faces, turned.colors)
    return joined([box((0.3, 0.3, 0.04), RUBBER).moved(z=0.02), upright])


def barrier() -> Surface:
    """A barrier board 1.5 m long and 1 m high, with two boards of red and white stripes on two feet."""
    boards = [board().moved(z=z) for z in (0.875, 0.45)]
    posts = [box((0.05, 0.05, 0.98), STEEL).moved(x=x, z=0.5) for x in (-0.55, 0.55)]
    feet = [box((0.12, 0.5, 0.06), RUBBER).moved(x=x, z=0.03) for x in (-0.55, 0.55)]
    return joined([*boards, *posts, *feet])


def board() -> Surface:
    """A board of stripes, seen alike from both sides."""
    width = LENGTH / STRIPES
    places = (np.arange(STRIPES) + 0.5) * width - LENGTH / 2.0
    return joined([box((width, 0.06, BOARD), (RED, WHITE)[i % 2]).moved(x=x) for i, x in enumerate(places)])


def pedestrian() -> Surface:
    """Somebody on foot, 1.75 m tall, who looks along x."""
    legs = [box((0.18, 0.14, 0.85), JEANS).moved(y=y, z=0.43) for y in (-0.1, 0.1)]
    trunk = [box((0.24, 0.46, 0.62), JACKET).moved(z=1.15), box((0.2, 0.17, 0.26), SKIN).moved(z=1.61)]
    return joined([*legs, *trunk])


def cyclist() -> Surface:
    """Somebody on a bicycle 1.9 m long."""
    wheels = [box((0.62, 0.04, 0.62), RUBBER).moved(x=x, z=0.33) for x in (-0.55, 0.55)]
    frame = [box((0.95, 0.05, 0.07), STEEL).moved(z=0.6), box((0.05, 0.5, 0.05), STEEL).moved(x=0.5, z=1.0)]
    rider = [box((0.3, 0.3, 0.55), JEANS).moved(z=0.85), box((0.32, 0.44, 0.55), JACKET).moved(x=0.1, z=1.3)]
    return joined([*wheels, *frame, *rider, box((0.2, 0.17, 0.26), SKIN).moved(x=0.2, z=1.7)])


def crate() -> Surface:
    """A box of 1 m by 1 m by 1 m, which is stretched to the size of the object."""
    return box((1.0, 1.0, 1.0), CARDBOARD).moved(z=0.5)


def barrel() -> Surface:
    """An upright cylinder 1 m high within 1 m by 1 m, which is stretched to the size of the object."""
    return cylinder(0.5, 1.0, ORANGE)


def wall() -> Surface:
    """A piece of wall 2 m high, which is stretched to the size of the object."""
    return box((1.0, 1.0, 2.0), BRICK).moved(z=1.0)


def tree() -> Surface:
    """A trunk within 1 m by 1 m, which is stretched to the size of the object, and its crown."""
    return joined([box((0.8, 0.8, 3.0), BARK).moved(z=1.5), box((10.0, 10.0, 4.0), LEAVES).moved(z=5.0)])


SHAPES = {
    "cone": cone, "barrier": barrier, "pedestrian": pedestrian, "cyclist": cyclist,
    "box": crate, "cylinder": barrel, "wall": wall, "tree": tree,
}  # fmt: skip
STRETCHED = ("box", "cylinder", "wall", "tree")


def turns(headings: np.ndarray) -> np.ndarray:
    """float32[object, 4] of headings [rad], as quaternions."""
    half = 0.5 * headings
    return np.stack([np.cos(half), 0 * half, 0 * half, np.sin(half)], axis=1).astype(np.float32)


class Obstacles:
    """The batches of one set of objects; they stay hidden until `show`."""

    def __init__(self, server: viser.ViserServer, places: Sequence[Place]) -> None:
        self.batches = [
            self.batch(server, kind, np.array([i for i, place in enumerate(places) if place.kind == kind]), places)
            for kind in SHAPES
            if any(place.kind == kind for place in places)
        ]
        self.shown = np.zeros(len(places), np.int8)
        self.where = np.array([(*each[1:4], 0.0) for each in places], np.float32).reshape(-1, 4).T.copy()

    def batch(self, server: viser.ViserServer, kind: str, members: np.ndarray, places: Sequence[Place]) -> tuple:
        """Members and node of all objects of a kind."""
        hidden = np.tile(HIDDEN, (len(members), 1))
        sizes = np.array([(*places[i].size, 1.0) if kind in STRETCHED else (1.0, 1.0, 1.0) for i in members], np.float32)
        headings = np.array([places[i].heading for i in members])
        node = server.scene.add_batched_glb(
            f"/obstacles/{kind}s", glb(SHAPES[kind](), Material(roughness=0.6)), turns(headings), hidden, batched_scales=sizes, lod="off",
            cast_shadow=False, receive_shadow=False,
        )  # fmt: skip
        return members, node

    def show(self, standing: np.ndarray, where: np.ndarray) -> None:
        """Shows those that stand, int8[object], where they are, float32[x, y, heading and lift, object]; quick when nothing has changed."""
        if np.array_equal(standing, self.shown) and np.array_equal(where, self.where):
            return
        for members, node in self.batches:
            x, y, heading, lift = where[:, members]
            at = np.stack([x, y, lift], axis=1)
            node.batched_positions = np.where(standing[members, None] > 0, at, HIDDEN).astype(np.float32)
            if not np.array_equal(heading, self.where[2, members]):
                node.batched_wxyzs = turns(heading)
        self.shown, self.where = standing.copy(), where.copy()

    def remove(self) -> None:
        """Takes them off the server."""
        for _, node in self.batches:
            node.remove()
