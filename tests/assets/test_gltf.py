"""GLB files: what a file says is what the scene was, however it is read."""

import json
import struct
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest
import trimesh
from numpy.typing import NDArray

from assets.gltf import Instanced, Node, Scene, expanded, write_glb
from assets.materials import MATERIALS
from assets.shape import Mesh, Place, Shape
from assets.surfaces import Surface

KINDS = {5120: "i1", 5121: "u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}
R_SITE_GLTF = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])


@pytest.fixture
def meshes() -> list[Mesh]:
    shape = Shape()
    shape.box("marble", (0.0, 0.0, 0.0), (1.0, 2.0, 3.0), (0.5, 0.6, 0.7))
    shape.polygons("tiles", [(0.0, 0.0, 3.0), (1.0, 0.0, 3.0), (0.5, 1.0, 4.0)])
    return shape.meshes(Place.at(10.0, -20.0, 0.5, 0.3))


@pytest.fixture
def scene(meshes: list[Mesh]) -> Scene:
    textures = {name: MATERIALS[name].paint() for name in ("marble", "tiles")}
    return Scene([Node("block", meshes, {"role": "building", "évidence": "höchst"})], textures)


def copies() -> Instanced:
    """A block, drawn twice: turned and made flat and long, and as it is elsewhere."""
    shape = Shape()
    shape.box("marble", (0.0, 0.0, 0.0), (1.0, 2.0, 3.0))
    T = np.tile(np.eye(4), (2, 1, 1))
    T[0, :3, :3] = np.array([[0.0, -1.0, 0.0], [0.6, 0.0, -0.8], [0.8, 0.0, 0.6]]) * (2.0, 0.5, 1.0)
    T[:, :3, 3] = (5.0, 6.0, 7.0), (-30.0, 2.0, 0.0)
    return Instanced(shape.meshes(Place.at(0.0, 0.0, 0.0))[0], T)


def parsed(data: bytes) -> tuple[dict[str, Any], bytes]:
    """Return a file's document and its binary chunk."""
    size = int.from_bytes(data[12:16], "little")
    return json.loads(data[20 : 20 + size]), data[28 + size :]


def array_of(document: dict[str, Any], binary: bytes, index: int) -> NDArray[Any]:
    """Return an accessor's rows, shares as shares."""
    accessor = document["accessors"][index]
    view = document["bufferViews"][accessor["bufferView"]]
    kind, width = np.dtype(KINDS[accessor["componentType"]]), WIDTHS[accessor["type"]]
    stride = view.get("byteStride", kind.itemsize * width)
    raw = np.frombuffer(binary, np.uint8, view["byteLength"], view["byteOffset"]).reshape(-1, stride)
    rows = np.ascontiguousarray(raw[:, : kind.itemsize * width]).view(kind).reshape(accessor["count"], width)
    return rows / np.iinfo(kind).max if accessor.get("normalized") else rows


def test_what_is_written_is_there(scene: Scene) -> None:
    document, binary = parsed(write_glb(scene, {"site": "x"}))
    assert document["asset"]["extras"] == {"site": "x"}
    (node,) = document["nodes"]
    assert (node["name"], node["extras"]) == ("block", {"role": "building", "évidence": "höchst"})
    for mesh, primitive in zip(scene.nodes[0].meshes, document["meshes"][node["mesh"]]["primitives"], strict=True):
        of = {name: array_of(document, binary, index) for name, index in primitive["attributes"].items()}
        positions = (of["POSITION"] * node["scale"] + node["translation"]) @ R_SITE_GLTF.T
        assert positions == pytest.approx(mesh.positions_m, abs=0.001)
        assert of["NORMAL"] @ R_SITE_GLTF.T == pytest.approx(mesh.normals, abs=0.005)
        assert of["TEXCOORD_0"] == pytest.approx(mesh.uvs, abs=0.0005)
        assert of["COLOR_0"][:, :3] * 255 == pytest.approx(mesh.colours)
        assert array_of(document, binary, primitive["indices"]).reshape(-1, 3).tolist() == mesh.triangles.tolist()
        material = document["materials"][primitive["material"]]
        assert (material["name"], material["pbrMetallicRoughness"]["metallicFactor"]) == (mesh.material, 0.0)


def test_pictures_are_webp_and_look_as_painted(scene: Scene) -> None:
    document, binary = parsed(write_glb(scene, {}))
    for image in document["images"]:
        view = document["bufferViews"][image["bufferView"]]
        data = np.frombuffer(binary, np.uint8, view["byteLength"], view["byteOffset"])
        assert (image["mimeType"], bytes(data[8:12])) == ("image/webp", b"WEBP")
        picture = cv2.imdecode(data, cv2.IMREAD_COLOR)
        assert picture is not None
        assert np.abs(picture.astype(float) - scene.textures[image["name"]]).mean() < 8.0
    assert "EXT_texture_webp" in document["extensionsRequired"]


