"""A scene as glTF 2.0 in one binary file.

glTF axes: x east, y up, z south. The same scene gives the same bytes. Positions are written as 16-bit shares of their
node's box (KHR_mesh_quantization), a mesh that is drawn many times once (EXT_mesh_gpu_instancing), pictures as WebP.
"""

import json
import struct
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from assets.axes import Array
from assets.materials import MATERIALS
from assets.scene import Instanced, Node, Scene, expanded
from assets.shape import Mesh
from assets.surfaces import COLOUR_QUALITY, NORMAL_QUALITY, ROUGHNESS_QUALITY, Surface, webp

__all__ = ["Instanced", "Node", "Scene", "expanded", "write_glb"]

R_GLTF_SITE = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]], dtype=np.float32)
MAGIC, VERSION = 0x46546C67, 2
JSON_CHUNK, BINARY_CHUNK = 0x4E4F534A, 0x004E4942
BYTE, UNSIGNED_BYTE, SHORT, UNSIGNED_SHORT, UNSIGNED_INT, FLOAT = 5120, 5121, 5122, 5123, 5125, 5126
KINDS = {BYTE: "i1", UNSIGNED_BYTE: "u1", SHORT: "<i2", UNSIGNED_SHORT: "<u2", UNSIGNED_INT: "<u4", FLOAT: "<f4"}
ARRAY_BUFFER, ELEMENT_BUFFER = 34962, 34963
POSITION_STEPS, NORMAL_STEPS = 32767, 127
LEAST_HALF_M = 32.767
"""Half of a cube that positions are shares of is at least this: whole millimetres need fewer bytes than finer steps."""
UV_STEPS = 1024
"""Texture coordinates are rounded to this part of a repeat: some millimetres of a surface, and far fewer bytes."""
MIPMAPPED_REPEAT = {"magFilter": 9729, "minFilter": 9987, "wrapS": 10497, "wrapT": 10497}
QUANTIZATION, INSTANCING, WEBP = "KHR_mesh_quantization", "EXT_mesh_gpu_instancing", "EXT_texture_webp"


