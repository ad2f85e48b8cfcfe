"""glTF 2.0 in one binary file: nodes with meshes out, and what this project wrote back in.

glTF axes: x east, y up, z south. The same scene gives the same bytes.
"""

import json
import struct
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from assets.errors import AssetError
from assets.materials import MATERIALS
from assets.shape import Mesh
from assets.textures import Texture

R_GLTF_SITE = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]], dtype=np.float32)
MAGIC, VERSION = 0x46546C67, 2
JSON_CHUNK, BINARY_CHUNK = 0x4E4F534A, 0x004E4942
FLOAT, UNSIGNED_BYTE, UNSIGNED_SHORT, UNSIGNED_INT = 5126, 5121, 5123, 5125
ARRAY_BUFFER, ELEMENT_BUFFER = 34962, 34963
JPEG_QUALITY = 82
MIPMAPPED_REPEAT = {"magFilter": 9729, "minFilter": 9987, "wrapS": 10497, "wrapT": 10497}


@dataclass(frozen=True)
class Node:
    """One named thing of a scene."""

    name: str
    meshes: Sequence[Mesh]
    extras: Mapping[str, Any] = field(default_factory=dict)

    @property
    def triangles(self) -> int:
        """How many triangles it is drawn with."""
        return sum(len(mesh.triangles) for mesh in self.meshes)


@dataclass(frozen=True)
class Scene:
    """What a file holds: nodes, and the textures by material."""

    nodes: Sequence[Node]
    textures: Mapping[str, Texture]


class _Binary:
    """The binary chunk under construction, with its views and accessors."""

    def __init__(self) -> None:
        self.data = bytearray()
        self.views: list[dict[str, Any]] = []
        self.accessors: list[dict[str, Any]] = []

    def view(self, data: bytes, target: int | None = None) -> int:
        self.data += b"\0" * (-len(self.data) % 4)
        view: dict[str, Any] = {"buffer": 0, "byteOffset": len(self.data), "byteLength": len(data)}
        self.views.append(view if target is None else view | {"target": target})
        self.data += data
        return len(self.views) - 1

    def accessor(self, array: NDArray[Any], component: int, shape: str, **more: Any) -> int:
        target = ELEMENT_BUFFER if shape == "SCALAR" else ARRAY_BUFFER
        view = self.view(np.ascontiguousarray(array).tobytes(), target)
        entry = {"bufferView": view, "componentType": component, "count": len(array), "type": shape}
        self.accessors.append(entry | more)
        return len(self.accessors) - 1


def write_glb(scene: Scene, extras: Mapping[str, Any]) -> bytes:
    """Return the scene as a GLB; `extras` go to its `asset`."""
    binary = _Binary()
    used = list(dict.fromkeys(mesh.material for node in scene.nodes for mesh in node.meshes))
    meshes = [{"name": n.name, "primitives": [_primitive(binary, m, used) for m in n.meshes]} for n in scene.nodes]
    images = [
        {"mimeType": "image/jpeg", "bufferView": binary.view(_jpeg(scene.textures[name])), "name": name}
        for name in used
    ]
    document = {
        "asset": {"version": "2.0", "generator": "agora build", "extras": dict(extras)},
        "scene": 0,
        "scenes": [{"nodes": list(range(len(scene.nodes)))}],
        "nodes": [{"name": n.name, "mesh": i, "extras": dict(n.extras)} for i, n in enumerate(scene.nodes)],
        "meshes": meshes,
        "materials": [_material(name, i) for i, name in enumerate(used)],
        "textures": [{"source": i, "sampler": 0} for i in range(len(used))],
        "images": images,
        "samplers": [MIPMAPPED_REPEAT],
        "accessors": binary.accessors,
        "bufferViews": binary.views,
        "buffers": [{"byteLength": len(binary.data)}],
    }
    text = json.dumps(document, separators=(",", ":"), ensure_ascii=False).encode()
    text += b" " * (-len(text) % 4)
    data = bytes(binary.data) + b"\0" * (-len(binary.data) % 4)
    chunks = struct.pack("<II", len(text), JSON_CHUNK) + text + struct.pack("<II", len(data), BINARY_CHUNK) + data
    return struct.pack("<III", MAGIC, VERSION, 12 + len(chunks)) + chunks


