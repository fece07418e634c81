"""Plane shapes as triangles on the plane z = 0; how high each layer lies is the city's."""

from dataclasses import dataclass

import mapbox_earcut
import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from studio.road.network.plane import polygons


@dataclass(frozen=True, eq=False)
class Mesh:
    """Triangles: vertices float32[n, 3] [m], faces uint32[m, 3], counter-clockwise seen from outside."""

    vertices: np.ndarray
    faces: np.ndarray


def empty() -> Mesh:
    """No triangles."""
    return Mesh(np.empty((0, 3), np.float32), np.empty((0, 3), np.uint32))


def merged(meshes: list[Mesh]) -> Mesh:
    """All triangles in one mesh."""
    if not meshes:
        return empty()
    start = np.cumsum([0, *(len(mesh.vertices) for mesh in meshes[:-1])])
    faces = [mesh.faces + np.uint32(first) for mesh, first in zip(meshes, start, strict=True)]
    return Mesh(np.concatenate([mesh.vertices for mesh in meshes]), np.concatenate(faces))


def flat(form: BaseGeometry) -> Mesh:
    """A plane shape as triangles that face up."""
    return merged([triangulated(polygon) for polygon in polygons(form)])


def triangulated(polygon: shapely.Polygon) -> Mesh:
    """A polygon as triangles."""
    rings = [np.array(ring.coords)[:-1, :2] for ring in (polygon.exterior, *polygon.interiors)]
    points = np.concatenate(rings)
    ends = np.cumsum([len(ring) for ring in rings]).astype(np.uint32)
    faces = mapbox_earcut.triangulate_float64(points, ends).reshape(-1, 3)
    vertices = np.column_stack([points, np.zeros(len(points))]).astype(np.float32)
    return Mesh(vertices, facing_up(points, faces.astype(np.uint32)))


def facing_up(points: np.ndarray, faces: np.ndarray) -> np.ndarray:
    """The triangles with their corners counter-clockwise seen from above."""
    a, b, c = points[faces[:, 0]], points[faces[:, 1]], points[faces[:, 2]]
    ab, ac = b - a, c - a
    clockwise = ab[:, 0] * ac[:, 1] - ab[:, 1] * ac[:, 0] < 0.0
    faces[clockwise] = faces[clockwise][:, ::-1]
    return faces
