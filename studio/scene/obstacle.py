"""Objects of construction sites on a viser server: one batch of cones, one of barriers; red and white."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import viser

from studio.scene.glb import Material, glb
from studio.scene.shape import Surface, box, joined, lathe

ORANGE, RED, WHITE, RUBBER, STEEL = "#e8501e", "#c8231c", "#f2f0ea", "#2b2c2e", "#8d9296"
HIDDEN = np.array([0.0, 0.0, -500.0], np.float32)
CONE_BANDS = np.array([[0.115, 0.04], [0.094, 0.25], [0.074, 0.42], [0.062, 0.52], [0.047, 0.65], [0.03, 0.75], [0.0, 0.75]])
LENGTH, BOARD, STRIPES = 1.5, 0.25, 6  # [m] of a barrier, [m] height of its boards, stripes of a board


class Place(NamedTuple):
    """An object: "cone" or "barrier", where it stands [m], and the heading of its length [rad]."""

    kind: str
    x: float
    y: float
    heading: float


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


SHAPES = {"cone": cone, "barrier": barrier}


class Obstacles:
    """The batches of one set of objects; they stay hidden until `show`."""

    def __init__(self, server: viser.ViserServer, places: Sequence[Place]) -> None:
        self.batches = [
            self.batch(server, kind, np.array([i for i, place in enumerate(places) if place.kind == kind]), places)
            for kind in SHAPES
            if any(place.kind == kind for place in places)
        ]
        self.shown = np.zeros(len(places), np.int8)

    def batch(self, server: viser.ViserServer, kind: str, members: np.ndarray, places: Sequence[Place]) -> tuple:
        """Members, node and places of all objects of a kind."""
        spots = np.array([[places[i].x, places[i].y, 0.0] for i in members], np.float32)
        half = 0.5 * np.array([places[i].heading for i in members])
        turns = np.stack([np.cos(half), 0 * half, 0 * half, np.sin(half)], axis=1).astype(np.float32)
        hidden = np.tile(HIDDEN, (len(members), 1))
        node = server.scene.add_batched_glb(
            f"/obstacles/{kind}s", glb(SHAPES[kind](), Material(roughness=0.6)), turns, hidden, lod="off",
            cast_shadow=False, receive_shadow=False,
        )  # fmt: skip
        return members, node, spots

    def show(self, standing: np.ndarray) -> None:
        """Shows those that stand, int8[object]; quick when nothing has changed."""
        if (standing == self.shown).all():
            return
        for members, node, spots in self.batches:
            node.batched_positions = np.where(standing[members, None] > 0, spots, HIDDEN)
        self.shown = standing.copy()

    def remove(self) -> None:
        """Takes them off the server."""
        for _, node, _ in self.batches:
            node.remove()