def test_another_reader_sees_the_same_box_with_y_up(scene: Scene, tmp_path: Path) -> None:
    path = tmp_path / "a.glb"
    path.write_bytes(write_glb(scene, {}, {name: Surface(None) for name in scene.textures}))
    points = np.concatenate([mesh.positions_m for mesh in scene.nodes[0].meshes])
    low, high = points.min(axis=0), points.max(axis=0)
    # it does not know that whole numbers are shares
    node = parsed(path.read_bytes())[0]["nodes"][0]
    seen = (trimesh.load(path).bounds - node["translation"]) / 32767.0 + node["translation"]
    assert seen[0] == pytest.approx([low[0], low[2], -high[1]], abs=0.001)
    assert seen[1] == pytest.approx([high[0], high[2], -low[1]], abs=0.001)


def test_a_mesh_with_copies_is_written_once_and_each_copy_lies_in_its_place(meshes: list[Mesh]) -> None:
    part = copies()
    scene = Scene([Node("row", meshes, {"role": "building"}, [part]), Node("other", (), {}, [part])], {})
    surfaces = {"marble": Surface(None), "tiles": Surface(None)}
    document, binary = parsed(write_glb(scene, {}, surfaces))
    assert len(document["meshes"]) == 2
    row = document["nodes"][document["scenes"][0]["nodes"][0]]
    assert (row["name"], row["extras"]) == ("row", {"role": "building"})
    own, child = (document["nodes"][i] for i in row["children"])
    assert "extensions" not in own
    attributes = child["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]
    (move, turn, size) = (array_of(document, binary, attributes[n]) for n in ("TRANSLATION", "ROTATION", "SCALE"))
    primitive = document["meshes"][child["mesh"]]["primitives"][0]
    shares = array_of(document, binary, primitive["attributes"]["POSITION"])
    x, y, z, w = turn.T
    R = np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    ).transpose(2, 0, 1)
    placed = ((shares[None] * size[:, None]) @ R.transpose(0, 2, 1) + move[:, None]) @ R_SITE_GLTF.T
    assert placed.reshape(-1, 3) == pytest.approx(part.expanded().positions_m, abs=0.003)


def test_copies_expanded_are_where_their_transforms_put_them() -> None:
    part = copies()
    (node,) = expanded(Scene([Node("row", (), {}, [part])], {})).nodes
    (mesh,) = node.meshes
    assert node.instances == ()
    assert len(mesh.triangles) == node.triangles == part.triangles == 2 * len(part.mesh.triangles)
    corner = part.T_site_part @ [1.0, 2.0, 3.0, 1.0]
    for point in corner[:, :3]:
        assert np.linalg.norm(mesh.positions_m - point, axis=1).min() < 1e-5
    a, b, c = (mesh.positions_m[mesh.triangles[:, i]] for i in range(3))
    across = np.cross(b - a, c - a)
    facing = (across * mesh.normals[mesh.triangles[:, 0]]).sum(axis=1) / np.linalg.norm(across, axis=1)
    assert facing == pytest.approx(1.0, abs=1e-5)  # normals stay square to faces that were stretched


def test_a_transform_of_the_wrong_shape_is_refused() -> None:
    with pytest.raises(ValueError, match=r"expected transforms \(n, 4, 4\) with n > 0, got \(4, 4\)"):
        Instanced(copies().mesh, np.eye(4))


def test_materials_alone_make_a_file() -> None:
    grey = np.full((4, 4, 3), 128, np.uint8)
    surface = Surface(grey, normal=grey, roughness=np.full((4, 4), 200, np.uint8))
    document, _ = parsed(
        write_glb(Scene([], {}), {}, {"marble": surface, "water": Surface(None, mean_rgb=(0.1, 0.2, 0.3))})
    )
    assert "scenes" not in document
    marble, water = document["materials"]
    assert marble["normalTexture"] == {"index": 2}
    assert marble["pbrMetallicRoughness"]["metallicRoughnessTexture"] == {"index": 1}
    assert marble["pbrMetallicRoughness"]["roughnessFactor"] == 1.0
    assert water["pbrMetallicRoughness"]["baseColorFactor"] == [0.1, 0.2, 0.3, 1.0]


def test_the_same_scene_gives_the_same_bytes(scene: Scene) -> None:
    assert write_glb(scene, {"site": "x"}) == write_glb(scene, {"site": "x"})


def test_everything_is_aligned_and_measured_as_the_format_asks(scene: Scene) -> None:
    data = write_glb(scene, {"site": "x"})
    magic, version, length, text_size, kind = struct.unpack_from("<IIIII", data)
    assert (magic, version, length, kind) == (0x46546C67, 2, len(data), 0x4E4F534A)
    document, _ = parsed(data)
    assert all(view["byteOffset"] % 4 == 0 for view in document["bufferViews"])
    assert document["buffers"][0]["byteLength"] <= len(data) - 28 - text_size
