"""A map as a city: ground, green, water, streets and markings, buildings, trees, masts, and shadows."""

from dataclasses import dataclass

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from studio.road import kept
from studio.road.network import Network
from studio.road.network.outline import road_form
from studio.road.ways.relief import relief_of
from studio.scene import signal
from studio.scene.city import building, marking, tree, verge
from studio.scene.city.area import area_meshes
from studio.scene.city.deck import Aloft, aloft
from studio.scene.city.mesh import Mesh, flat
from studio.scene.city.raised import parted
from studio.scene.city.shadow import shadow_mesh
from studio.scene.city.stretch import on_land
from studio.scene.city.upright import uprights
from studio.scene.colour import linear
from studio.scene.glb import Material, glb
from studio.scene.light import SKY_RADIUS, SUN, on_level_ground
from studio.scene.shape import Surface, joined, surface

# Flat layers lie some centimetres apart, so that they do not flicker through each other from afar [m].
GROUND, AREA, SPACE, ROAD, MARKING, SHADOW, TREE_SHADOW = -0.16, -0.12, -0.06, 0.0, 0.03, 0.06, 0.08
COLOURS = {
    "ground": "#9ba18a",
    "sand": "#d3c49b",
    "square": "#b3aba0",
    "parking": "#6a6c6e",
    "green": "#84995f",
    "water": "#6f9db3",
    "road": "#55585c",
    "shoulder": "#686b6e",
    "markings": "#eceae3",
}
BEYOND = 2000.0  # [m] of ground around the map
SPACE_MARGIN = 0.35  # [m] of ground around a space, to its neighbour and to the lane
COVER_OPACITY = 0.45  # of the ground over a tunnel, so that one sees who drives in it
SHADOW_COLOUR, SHADOW_OPACITY = "#10151c", 0.42


@dataclass(frozen=True)
class Layer:
    """One static node of the scene: a binary glTF mesh at a height [m]."""

    name: str
    data: bytes
    height: float = 0.0


@dataclass(frozen=True, eq=False)
class City:
    """What never moves: the layers, each one draw call, and where trees stand, float64[2, n]."""

    layers: list[Layer]
    trees: np.ndarray


def city(network: Network) -> City:
    """The city of a map; that of an imported map is kept on disk, since a large one takes seconds to make."""
    return kept.of_map(network.digest, "cities", City, lambda: City(layers(network), tree.places(network)), maker=__file__)


def layers(network: Network) -> list[Layer]:
    """Everything of the city that never moves, from the ground up; each is one draw call."""
    relief = relief_of(network)
    if relief is None or not relief.lift.any():
        return [
            Layer("ground", glb(ground(radius=horizon(network)), Material(unlit=True)), GROUND),
            *on_ground(network, network, shapely.Polygon(), marking.marks_of(network)),
        ]
    above, land = aloft(network, relief), on_land(network, relief)
    low, high = parted(network, relief)
    return [
        Layer("ground", glb(holed(ground_form(horizon(network)), above.opened), Material(unlit=True)), GROUND),
        *on_ground(network, land, above.opened, low),
        *_aloft(above, high),
    ]


def on_ground(network: Network, land: Network, opened: BaseGeometry, marks: marking.Marks) -> list[Layer]:
    """What lies and stands on the land, but where the ground is open; `land` is the part of the network that lies on it, with its marks."""
    form = road_form(land)
    return [
        *_areas(network, opened),
        *_shoulders(land, form),
        _flat("road", flat(form), ROAD),
        _flat("markings", marking.marking_mesh(land, form, marks), MARKING),
        *_buildings(network),
        *_uprights(network, land, form),
    ]


def horizon(network: Network) -> float:
    """How far ground and sky reach [m]: well beyond the map."""
    x0, y0, x1, y1 = network.bounds
    return max(SKY_RADIUS, BEYOND + float(np.hypot(max(-x0, x1), max(-y0, y1))))


