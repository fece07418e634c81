"""Ghosts: cars of other runs among those that are shown, seen through, without wheels and shadows; each run in a colour of its own."""

from collections.abc import Sequence

import numpy as np
import viser

from studio.scene import pose, vehicle
from studio.scene.fleet import BELOW_GROUND, Look, grouped, positions, put, quaternions
from studio.scene.glb import Material, glb
from studio.scene.shape import Surface

GLASSY = Material(roughness=0.6, blend=True)
OPACITY = 0.45
# of one run after the other; by Okabe and Ito, "Color Universal Design" (2008)
COLOURS = ("#56b4e9", "#e69f00", "#009e73", "#cc79a7", "#f0e442", "#d55e00", "#0072b2")


class Ghosts:
    """The batches of some cars that are seen through; `move` is what happens per frame."""

    def __init__(self, server: viser.ViserServer, looks: Sequence[Look]) -> None:
        self._server = server
        self._bodies = [self._add(*group) for group in enumerate(grouped(looks).items())]

    def _add(self, number: int, group: tuple) -> tuple[np.ndarray, viser.BatchedGlbHandle]:
        (color, size), members = group
        hidden = np.tile(np.array([0.0, 0.0, BELOW_GROUND], np.float32), (len(members), 1))
        level = np.tile(np.array([1.0, 0.0, 0.0, 0.0], np.float32), (len(members), 1))
        data = glb(glassy(vehicle.body(size, color)), GLASSY)
        node = self._server.scene.add_batched_glb(
            f"/ghosts/body_{number}", data, level, hidden, lod="off", cast_shadow=False, receive_shadow=False
        )
        return np.array(members), node

    def move(self, poses: np.ndarray) -> None:
        """Show the ghosts at `poses` (float32[POSE_ROWS, ghost], see pose.py)."""
        poses = np.asarray(poses, np.float32)
        at, turned = positions(poses), quaternions(poses[pose.YAW], poses[pose.PITCH], poses[pose.ROLL])
        with self._server.atomic():
            for members, bodies in self._bodies:
                put(bodies, at[members], turned[members])

    def remove(self) -> None:
        """Take the ghosts off the server."""
        for _, node in self._bodies:
            node.remove()


def glassy(body: Surface) -> Surface:
    """The same surface, through which one sees."""
    return Surface(body.vertices, body.faces, np.column_stack([body.colors[:, :3], np.full(len(body.colors), OPACITY, np.float32)]))