class _File:
    """The document under construction and its binary chunk."""

    def __init__(self, surfaces: Mapping[str, Surface]) -> None:
        self.data = bytearray()
        self.lists: dict[str, list[dict[str, Any]]] = {}
        self.extensions: set[str] = set()
        self._shared: dict[int, tuple[int, Array, float]] = {}
        self.materials = {name: self.add("materials", self._material(name, s)) for name, s in surfaces.items()}

    def add(self, kind: str, entry: dict[str, Any]) -> int:
        entries = self.lists.setdefault(kind, [])
        entries.append(entry)
        return len(entries) - 1

    def view(self, data: bytes, **more: Any) -> int:
        self.data += b"\0" * (-len(self.data) % 4)
        view = {"buffer": 0, "byteOffset": len(self.data), "byteLength": len(data)} | more
        self.data += data
        return self.add("bufferViews", view)

    def accessor(self, array: NDArray[Any], component: int, shape: str, target: int | None, **more: Any) -> int:
        """Write rows, each on a multiple of four bytes where a vertex shader reads them."""
        rows = np.asarray(array).astype(KINDS[component]).reshape(len(array), -1)
        if target == ARRAY_BUFFER:
            rows = np.pad(rows, ((0, 0), (0, -rows.shape[1] * rows.itemsize % 4 // rows.itemsize)))
        views = {} if target is None else {"target": target}
        views |= {"byteStride": rows.shape[1] * rows.itemsize} if target == ARRAY_BUFFER else {}
        view = self.view(np.ascontiguousarray(rows).tobytes(), **views)
        entry = {"bufferView": view, "componentType": component, "count": len(rows), "type": shape}
        return self.add("accessors", entry | more)

    def node(self, node: Node) -> int:
        """Write a node; where it has copies, these and its own meshes stand below it."""
        named = {"name": node.name, "extras": dict(node.extras)}
        if not node.instances:
            return self.add("nodes", named | (self._placed(node.name, node.meshes) if node.meshes else {}))
        parts = [self._placed(node.name, node.meshes)] if node.meshes else []
        parts += [self._copies(node.name, part) for part in node.instances]
        return self.add("nodes", named | {"children": [self.add("nodes", part) for part in parts]})

    def _placed(self, name: str, meshes: Sequence[Mesh]) -> dict[str, Any]:
        mesh, centre, half = self._mesh(name, meshes)
        self.extensions.add(QUANTIZATION)
        return {"mesh": mesh, "translation": centre.tolist(), "scale": [half] * 3}

    def _copies(self, name: str, part: Instanced) -> dict[str, Any]:
        if id(part.mesh) not in self._shared:  # several nodes may hold copies of one mesh
            self._shared[id(part.mesh)] = self._mesh(name, [part.mesh])
        mesh, centre, half = self._shared[id(part.mesh)]
        C = np.eye(4)
        C[:3, :3] = R_GLTF_SITE
        T = C @ part.T_site_part @ C.T
        size = np.linalg.norm(T[:, :3, :3], axis=1)
        turn = Rotation.from_matrix(T[:, :3, :3] / size[:, None]).as_quat(canonical=True)
        columns = {
            "TRANSLATION": (T[:, :3, :3] @ centre + T[:, :3, 3], "VEC3"),
            "ROTATION": (turn, "VEC4"),
            "SCALE": (size * half, "VEC3"),
        }
        attributes = {key: self.accessor(rows, FLOAT, shape, None) for key, (rows, shape) in columns.items()}
        self.extensions |= {QUANTIZATION, INSTANCING}
        return {"mesh": mesh, "extensions": {INSTANCING: {"attributes": attributes}}}

    def _mesh(self, name: str, meshes: Sequence[Mesh]) -> tuple[int, Array, float]:
        """Write meshes and return them with the centre and half the side of the cube that their positions are shares of."""
        points = np.concatenate([mesh.positions_m for mesh in meshes]).astype(np.float64) @ R_GLTF_SITE.T
        low, high = points.min(axis=0), points.max(axis=0)
        centre = ((low + high) / 2.0).astype(np.float32).astype(np.float64)
        half = float(np.float32(max((high - low).max() / 2.0 * 1.000001, LEAST_HALF_M)))
        primitives = [self._primitive(mesh, centre, half) for mesh in meshes]
        return self.add("meshes", {"name": name, "primitives": primitives}), centre, half

    def _primitive(self, mesh: Mesh, centre: Array, half: float) -> dict[str, Any]:
        shares = (mesh.positions_m.astype(np.float64) @ R_GLTF_SITE.T - centre) / half
        positions = np.clip(np.rint(shares * POSITION_STEPS), -POSITION_STEPS, POSITION_STEPS).astype(np.int16)
        bounds = {"min": positions.min(axis=0).tolist(), "max": positions.max(axis=0).tolist()}
        normals = np.rint(np.clip(mesh.normals @ R_GLTF_SITE.T, -1.0, 1.0) * NORMAL_STEPS)
        colours = np.concatenate([mesh.colours, np.full((len(mesh.colours), 1), 255, dtype=np.uint8)], axis=1)
        uvs = np.rint(mesh.uvs.astype(np.float64) * UV_STEPS) / UV_STEPS
        kind = UNSIGNED_SHORT if len(positions) <= 65535 else UNSIGNED_INT
        return {
            "attributes": {
                "POSITION": self.accessor(positions, SHORT, "VEC3", ARRAY_BUFFER, normalized=True, **bounds),
                "NORMAL": self.accessor(normals, BYTE, "VEC3", ARRAY_BUFFER, normalized=True),
                "TEXCOORD_0": self.accessor(uvs, FLOAT, "VEC2", ARRAY_BUFFER),
                "COLOR_0": self.accessor(colours, UNSIGNED_BYTE, "VEC4", ARRAY_BUFFER, normalized=True),
            },
            "indices": self.accessor(mesh.triangles.ravel(), kind, "SCALAR", ELEMENT_BUFFER),
            "material": self.materials[mesh.material],
        }

    def _material(self, name: str, surface: Surface) -> dict[str, Any]:
        look: dict[str, Any] = {"metallicFactor": 0.0, "roughnessFactor": MATERIALS[name].roughness}
        if surface.colour is None:
            look["baseColorFactor"] = [round(value, 4) for value in surface.mean_rgb] + [1.0]
        else:
            look["baseColorTexture"] = self._texture(name, webp(surface.colour, COLOUR_QUALITY))
        if surface.roughness is not None:
            blank = np.zeros_like(surface.roughness)
            picture = np.dstack([blank, surface.roughness, np.full_like(blank, 255)])  # green is read, blue is metal
            look |= {"roughnessFactor": 1.0}
            look["metallicRoughnessTexture"] = self._texture(f"{name}.roughness", webp(picture, ROUGHNESS_QUALITY))
        material = {"name": name, "pbrMetallicRoughness": look}
        if surface.normal is not None:
            material["normalTexture"] = self._texture(f"{name}.normal", webp(surface.normal, NORMAL_QUALITY))
        return material

    def _texture(self, name: str, data: bytes) -> dict[str, int]:
        self.extensions.add(WEBP)
        if "samplers" not in self.lists:
            self.add("samplers", dict(MIPMAPPED_REPEAT))
        image = self.add("images", {"name": name, "mimeType": "image/webp", "bufferView": self.view(data)})
        return {"index": self.add("textures", {"sampler": 0, "extensions": {WEBP: {"source": image}}})}

    def packed(self, extras: Mapping[str, Any], roots: list[int]) -> bytes:
        """Return the whole file."""
        document: dict[str, Any] = {
            "asset": {"version": "2.0", "generator": "agora build", "extras": dict(extras)},
            **({"scene": 0, "scenes": [{"nodes": roots}]} if roots else {}),
            **self.lists,
            "buffers": [{"byteLength": len(self.data)}],
        }
        if self.extensions:
            # a reader without instancing still shows each part once
            document["extensionsUsed"] = sorted(self.extensions)
            document["extensionsRequired"] = sorted(self.extensions - {INSTANCING})
        text = json.dumps(document, separators=(",", ":"), ensure_ascii=False).encode()
        text += b" " * (-len(text) % 4)
        data = bytes(self.data) + b"\0" * (-len(self.data) % 4)
        chunks = struct.pack("<II", len(text), JSON_CHUNK) + text + struct.pack("<II", len(data), BINARY_CHUNK) + data
        return struct.pack("<III", MAGIC, VERSION, 12 + len(chunks)) + chunks


def write_glb(scene: Scene, extras: Mapping[str, Any], surfaces: Mapping[str, Surface] | None = None) -> bytes:
    """Return the scene as a GLB.

    Args:
        scene: Nodes, and the textures of their materials.
        extras: Go to the file's `asset`.
        surfaces: How its materials look, by name; None draws the scene's textures as they are.
    """
    looks = {name: Surface(texture) for name, texture in scene.textures.items()} if surfaces is None else surfaces
    file = _File(looks)
    return file.packed(extras, [file.node(node) for node in scene.nodes])
