"""The vehicles on a viser server: one batch per colour and shape, one for all wheels, one for all shadows.

Beside each batch stand the shapes that it has from afar, which nobody sees there: the bridge gives them to the batch (bridge.js).
"""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
import viser

from studio.scene import pose, vehicle
from studio.scene.glb import Material, glb
from studio.scene.light import SUN
from studio.scene.shape import Surface

BELOW_GROUND = -500.0
# shadows lie above road, markings and the city's shadow [m]
SHADOW_HEIGHT = 0.075
PAINT = Material(roughness=0.28)
RUBBER = Material(roughness=0.55)
SOFT_SHADOW = Material(unlit=True, blend=True)
# [m] from the eye on, there is less of a car: with a picture 800 points high it is 26 and 9 points to the metre there
AFAR, FAR_AWAY = 40, 110


@dataclass(frozen=True)
class Look:
    """How one vehicle looks: its name, the colour of its paint "#rrggbb", and its dimensions."""

    name: str
    color: str
    dimensions: vehicle.Dimensions = field(default_factory=vehicle.Dimensions)


class Fleet:
    """The batches of one set of vehicles; `move` is the only thing that happens per frame."""

    def __init__(self, server: viser.ViserServer, looks: Sequence[Look]) -> None:
        self.looks = tuple(looks)
        self._server = server
        self._simpler: list[viser.GlbHandle] = []
        self._shown: np.ndarray | None = None
        self._bodies = [self._add_bodies(*group) for group in enumerate(grouped(self.looks).items())]
        sizes = [look.dimensions for look in self.looks]
        self._offsets = np.array([_wheel_places(size) for size in sizes], np.float32).reshape(-1, 4, 3)
        self._middle = np.array([size.centre for size in sizes], np.float32)
        # half the way that the shadow of the roof has been thrown
        self._throw = np.array([-SUN[:2] / SUN[2] * size.height * 0.5 for size in sizes], np.float32).reshape(-1, 2)
        size = _first(sizes)
        self._wheels = self._add("wheels", wheels(size), RUBBER, 4 * len(sizes))
        self._shadows = self._add("shadows", shadows(size), SOFT_SHADOW, 2 * len(sizes))

    def _add_bodies(self, number: int, group: tuple) -> tuple[np.ndarray, viser.BatchedGlbHandle]:
        (color, size), members = group
        return np.array(members), self._add(f"body_{number}", bodies(size, color), PAINT, len(members))

    def _add(self, name: str, shapes: dict[int, Surface], material: Material, count: int) -> viser.BatchedGlbHandle:
        """A batch of the first shape; the others are what it looks like from so far on [m]."""
        near, *others = shapes.items()
        for distance, shape in others:
            self._simpler.append(self._server.scene.add_glb(f"/afar/{name}/{distance}", glb(shape, material), visible=False))
        return self._batch(name, glb(near[1], material), count)

    def _batch(self, name: str, data: bytes, count: int) -> viser.BatchedGlbHandle:
        # lod="off": what viser simplifies shows facets on the round body
        places = np.tile(np.array([0.0, 0.0, BELOW_GROUND], np.float32), (count, 1))
        turns = np.tile(np.array([1.0, 0.0, 0.0, 0.0], np.float32), (count, 1))
        return self._server.scene.add_batched_glb(
            f"/vehicles/{name}", data, turns, places, lod="off", cast_shadow=False, receive_shadow=False
        )

    def move(self, poses: np.ndarray) -> None:
        """Show the vehicles at `poses` (float32[POSE_ROWS, vehicle], see pose.py); costs nothing when nobody has moved."""
        poses = np.asarray(poses, np.float32)
        if self._shown is not None and np.array_equal(poses, self._shown):
            return
        self._shown = poses.copy()
        places = positions(poses)
        turns = quaternions(poses[pose.YAW], poses[pose.PITCH], poses[pose.ROLL])
        with self._server.atomic():
            for members, batch in self._bodies:
                put(batch, places[members], turns[members])
            self._move_wheels(poses, places)
            self._move_shadows(poses, places)

    def _move_wheels(self, poses: np.ndarray, places: np.ndarray) -> None:
        # wheels stand on the road: they follow yaw and tilt of it, not the roll and pitch of the body
        c, s = np.cos(poses[pose.YAW])[:, None], np.sin(poses[pose.YAW])[:, None]
        x, y, z = np.moveaxis(self._offsets, -1, 0)
        wheels = places[:, None, :] + np.stack([c * x - s * y, s * x + c * y, z - x * np.tan(poses[pose.TILT])[:, None]], axis=-1)
        yaw = poses[pose.YAW][:, None] + poses[pose.STEER][:, None] * np.array([1, 1, 0, 0], np.float32)
        spin = np.repeat(poses[pose.WHEEL_ANGLE], 4)
        put(self._wheels, wheels.reshape(-1, 3), quaternions(yaw.ravel(), spin, np.zeros_like(spin)))

    def _move_shadows(self, poses: np.ndarray, places: np.ndarray) -> None:
        lifted = places + np.array([0.0, 0.0, SHADOW_HEIGHT], np.float32)
        thrown = lifted + np.column_stack([self._throw, np.full(len(places), 0.01, np.float32)])
        yaw = np.tile(poses[pose.YAW], 2)
        tilt = np.tile(poses[pose.TILT], 2)
        put(self._shadows, np.concatenate([lifted, thrown]), quaternions(yaw, tilt, np.zeros_like(yaw)))

    def remove(self) -> None:
        """Take the vehicles off the server."""
        for node in [*(batch for _, batch in self._bodies), self._wheels, self._shadows, *self._simpler]:
            node.remove()