def _primitive(binary: _Binary, mesh: Mesh, used: list[str]) -> dict[str, Any]:
    positions = mesh.positions_m @ R_GLTF_SITE.T
    bounds = {"min": positions.min(axis=0).tolist(), "max": positions.max(axis=0).tolist()}
    small = len(positions) <= 65535
    indices = mesh.triangles.ravel().astype(np.uint16 if small else np.uint32)
    colours = np.concatenate([mesh.colours, np.full((len(mesh.colours), 1), 255, dtype=np.uint8)], axis=1)
    normals = np.clip((mesh.normals @ R_GLTF_SITE.T).astype(np.float32), -1.0, 1.0)
    return {
        "attributes": {
            "POSITION": binary.accessor(positions, FLOAT, "VEC3", **bounds),
            "NORMAL": binary.accessor(normals, FLOAT, "VEC3"),
            "TEXCOORD_0": binary.accessor(mesh.uvs, FLOAT, "VEC2"),
            "COLOR_0": binary.accessor(colours, UNSIGNED_BYTE, "VEC4", normalized=True),
        },
        "indices": binary.accessor(indices, UNSIGNED_SHORT if small else UNSIGNED_INT, "SCALAR"),
        "material": used.index(mesh.material),
    }


def _material(name: str, texture: int) -> dict[str, Any]:
    surface = {
        "baseColorTexture": {"index": texture},
        "metallicFactor": 0.0,
        "roughnessFactor": MATERIALS[name].roughness,
    }
    return {"name": name, "pbrMetallicRoughness": surface}


def _jpeg(texture: Texture) -> bytes:
    return bytes(cv2.imencode(".jpg", texture, [cv2.IMWRITE_JPEG_QUALITY, JPEG_QUALITY])[1])


def read_glb(path: Path) -> Scene:
    """Return the scene of a file that `write_glb` made.

    Raises:
        AssetError: The file is missing or is no GLB of ours.
    """
    try:
        data = path.read_bytes()
    except OSError as exc:
        raise AssetError(f"model {path} cannot be read; build the models with: agora build.") from exc
    try:
        return _scene(data)
    except (KeyError, IndexError, ValueError, struct.error, cv2.error) as exc:
        raise AssetError(f"model {path} is not a GLB that this program made; build it with: agora build.") from exc


def _scene(data: bytes) -> Scene:
    magic, _, _, text_size, kind = struct.unpack_from("<IIIII", data)
    if magic != MAGIC or kind != JSON_CHUNK:
        raise ValueError("no GLB")
    document = json.loads(data[20 : 20 + text_size])
    binary = memoryview(data)[28 + text_size :]
    nodes = []
    for node in document["nodes"]:
        primitives = document["meshes"][node["mesh"]]["primitives"]
        meshes = [_mesh(document, binary, primitive) for primitive in primitives]
        nodes.append(Node(node["name"], meshes, node["extras"]))
    textures: dict[str, Texture] = {}
    for image in document["images"]:
        raw = np.frombuffer(_view(document, binary, image["bufferView"]), dtype=np.uint8)
        textures[image["name"]] = np.asarray(cv2.imdecode(raw, cv2.IMREAD_COLOR), dtype=np.uint8)
    return Scene(nodes, textures)


def _view(document: dict[str, Any], binary: memoryview, index: int) -> memoryview:
    view = document["bufferViews"][index]
    return binary[view["byteOffset"] : view["byteOffset"] + view["byteLength"]]


def _mesh(document: dict[str, Any], binary: memoryview, primitive: dict[str, Any]) -> Mesh:
    kinds = {FLOAT: np.float32, UNSIGNED_BYTE: np.uint8, UNSIGNED_SHORT: np.uint16, UNSIGNED_INT: np.uint32}
    widths = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}

    def array(index: int) -> NDArray[Any]:
        accessor = document["accessors"][index]
        raw = np.frombuffer(_view(document, binary, accessor["bufferView"]), dtype=kinds[accessor["componentType"]])
        return raw.reshape(accessor["count"], widths[accessor["type"]])

    attributes = primitive["attributes"]
    return Mesh(
        document["materials"][primitive["material"]]["name"],
        array(attributes["POSITION"]) @ R_GLTF_SITE,
        array(attributes["NORMAL"]) @ R_GLTF_SITE,
        array(attributes["TEXCOORD_0"]),
        array(attributes["COLOR_0"])[:, :3],
        array(primitive["indices"]).reshape(-1, 3).astype(np.uint32),
    )
