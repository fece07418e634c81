"""Surfaces: triangles with a colour at every vertex, and the few ways in which we make them.

Vertices are shared where the surface is smooth and doubled where it has an edge, because the renderer
computes a vertex normal as the mean of the faces that share the vertex.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from studio.scene.colour import linear


@dataclass(frozen=True)
class Surface:
    """Triangles: vertices float32[n, 3] [m], faces uint32[m, 3], colors float32[n, 3 | 4] (linear, alpha)."""

    vertices: np.ndarray
    faces: np.ndarray
    colors: np.ndarray

    def moved(self, *, x: float = 0.0, y: float = 0.0, z: float = 0.0) -> "Surface":
        """The same surface shifted [m]."""
        return Surface(self.vertices + np.array([x, y, z], np.float32), self.faces, self.colors)

    def turned(self, angle: float) -> "Surface":
        """The same surface turned about z [rad]."""
        c, s = np.cos(angle), np.sin(angle)
        turn = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]], np.float32)
        return Surface(self.vertices @ turn.T, self.faces, self.colors)

    def mirrored(self) -> "Surface":
        """The same surface with left and right exchanged."""
        return Surface(self.vertices * np.array([1, -1, 1], np.float32), self.faces[:, ::-1], self.colors)

    @property
    def normals(self) -> np.ndarray:
        """Area-weighted mean normal of every vertex, float32[n, 3]."""
        a, b, c = (self.vertices[self.faces[:, i]].astype(np.float64) for i in range(3))
        face_normals = np.cross(b - a, c - a)
        total = np.zeros_like(self.vertices, np.float64)
        for corner in range(3):
            np.add.at(total, self.faces[:, corner], face_normals)
        length = np.linalg.norm(total, axis=1, keepdims=True)
        return np.divide(total, length, out=np.tile([0.0, 0.0, 1.0], (len(total), 1)), where=length > 0).astype(np.float32)


def surface(vertices, faces, colour: str | np.ndarray) -> Surface:
    """A surface of one colour, or of one colour per vertex."""
    vertices = np.asarray(vertices, np.float32).reshape(-1, 3)
    colors = linear(colour) if isinstance(colour, str) else np.asarray(colour)
    colors = np.broadcast_to(colors, (len(vertices), colors.shape[-1])).astype(np.float32)
    return Surface(vertices, np.asarray(faces, np.uint32).reshape(-1, 3), colors)


def joined(parts: Iterable[Surface]) -> Surface:
    """Several surfaces as one."""
    parts = list(parts)
    starts = np.cumsum([0, *(len(part.vertices) for part in parts)])
    return Surface(
        np.concatenate([part.vertices for part in parts]),
        np.concatenate([part.faces + np.uint32(start) for part, start in zip(parts, starts, strict=False)]),
        np.concatenate([part.colors for part in parts]),
    )


def edged(mesh: Surface) -> Surface:
    """The same surface with every triangle on its own: every edge is hard."""
    picked = mesh.faces.ravel()
    faces = np.arange(len(picked), dtype=np.uint32).reshape(-1, 3)
    return Surface(mesh.vertices[picked], faces, mesh.colors[picked])


def grid(points: np.ndarray, kinds: np.ndarray, palette: Sequence[str]) -> Surface:
    """A net of quads through points [rows, columns, 3]; kinds [rows-1, columns-1] picks the colours.

    Smooth among neighbours of one kind, a hard edge between two kinds. Outside is where columns turn into
    rows by the right-hand rule.
    """
    rows, columns = points.shape[:2]
    corner = np.arange(rows * columns).reshape(rows, columns)
    quads = np.stack([corner[:-1, :-1], corner[:-1, 1:], corner[1:, 1:], corner[1:, :-1]], axis=-1)
    flat = points.reshape(-1, 3)
    return joined(_of_kind(flat, quads[kinds == kind], palette[kind]) for kind in np.unique(kinds))


def _of_kind(points: np.ndarray, quads: np.ndarray, colour: str) -> Surface:
    triangles = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    # points that coincide are one vertex, so that closed rings have no seam and poles do not crease
    used, faces = np.unique(triangles, return_inverse=True)
    places, same = np.unique(np.round(points[used], 6), axis=0, return_inverse=True)
    faces = same.ravel()[faces.reshape(-1, 3)]
    whole = (faces[:, 0] != faces[:, 1]) & (faces[:, 1] != faces[:, 2]) & (faces[:, 2] != faces[:, 0])
    return surface(places, faces[whole], colour)


def fan(ring: np.ndarray, colour: str) -> Surface:
    """The flat lid of a ring [n, 3] that runs counter-clockwise seen from outside."""
    # to the same micrometre as `grid`, so that a lid closes its body exactly
    ring = np.round(ring, 6)
    count = len(ring)
    here = np.arange(count)
    faces = np.stack([np.full(count, count), here, (here + 1) % count], axis=1)
    return surface(np.concatenate([ring, ring.mean(axis=0, keepdims=True)]), faces, colour)


def box(size: Sequence[float], colour: str) -> Surface:
    """A box [m] about the origin with hard edges."""
    signs = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], float)
    quads = np.array([[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]])
    faces = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    return edged(surface(signs * np.asarray(size) / 2.0, faces, colour))


def lathe(profile: np.ndarray, kinds: np.ndarray, palette: Sequence[str]) -> Surface:
    """A body turned about the y axis; profile [n, 2] of (radius, y) with y falling, kinds [segments, n-1]."""
    angle = np.linspace(0.0, 2.0 * np.pi, kinds.shape[0] + 1)[:, None]
    radius, y = profile[:, 0][None, :], profile[:, 1][None, :]
    points = np.stack(
        [radius * np.sin(angle), np.broadcast_to(y, (len(angle), len(profile))), radius * np.cos(angle)],
        axis=-1,
    )
    return grid(points, kinds, palette)


def ball(radii: Sequence[float], colour: str, *, segments: int = 10) -> Surface:
    """An ellipsoid about the origin, radii [m]."""
    turn = np.linspace(0.0, np.pi, segments // 2 + 1)
    profile = np.stack([np.sin(turn), np.cos(turn)], axis=1)
    kinds = np.zeros((segments, len(profile) - 1), int)
    whole = lathe(profile, kinds, [colour])
    return Surface(whole.vertices * np.asarray(radii, np.float32), whole.faces, whole.colors)


def cylinder(radius: float, height: float, colour: str, *, segments: int = 8) -> Surface:
    """An upright cylinder on the origin with its lids, smooth around."""
    angle = np.linspace(0.0, 2.0 * np.pi, segments, endpoint=False)
    ring = np.round(np.stack([radius * np.cos(angle), radius * np.sin(angle), np.zeros(segments)], axis=1), 6)
    top = ring + [0.0, 0.0, height]
    here = np.arange(segments)
    after = (here + 1) % segments
    faces = np.concatenate([np.stack([here, after, after + segments], 1), np.stack([here, after + segments, here + segments], 1)])
    return joined([surface(np.concatenate([ring, top]), faces, colour), fan(top, colour), fan(ring[::-1], colour)])