def ground(*, radius: float = SKY_RADIUS) -> Surface:
    """A disc out to the horizon."""
    angle = np.linspace(0.0, 2.0 * np.pi, 48, endpoint=False)
    reach = np.array([0.0, 0.3, 1.0]) * radius * 0.99
    vertices = np.concatenate([np.column_stack([r * np.cos(angle), r * np.sin(angle), 0 * angle]) for r in reach])
    here = np.arange(48)
    after = (here + 1) % 48
    faces = [np.stack([i + here, o + here, o + after], 1) for i, o in ((0, 48), (48, 96))]
    faces.append(np.stack([48 + here, 96 + after, 48 + after], 1))
    return surface(vertices, np.concatenate(faces), on_level_ground(COLOURS["ground"]))


def ground_form(radius: float) -> shapely.Polygon:
    """The same disc as a plane shape."""
    return shapely.Point(0.0, 0.0).buffer(radius * 0.99, quad_segs=12)


def holed(form: BaseGeometry, opened: BaseGeometry) -> Surface:
    """Ground with holes."""
    mesh = flat(form.difference(opened))
    return surface(mesh.vertices, mesh.faces, on_level_ground(COLOURS["ground"]))


def _aloft(above: Aloft, paint: list[Surface]) -> list[Layer]:
    """What lies off the land: roads and their paint, what carries them, their shadow, and ground over tunnels that one sees through."""
    found = [
        Layer("aloft", glb(joined([above.roads, *paint]), Material(unlit=True))),
        Layer("decks", glb(above.solids, Material(roughness=0.85))),
    ]
    if len(above.shadow.faces):
        shade = surface(above.shadow.vertices, above.shadow.faces, np.append(linear(SHADOW_COLOUR), SHADOW_OPACITY))
        found.append(Layer("deck_shadow", glb(shade, Material(unlit=True, blend=True)), SHADOW))
    if not above.covered.is_empty:
        mesh = flat(above.covered)
        cover = surface(mesh.vertices, mesh.faces, np.append(on_level_ground(COLOURS["ground"]), COVER_OPACITY))
        found.append(Layer("cover", glb(cover, Material(unlit=True, blend=True)), GROUND))
    return found


def _flat(name: str, mesh: Mesh, height: float) -> Layer:
    return Layer(name, glb(_level(mesh, name), Material(unlit=True)), height)


def _level(mesh: Mesh, name: str, height: float = 0.0) -> Surface:
    # the layers' heights are ours: shadows must lie low, or they climb up the wheels
    vertices = mesh.vertices * np.array([1.0, 1.0, 0.0], np.float32) + np.array([0.0, 0.0, height], np.float32)
    return surface(vertices, mesh.faces, on_level_ground(COLOURS[name]))


def _areas(network: Network, opened: BaseGeometry) -> list[Layer]:
    meshes = {kind: mesh for kind, mesh in area_meshes(network, opened).items() if len(mesh.faces)}
    flats = [_level(mesh, kind, AREA) for kind, mesh in meshes.items()]
    spaces = network.scenery.spaces
    if spaces.size:
        flats.append(_level(marking.space_ground(spaces, margin=SPACE_MARGIN), "parking", SPACE))
    return [Layer("areas", glb(joined(flats), Material(unlit=True)))] if flats else []


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
    mesh = shadow_mesh(network, sun=tuple(-SUN))
    level = mesh.vertices * np.array([1.0, 1.0, 0.0], np.float32)
    return surface(level, mesh.faces, np.append(linear(SHADOW_COLOUR), SHADOW_OPACITY))


def _shoulders(network: Network, form: BaseGeometry) -> list[Layer]:
    beside = verge.shoulder(network, form)
    return [] if beside.is_empty else [_flat("shoulder", flat(beside), ROAD)]


def _uprights(network: Network, land: Network, form: BaseGeometry) -> list[Layer]:
    solids = [*uprights(network), *verge.rails(land, form), *([signal.masts(network)] if len(network.signals) else [])]
    return [Layer("uprights", glb(joined(solids), Material(roughness=0.7)))] if solids else []
