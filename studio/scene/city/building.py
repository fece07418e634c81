"""Buildings: prisms with a façade of windows, all of a city in one mesh with one small drawn texture."""

import struct
import zlib
from collections.abc import Iterator

import mapbox_earcut
import numpy as np

from studio.road.network import Building
from studio.scene.colour import linear
from studio.scene.shape import Surface

BAY, FLOOR = 3.3, 3.1  # [m] width and height of the wall around one window
NARROWEST = 2.2  # [m] walls below this have no window
# where nothing is mapped: plaster and sandstone, as the eye expects them in a German city
WALLS = ["#e2dacb", "#d8cfc0", "#cfc8bd", "#e0d3c3", "#d9d6cf", "#cbc3b6", "#dcd0bb"]
ROOFS = ["#a39a90", "#968f88", "#a58f82", "#8f9092", "#ada69b"]
BLANK = 0.03  # a place on the texture without a window
LUMINANCE = np.array([0.2126, 0.7152, 0.0722])  # of linear light (ITU-R BT.709)
DARKEST = 0.11  # [1] luminance of a wall
FOOT_SHADE = 0.72  # the foot of a wall sees less of the sky


def buildings_surface(buildings: tuple[Building, ...]) -> tuple[Surface, np.ndarray]:
    """All buildings, and the texture coordinates float32[n, 2] of the façade."""
    parts = [part for number, building in enumerate(buildings) for part in _parts(building, number)]
    starts = np.cumsum([0, *(len(vertices) for vertices, *_ in parts)])
    faces = [faces + start for (_, faces, _, _), start in zip(parts, starts, strict=False)]
    return (
        Surface(
            np.concatenate([vertices for vertices, *_ in parts]).astype(np.float32),
            np.concatenate(faces).astype(np.uint32),
            np.concatenate([colors for _, _, colors, _ in parts]).astype(np.float32),
        ),
        np.concatenate([uv for *_, uv in parts]).astype(np.float32),
    )


def _parts(building: Building, number: int) -> Iterator[tuple[np.ndarray, ...]]:
    # neighbours differ, and the same building looks the same every time
    wall = lifted(linear(building.colour or WALLS[(number * 5) % len(WALLS)]))
    roof = linear(ROOFS[(number * 3) % len(ROOFS)])
    for ring in (building.outline, *building.holes):
        yield _walls(ring.T, building.base, building.height, wall)
    yield _roof(building, roof)


def lifted(colour: np.ndarray) -> np.ndarray:
    """A colour in which windows and edges are still seen: black glass shows the sky."""
    light = float(colour @ LUMINANCE)
    return colour if light >= DARKEST else colour + (DARKEST - light)


def _walls(ring: np.ndarray, base: float, top: float, colour: np.ndarray) -> tuple[np.ndarray, ...]:
    after = np.roll(ring, -1, axis=0)
    count = len(ring)
    low, high = np.full((count, 1), base), np.full((count, 1), top)
    corners = [
        np.hstack([ring, low]),
        np.hstack([after, low]),
        np.hstack([after, high]),
        np.hstack([ring, high]),
    ]
    quad = 4 * np.arange(count)[:, None]
    faces = np.concatenate([quad + [0, 1, 2], quad + [0, 2, 3]])
    shade = np.array([FOOT_SHADE if base < 1.0 else 1.0, 1.0])[[0, 0, 1, 1]]
    colors = np.tile(shade[:, None] * colour, (count, 1))
    return (
        np.stack(corners, 1).reshape(-1, 3),
        faces,
        colors,
        _wall_uv(np.hypot(*(after - ring).T), top - base),
    )


def _wall_uv(length: np.ndarray, height: float) -> np.ndarray:
    bays = np.maximum(1, np.round(length / BAY))
    floors = max(1, round(height / FLOOR))
    uv = np.array([[0, 0], [1, 0], [1, 1], [0, 1]]) * np.stack([bays, np.full(len(bays), floors)], 1)[:, None, :]
    uv[length < NARROWEST] = BLANK
    return uv.reshape(-1, 2)


def _roof(building: Building, colour: np.ndarray) -> tuple[np.ndarray, ...]:
    rings = [building.outline.T, *(hole.T for hole in building.holes)]
    places = np.concatenate(rings)
    ends = np.cumsum([len(ring) for ring in rings]).astype(np.uint32)
    faces = mapbox_earcut.triangulate_float64(places, ends).reshape(-1, 3)
    vertices = np.column_stack([places, np.full(len(places), building.height)])
    return (
        vertices,
        upward(vertices, faces),
        np.tile(colour, (len(places), 1)),
        np.full((len(places), 2), BLANK),
    )


def upward(vertices: np.ndarray, faces: np.ndarray) -> np.ndarray:
    """The same triangles, all of them seen from above."""
    faces = faces.astype(np.int64)
    a, b, c = (vertices[faces[:, i], :2] for i in range(3))
    area = (b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]
    return np.where((area < 0)[:, None], faces[:, ::-1], faces)


def facade(*, size: int = 64) -> bytes:
    """A PNG of one bay of one floor: a window with frame and sill; white where the wall's colour shows."""
    u, v = np.meshgrid((np.arange(size) + 0.5) / size, 1.0 - (np.arange(size) + 0.5) / size)
    image = np.full((size, size, 3), 250, np.uint8)
    image[v < 0.035] = 216
    image[_within(u, v, 0.27, 0.73, 0.24, 0.82)] = 236
    image[_within(u, v, 0.24, 0.76, 0.20, 0.245)] = 205
    glass = _within(u, v, 0.31, 0.69, 0.28, 0.78)
    sky = np.array([72, 84, 98]) + np.array([58, 62, 62]) * ((v - 0.28) / 0.5)[..., None]
    image[glass] = sky[glass].astype(np.uint8)
    image[glass & (np.abs(u - 0.5) < 0.018)] = 214
    image[glass & (np.abs(v - 0.62) < 0.014)] = 214
    return png(image)


def _within(u, v, left: float, right: float, low: float, high: float) -> np.ndarray:
    return (u > left) & (u < right) & (v > low) & (v < high)


def png(image: np.ndarray) -> bytes:
    """An image uint8[height, width, 3] as PNG (ISO/IEC 15948)."""
    height, width, _ = image.shape
    rows = np.hstack([np.zeros((height, 1), np.uint8), image.reshape(height, -1)])
    header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    chunks = [(b"IHDR", header), (b"IDAT", zlib.compress(rows.tobytes(), 9)), (b"IEND", b"")]
    return b"\x89PNG\r\n\x1a\n" + b"".join(_chunk(kind, data) for kind, data in chunks)


def _chunk(kind: bytes, data: bytes) -> bytes:
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
