"""A map as a city: ground, green, water, streets and markings, buildings, trees, masts, and shadows."""

from dataclasses import dataclass

import numpy as np

from studio.road import surface as roads
from studio.road.network import Network
from studio.scene import building, signal
from studio.scene.colour import linear
from studio.scene.glb import Material, glb
from studio.scene.light import SKY_RADIUS, SUN, on_level_ground
from studio.scene.shape import Surface, surface

# Flat layers lie some centimetres apart, so that they do not flicker through each other from afar [m].
GROUND, WATER, GREEN, ROAD, MARKING, SHADOW, TREE_SHADOW = -0.16, -0.13, -0.10, 0.0, 0.03, 0.05, 0.06
COLOURS = {
    "ground": "#9ba18a",
    "water": "#6f9db3",
    "green": "#84995f",
    "road": "#55585c",
    "markings": "#eceae3",
}
SHADOW_COLOUR, SHADOW_OPACITY = "#10151c", 0.42


@dataclass(frozen=True)
class Layer:
    """One static node of the scene: a binary glTF mesh at a height [m]."""

    name: str
    data: bytes
    height: float = 0.0


def layers(network: Network) -> list[Layer]:
    """Everything of the city that never moves, from the ground up."""
    return [
        Layer("ground", glb(ground(), Material(unlit=True)), GROUND),
        *_areas(network),
        _flat("road", roads.road_mesh(network), ROAD),
        _flat("markings", roads.marking_mesh(network), MARKING),
        *_buildings(network),
        *_masts(network),
    ]


def ground(*, radius: float = SKY_RADIUS) -> Surface:
    """A disc out to the horizon."""
    angle = np.linspace(0.0, 2.0 * np.pi, 48, endpoint=False)
    reach = np.array([0.0, 0.3, 1.0]) * radius * 0.99
    vertices = np.concatenate(
        [np.column_stack([r * np.cos(angle), r * np.sin(angle), 0 * angle]) for r in reach]
    )
    here = np.arange(48)
    after = (here + 1) % 48
    faces = [np.stack([i + here, o + here, o + after], 1) for i, o in ((0, 48), (48, 96))]
    faces.append(np.stack([48 + here, 96 + after, 48 + after], 1))
    return surface(vertices, np.concatenate(faces), on_level_ground(COLOURS["ground"]))


def _flat(name: str, mesh: roads.Mesh, height: float) -> Layer:
    flat = surface(_level(mesh.vertices), mesh.faces, on_level_ground(COLOURS[name]))
    return Layer(name, glb(flat, Material(unlit=True)), height)


def _level(vertices: np.ndarray) -> np.ndarray:
    # the layers' heights are ours: shadows must lie low, or they climb up the wheels
    return vertices * np.float32([1.0, 1.0, 0.0])


def _areas(network: Network) -> list[Layer]:
    heights = {"green": GREEN, "water": WATER}
    meshes = roads.area_meshes(network)
    return [
        _flat(kind, meshes[kind], heights[kind])
        for kind in heights
        if kind in meshes and len(meshes[kind].faces)
    ]


def _buildings(network: Network) -> list[Layer]:
    buildings = network.scenery.buildings
    if not buildings:
        return []
    shape, uv = building.buildings_surface(buildings)
    return [
        Layer("shadow", glb(shade(network), Material(unlit=True, blend=True)), SHADOW),
        Layer("buildings", glb(shape, Material(roughness=0.85, image=building.facade()), uv=uv)),
    ]


def shade(network: Network) -> Surface:
    """The shadow of all buildings on the ground, one see-through sheet."""
    mesh = roads.shadow_mesh(network, sun=tuple(-SUN))
    return surface(_level(mesh.vertices), mesh.faces, np.append(linear(SHADOW_COLOUR), SHADOW_OPACITY))


def _masts(network: Network) -> list[Layer]:
    if len(network.signals) == 0:
        return []
    return [Layer("masts", glb(signal.masts(network), Material(roughness=0.6)))]
