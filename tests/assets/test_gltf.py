"""GLB files: what goes in comes out, in any reader."""

import json
import struct
from pathlib import Path

import numpy as np
import pytest
import trimesh

from assets.errors import AssetError
from assets.gltf import Node, Scene, read_glb, write_glb
from assets.materials import MATERIALS
from assets.shape import Place, Shape


@pytest.fixture
def scene() -> Scene:
    shape = Shape()
    shape.box("marble", (0.0, 0.0, 0.0), (1.0, 2.0, 3.0), (0.5, 0.6, 0.7))
    shape.polygons("tiles", [(0.0, 0.0, 3.0), (1.0, 0.0, 3.0), (0.5, 1.0, 4.0)])
    meshes = shape.meshes(Place.at(10.0, -20.0, 0.5, 0.3))
    textures = {name: MATERIALS[name].paint() for name in ("marble", "tiles")}
    return Scene([Node("block", meshes, {"role": "building", "évidence": "höchst"})], textures)


@pytest.fixture
def file(scene: Scene, tmp_path: Path) -> Path:
    path = tmp_path / "a.glb"
    path.write_bytes(write_glb(scene, {"site": "x"}))
    return path


def test_what_is_written_is_read_again(scene: Scene, file: Path) -> None:
    again = read_glb(file)
    assert [(node.name, dict(node.extras)) for node in again.nodes] == [
        ("block", {"role": "building", "évidence": "höchst"})
    ]
    for before, after in zip(scene.nodes[0].meshes, again.nodes[0].meshes, strict=True):
        assert after.material == before.material
        assert after.positions_m == pytest.approx(before.positions_m, abs=1e-6)
        assert after.normals == pytest.approx(before.normals, abs=1e-6)
        assert after.uvs == pytest.approx(before.uvs)
        assert (after.colours == before.colours).all()
        assert (after.triangles == before.triangles).all()
    assert np.abs(again.textures["tiles"].astype(float) - scene.textures["tiles"]).mean() < 8.0


def test_another_reader_sees_the_same_box_with_y_up(scene: Scene, file: Path) -> None:
    points = np.concatenate([mesh.positions_m for mesh in scene.nodes[0].meshes])
    low, high = points.min(axis=0), points.max(axis=0)
    bounds = trimesh.load(file).bounds
    assert bounds[0] == pytest.approx([low[0], low[2], -high[1]], abs=1e-5)
    assert bounds[1] == pytest.approx([high[0], high[2], -low[1]], abs=1e-5)


def test_the_same_scene_gives_the_same_bytes(scene: Scene) -> None:
    assert write_glb(scene, {"site": "x"}) == write_glb(scene, {"site": "x"})


def test_everything_is_aligned_and_measured_as_the_format_asks(file: Path) -> None:
    data = file.read_bytes()
    magic, version, length, text_size, kind = struct.unpack_from("<IIIII", data)
    assert (magic, version, length, kind) == (0x46546C67, 2, len(data), 0x4E4F534A)
    document = json.loads(data[20 : 20 + text_size])
    assert all(view["byteOffset"] % 4 == 0 for view in document["bufferViews"])
    assert document["buffers"][0]["byteLength"] <= len(data) - 28 - text_size


@pytest.mark.parametrize("damage", [lambda data: data[:200], lambda data: b"glTX" + data[4:], lambda data: b""])
def test_a_damaged_file_is_named(file: Path, damage: object) -> None:
    assert callable(damage)
    file.write_bytes(damage(file.read_bytes()))
    with pytest.raises(AssetError, match=r"a\.glb is not a GLB that this program made; build it with: agora build"):
        read_glb(file)


def test_a_missing_file_is_named(tmp_path: Path) -> None:
    with pytest.raises(AssetError, match=r"none\.glb cannot be read; build the models with: agora build"):
        read_glb(tmp_path / "none.glb")
