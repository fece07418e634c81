"""What a city looks like: its layers with their colours, heights and light, and how they go onto a viser server."""

from dataclasses import dataclass

import numpy as np
import viser

from studio.scene.colour import linear8, rgb8
from studio.scene.glb import Material, glb
from studio.scene.shape import Surface, surface

# Late morning in summer: direction towards the sun, unit vector in the local east-north-up frame.
SUN = np.array([-0.42, -0.58, 0.70])
SUN = SUN / np.linalg.norm(SUN)

HAZE = "#c3d4e2"
SKY_RADIUS = 3000.0


@dataclass(frozen=True)
class Layer:
    """One static node: a mesh of one colour, lifted so that layers do not flicker through each other [m]."""

    name: str
    mesh: Surface
    height: float = 0.0
    material: Material = Material()


def light(server: viser.ViserServer) -> None:
    """One sun and a sky: per-pixel shading without an environment map; haze towards the horizon."""
    scene = server.scene
    scene.configure_environment_map(None)
    scene.configure_default_lights(False)
    scene.add_light_hemisphere("/light/sky", sky_color=rgb8("#dfeaf6"), ground_color=rgb8("#8d8a7d"), intensity=1.75)
    scene.add_light_directional("/light/sun", color=rgb8("#fff1dc"), intensity=3.1, position=tuple(SUN * 500.0))
    scene.configure_fog(350.0, 2600.0, color=linear8(HAZE))
    scene.add_glb("/city/sky", glb(sky(), Material(unlit=True)))


def sky(*, radius: float = SKY_RADIUS) -> Surface:
    """A dome seen from inside, haze at the horizon and blue above."""
    from studio.scene.colour import linear

    azimuth = np.linspace(0.0, 2.0 * np.pi, 33)
    elevation = np.radians([-12.0, 0.0, 3.0, 8.0, 16.0, 30.0, 50.0, 90.0])
    shades = [linear(c) for c in (HAZE, HAZE, "#bdd1e3", "#b0cae2", "#9cbfe0", "#7fabd8", "#6496cd", "#5187c4")]
    ring = np.stack([np.cos(azimuth), np.sin(azimuth)], 1)
    rows = [np.column_stack([radius * np.cos(e) * ring, np.full(len(ring), radius * np.sin(e))]) for e in elevation]
    columns = len(azimuth)
    corner = np.arange(len(rows) * columns).reshape(len(rows), columns)
    quads = np.stack([corner[:-1, :-1], corner[1:, :-1], corner[1:, 1:], corner[:-1, 1:]], -1).reshape(-1, 4)
    faces = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    return surface(np.concatenate(rows), faces, np.repeat(shades, columns, axis=0))


def show(server: viser.ViserServer, layer: Layer) -> viser.SceneNodeHandle:
    """Put a layer on the server, or replace it."""
    return server.scene.add_glb(
        f"/city/{layer.name}",
        glb(layer.mesh, layer.material),
        position=(0.0, 0.0, layer.height),
        cast_shadow=False,
        receive_shadow=False,
    )
