"""Shadows of buildings on flat ground."""

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from studio.road.network import Building, Network
from studio.scene.city.mesh import Mesh, flat

LONGEST_SHADOW = 120.0  # [m]


def shadow_mesh(network: Network, *, sun: tuple[float, float, float]) -> Mesh:
    """The shadows of all buildings on flat ground as one shape, so that none is drawn twice.

    Args:
        network: the map.
        sun: the direction that light travels, a unit vector that points down.
    """
    buildings = network.scenery.buildings
    pieces = [piece for building in buildings for piece in cast_pieces(footprint(building), building, sun)]
    standing = [footprint(building) for building in buildings if building.base == 0.0]
    return flat(shapely.union_all(pieces).difference(shapely.union_all(standing)))


def cast(form: shapely.Polygon, building: Building, sun: tuple[float, float, float]) -> BaseGeometry:
    """The shadow of a prism."""
    return shapely.union_all(cast_pieces(form, building, sun))


def cast_pieces(form: shapely.Polygon, building: Building, sun: tuple[float, float, float]) -> list[BaseGeometry]:
    """The shadow of a prism: its footprint swept from the underside's shadow to the roof's, edge by edge."""
    length = np.array([sun[0], sun[1]]) / -sun[2]
    length *= min(1.0, LONGEST_SHADOW / max(1e-9, building.height * np.hypot(*length)))
    near, far = building.base * length, building.height * length
    a = np.array(form.exterior.coords)
    swept = np.asarray(shapely.polygons(np.stack([a[:-1] + near, a[1:] + near, a[1:] + far, a[:-1] + far], axis=1)))
    ends = [shapely.affinity.translate(form, *near), shapely.affinity.translate(form, *far)]
    return [*ends, *swept[shapely.area(swept) > 0.0]]


def footprint(building: Building) -> shapely.Polygon:
    """The ground that a building stands on, or hangs over."""
    return shapely.Polygon(building.outline.T, [hole.T for hole in building.holes])
