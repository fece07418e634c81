"""Light and sky: one sun, the light of the sky, haze; no environment map: the shading is plain and quick."""

import numpy as np
import viser

from studio.scene.colour import linear, linear8, rgb8
from studio.scene.glb import Material, glb
from studio.scene.shape import Surface
from studio.scene.shape import surface as painted

# Direction towards the sun, a unit vector in the local east-north-up frame: a forenoon sun in the south-east, 55° high.
SUN = np.array([0.45, -0.35, 0.82]) / np.linalg.norm([0.45, -0.35, 0.82])

SUNLIGHT, SUN_STRENGTH = "#fff0d8", 2.8
SKYLIGHT, GROUNDLIGHT, SKY_STRENGTH = "#dbe8f7", "#77705f", 2.1
HAZE = "#c3d4e2"
HAZE_NEAR, HAZE_FAR = 350.0, 2600.0
SKY_RADIUS = 3000.0
# elevation above the horizon [deg] and colour
SKY = [
    (-12, HAZE),
    (0, HAZE),
    (2, "#bcd0e3"),
    (6, "#aac6e0"),
    (12, "#93b8db"),
    (22, "#78a5d2"),
    (40, "#5c8fc6"),
    (90, "#4a7fbb"),
]
FOG = 1000.0  # [m] of sight and less is fog (WMO)
FOGGY = [(elevation, HAZE) for elevation, _ in SKY]


def light(server: viser.ViserServer) -> None:
    """Light a scene, and put the sky around it."""
    scene = server.scene
    scene.configure_environment_map(None)
    scene.configure_default_lights(False)
    # a hemisphere light shines from its position: at the origin it would have no direction
    up = {"position": (0.0, 0.0, 100.0)}
    scene.add_light_hemisphere("/light/sky", sky_color=rgb8(SKYLIGHT), ground_color=rgb8(GROUNDLIGHT), intensity=SKY_STRENGTH, **up)
    scene.add_light_directional("/light/sun", color=rgb8(SUNLIGHT), intensity=SUN_STRENGTH, position=tuple(SUN * 500.0))
    air(server, HAZE_FAR)


def air(server: viser.ViserServer, visibility: float, *, reach: float = 0.0, radius: float = SKY_RADIUS) -> None:
    """Everything fades into the haze; in fog it is gone where one sees no farther [m], and the sky as well.

    The haze leaves a map of half extent `reach` [m] clear when it is seen as a whole; it ends before the ground does, whose
    `radius` [m] is the sky's.
    """
    near = max(HAZE_NEAR, 0.9 * reach)
    far = max(HAZE_FAR, min(near + HAZE_FAR, 0.97 * radius))
    thin = min(1.0, visibility / far)
    server.scene.configure_fog(near * thin, far * thin, color=linear8(HAZE))
    dome = glb(sky(FOGGY if visibility < FOG else SKY, radius=radius), Material(unlit=True))
    server.scene.add_glb("/city/sky", dome, cast_shadow=False, receive_shadow=False)


def on_level_ground(colour: str) -> np.ndarray:
    """What a matt, level surface of this colour sends to the eye, linear: Lambert's law for sun and sky.

    The ground fills most of the picture, and all of it is lit alike: computed once here, not for every pixel.
    """
    sun = linear(SUNLIGHT) * SUN_STRENGTH * SUN[2]
    return linear(colour) * (sun + linear(SKYLIGHT) * SKY_STRENGTH) / np.pi


def sky(colours: list[tuple[int, str]] = SKY, *, radius: float = SKY_RADIUS) -> Surface:
    """A dome seen from inside, by default haze at the horizon and blue above; colours by elevation [deg]."""
    azimuth = np.linspace(0.0, 2.0 * np.pi, 33)
    elevation = np.radians([degrees for degrees, _ in colours])
    x, y = (np.outer(np.cos(elevation), turn) for turn in (np.cos(azimuth), np.sin(azimuth)))
    vertices = radius * np.stack([x, y, np.broadcast_to(np.sin(elevation)[:, None], x.shape)], axis=-1)
    corner = np.arange(x.size).reshape(x.shape)
    quads = np.stack([corner[:-1, :-1], corner[1:, :-1], corner[1:, 1:], corner[:-1, 1:]], -1).reshape(-1, 4)
    faces = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    shades = np.repeat([linear(colour) for _, colour in colours], len(azimuth), axis=0)
    return painted(vertices, faces, shades)
