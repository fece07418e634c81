"""Surfaces as binary glTF 2.0: the way to give viser a mesh with gloss and a colour per vertex."""

import json
import struct
from dataclasses import dataclass
from typing import Any

import numpy as np

from studio.scene.shape import Surface

# component and target codes of the glTF 2.0 specification, sections 3.6.2 and 5.11
UNSIGNED_SHORT, FLOAT, UNSIGNED_INT = 5123, 5126, 5125
VERTICES, INDICES = 34962, 34963


@dataclass(frozen=True)
class Material:
    """How a surface takes light: roughness 0 (mirror) .. 1 (chalk); unlit shows its colours as they are."""

    roughness: float = 1.0
    unlit: bool = False
    blend: bool = False
    double_sided: bool = False
    image: bytes = b""

    def as_gltf(self) -> dict:
        """The material object of a glTF document."""
        look: dict = {"metallicFactor": 0.0, "roughnessFactor": self.roughness}
        if self.image:
            look["baseColorTexture"] = {"index": 0}
        material: dict = {"pbrMetallicRoughness": look, "doubleSided": self.double_sided}
        if self.blend:
            material["alphaMode"] = "BLEND"
        if self.unlit:
            material["extensions"] = {"KHR_materials_unlit": {}}
        return material


class _Buffer:
    """The binary chunk, and where in it each array lies."""

    def __init__(self) -> None:
        self.data = b""
        self.views: list[dict] = []
        self.accessors: list[dict] = []

    def add(self, data: bytes, **view) -> int:
        self.views.append({"buffer": 0, "byteOffset": len(self.data), "byteLength": len(data), **view})
        self.data += data + b"\0" * (-len(data) % 4)
        return len(self.views) - 1

    def add_array(self, array: np.ndarray, *, component: int, target: int, kind: str, **limits) -> int:
        view = self.add(np.ascontiguousarray(array).tobytes(), target=target)
        self.accessors.append({"bufferView": view, "componentType": component, "count": len(array), "type": kind, **limits})
        return len(self.accessors) - 1


def glb(mesh: Surface, material: Material, *, uv: np.ndarray | None = None) -> bytes:
    """A binary glTF file with one mesh of one material; uv [n, 2] are texture coordinates."""
    buffer = _Buffer()
    document: dict[str, Any] = {
        "asset": {"version": "2.0", "generator": "Cooperative ADAS Studio"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [_primitive(buffer, mesh, uv, lit=not material.unlit)]}],
        "materials": [material.as_gltf()],
    }
    if material.unlit:
        document["extensionsUsed"] = ["KHR_materials_unlit"]
    if material.image:
        document |= _texture(buffer, material.image)
    document |= {
        "accessors": buffer.accessors,
        "bufferViews": buffer.views,
        "buffers": [{"byteLength": len(buffer.data)}],
    }
    return _packed(json.dumps(document).encode(), buffer.data)


def _primitive(buffer: _Buffer, mesh: Surface, uv: np.ndarray | None, *, lit: bool) -> dict:
    vertices = mesh.vertices.astype(np.float32)
    place = {"component": FLOAT, "target": VERTICES}
    attributes = {
        "POSITION": buffer.add_array(vertices, kind="VEC3", min=vertices.min(0).tolist(), max=vertices.max(0).tolist(), **place),
        "COLOR_0": buffer.add_array(_shades(mesh.colors), component=UNSIGNED_SHORT, target=VERTICES, kind="VEC4", normalized=True),
    }
    if lit:
        attributes["NORMAL"] = buffer.add_array(mesh.normals, kind="VEC3", **place)
    if uv is not None:
        attributes["TEXCOORD_0"] = buffer.add_array(uv.astype(np.float32), kind="VEC2", **place)
    short = len(vertices) <= 2**16 - 1
    faces = mesh.faces.astype(np.uint16 if short else np.uint32).ravel()
    indices = buffer.add_array(faces, component=UNSIGNED_SHORT if short else UNSIGNED_INT, target=INDICES, kind="SCALAR")
    return {"attributes": attributes, "indices": indices, "material": 0}


def _shades(colors: np.ndarray) -> np.ndarray:
    # sixteen bits of linear light and of opacity: twice as small as floats, and no steps to be seen in the dark
    alpha = np.ones((len(colors), 4))
    alpha[:, : colors.shape[1]] = colors
    return np.round(np.clip(alpha, 0.0, 1.0) * 65535.0).astype(np.uint16)


def _texture(buffer: _Buffer, image: bytes) -> dict:
    # 9987: trilinear mipmaps, 10497: repeat (glTF 2.0, section 5.26)
    return {
        "images": [{"bufferView": buffer.add(image), "mimeType": "image/png"}],
        "samplers": [{"magFilter": 9729, "minFilter": 9987, "wrapS": 10497, "wrapT": 10497}],
        "textures": [{"source": 0, "sampler": 0}],
    }


def _packed(document: bytes, data: bytes) -> bytes:
    document += b" " * (-len(document) % 4)
    length = 12 + 8 + len(document) + 8 + len(data)
    return b"".join(
        [
            struct.pack("<4sII", b"glTF", 2, length),
            struct.pack("<I4s", len(document), b"JSON"),
            document,
            struct.pack("<I4s", len(data), b"BIN\0"),
            data,
        ]
    )