def bodies(size: vehicle.Dimensions, colour: str) -> dict[int, Surface]:
    """A car without its wheels, from so far on [m]."""
    levels = {0: vehicle.FINE, AFAR: vehicle.MIDDLING, FAR_AWAY: vehicle.COARSE}
    return {distance: vehicle.body(size, colour, detail) for distance, detail in levels.items()}


def wheels(size: vehicle.Dimensions) -> dict[int, Surface]:
    """A wheel, from so far on [m]."""
    return {0: vehicle.wheel(size)} | {distance: vehicle.plain_wheel(size, segments=n) for distance, n in ((AFAR, 16), (FAR_AWAY, 8))}


def shadows(size: vehicle.Dimensions) -> dict[int, Surface]:
    """The shadow below a car, from so far on [m]."""
    return {0: vehicle.shadow(size), AFAR: vehicle.shadow(size, edge=vehicle.SIMPLE, corners=12)}


def grouped(looks: Sequence[Look]) -> dict[tuple, list[int]]:
    """Who looks the same, by colour and dimensions."""
    groups: dict[tuple, list[int]] = {}
    for index, look in enumerate(looks):
        groups.setdefault((look.color, look.dimensions), []).append(index)
    return groups


def _first(sizes: Sequence[vehicle.Dimensions]) -> vehicle.Dimensions:
    return sizes[0] if sizes else vehicle.Dimensions()


def _wheel_places(size: vehicle.Dimensions) -> list[tuple[float, float, float]]:
    front, rear = size.axles
    half = size.track / 2.0
    return [(x, y, size.wheel_radius) for x in (front, rear) for y in (half, -half)]


def positions(poses: np.ndarray) -> np.ndarray:
    """Where they are, float32[vehicle, 3]; who is hidden is below the ground."""
    z = np.where(poses[pose.VISIBLE] > 0.5, poses[pose.Z], np.float32(BELOW_GROUND))
    return np.stack([poses[pose.X], poses[pose.Y], z], axis=-1)


def quaternions(yaw: np.ndarray, pitch: np.ndarray, roll: np.ndarray) -> np.ndarray:
    """Quaternions (w, x, y, z) of yaw about z, then pitch about y, then roll about x [rad]."""
    cz, cy, cx = (np.cos(angle / 2.0) for angle in (yaw, pitch, roll))
    sz, sy, sx = (np.sin(angle / 2.0) for angle in (yaw, pitch, roll))
    return np.stack(
        [
            cz * cy * cx + sz * sy * sx,
            cz * cy * sx - sz * sy * cx,
            cz * sy * cx + sz * cy * sx,
            sz * cy * cx - cz * sy * sx,
        ],
        axis=-1,
    )


def put(node: viser.BatchedGlbHandle, places: np.ndarray, turns: np.ndarray) -> None:
    """Moves a batch."""
    node.batched_positions = places
    node.batched_wxyzs = turns
