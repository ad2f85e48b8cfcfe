"""Models that a site brings along: where they stand, what they say of themselves, and broken files."""

import math
import shutil
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh

from assets.brought import measure, pieces
from assets.brought_node import brought_node
from assets.errors import SiteError
from assets.records import ModelFile
from assets.roman import build_roman
from assets.site import load_site
from assets.today import build_today

KEY, FILE = "kiosk.model.file", Path("monuments.toml")
KIOSK = """
[kiosk]
name = { en = "Kiosk", tr = "Köşk" }
kind = "model"
epochs = ["roman", "today"]
evidence = "hypothetical"
sources = ["tale"]
caption_status = "unreviewed"
caption = { en = "A box. It came as a file.", tr = "Bir kutu. Dosya olarak geldi." }

[kiosk.model]
file = "kiosk.glb"
e_m = 30.0
n_m = 20.0
z_m = 1.0
heading_deg = 90.0
scale = 2.0
"""


def write_glb(path: Path, geometry: Any) -> None:
    scene: Any = trimesh.Scene(geometry)
    path.write_bytes(scene.export(file_type="glb"))


def write_box(path: Path) -> Path:
    """A box of red stone, 1 m wide (x), 3 m high (y), 2 m deep towards the viewer (z), from its origin."""
    box = trimesh.creation.box((1.0, 3.0, 2.0))
    box.apply_translation((0.5, 1.5, 1.0))
    box.visual.vertex_colors = np.tile(np.array([200, 40, 30, 255], dtype=np.uint8), (len(box.vertices), 1))
    write_glb(path, box)
    return path


@pytest.fixture
def model(tmp_path: Path) -> ModelFile:
    return ModelFile(write_box(tmp_path / "kiosk.glb"), 30.0, 20.0, 1.0, math.radians(90.0), 2.0)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """The second site with a box beside its temple."""
    folder = tmp_path / "site"
    shutil.copytree(Path(__file__).parents[1] / "second_site", folder, ignore=shutil.ignore_patterns("*.py", "__*"))
    with (folder / "monuments.toml").open("a", encoding="utf-8") as file:
        file.write(KIOSK)
    write_box(folder / "kiosk.glb")
    return folder


def test_a_model_stands_where_the_georeference_says(model: ModelFile) -> None:
    (piece,) = pieces(model, KEY, FILE)
    low, high = piece.positions_m.min(axis=0), piece.positions_m.max(axis=0)
    # its -Z, which was north, looks east: 2 m deep towards the viewer become 4 m to the west, 1 m of width 2 m to the south
    assert low == pytest.approx([30.0 - 4.0, 20.0 - 2.0, 1.0])
    assert high == pytest.approx([30.0, 20.0, 1.0 + 6.0])


def test_faces_and_normals_look_outward(model: ModelFile) -> None:
    (piece,) = pieces(model, KEY, FILE)
    corners = piece.positions_m[piece.triangles]
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    outward = corners.mean(axis=1) - piece.positions_m.mean(axis=0)
    assert (np.einsum("ij,ij->i", across, outward) > 0.0).all()
    assert (np.einsum("ij,ij->i", piece.normals[piece.triangles[:, 0]], outward) > 0.0).all()


def test_colours_are_kept(model: ModelFile) -> None:
    (piece,) = pieces(model, KEY, FILE)
    assert (piece.colours == [200, 40, 30]).all()


def test_a_model_says_how_high_and_wide_it_is(model: ModelFile) -> None:
    measured = measure(model, "tale", KEY, FILE)
    assert measured.figures["base_z_m"].value == pytest.approx(1.0)
    assert measured.figures["height_m"].value == pytest.approx(6.0)
    corners = {(round(e, 3), round(n, 3)) for e, n in measured.footprint.corners_en_m}
    assert corners == {(26.0, 18.0), (30.0, 18.0), (30.0, 20.0), (26.0, 20.0)}
    assert measured.footprint.corners_en_m[0] == pytest.approx((26.0, 18.0))


def test_a_site_with_a_model_is_built_with_it(folder: Path) -> None:
    site = load_site(folder)
    assert site.monument("kiosk").height_m == pytest.approx(6.0)
    for build in (build_roman, build_today):
        (node,) = (n for n in build(site, lambda share: None).nodes if n.name == "kiosk")
        (mesh,) = node.meshes
        assert mesh.positions_m.max(axis=0) == pytest.approx([30.0, 20.0, 7.0])
        assert (node.extras["evidence"], node.extras["source"]) == ("hypothetical", "tale")


def test_only_a_monument_of_its_kind_brings_a_model(folder: Path) -> None:
    with pytest.raises(SiteError, match=r"'temple' is of kind 'temple', which brings no file"):
        brought_node(load_site(folder).monument("temple"))


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        (
            'file = "kiosk.glb"',
            'file = "none.glb"',
            r"'kiosk\.model\.file' names none\.glb, which cannot be read \(No such",
        ),
        ("scale = 2.0", "scale = 0", r"'kiosk\.model\.scale' is 0, but must be more than 0"),
        ("e_m = 30.0\n", "", r"has no 'kiosk\.model\.e_m'"),
        ("e_m = 30.0\nn_m = 20.0", "e_m = 3.0\nn_m = 3.0", r"'kiosk\.footprint' overlaps that of 'field'"),
        ("[kiosk.model]", "[kiosk.modell]", r"has no 'kiosk\.model'"),
    ],
)
def test_a_wrong_georeference_is_refused(folder: Path, old: str, new: str, says: str) -> None:
    file = folder / "monuments.toml"
    text = file.read_text(encoding="utf-8")
    head, _, tail = text.rpartition(old)
    file.write_text(head + new + tail, encoding="utf-8")
    with pytest.raises(SiteError, match=says):
        load_site(folder)


@pytest.mark.parametrize(
    ("content", "says"),
    [
        (b"solid kiosk", "is no GLB"),
        (b"", "is no GLB"),
        (b"glTF\x02\0\0\0\x14\0\0\0", "is a broken GLB"),
        (b"glTF" + bytes(range(256)), "is a broken GLB"),
    ],
)
def test_a_broken_glb_is_refused(folder: Path, content: bytes, says: str) -> None:
    (folder / "kiosk.glb").write_bytes(content)
    with pytest.raises(SiteError, match=rf"monuments\.toml: 'kiosk\.model\.file' names kiosk\.glb, which {says}"):
        load_site(folder)


def test_half_a_glb_is_refused(folder: Path) -> None:
    data = (folder / "kiosk.glb").read_bytes()
    (folder / "kiosk.glb").write_bytes(data[: len(data) // 2])
    with pytest.raises(SiteError, match="is a broken GLB"):
        load_site(folder)


def test_a_glb_without_triangles_is_refused(folder: Path) -> None:
    points: Any = trimesh.PointCloud(np.eye(3))  # type: ignore[no-untyped-call]
    write_glb(folder / "kiosk.glb", points)
    with pytest.raises(SiteError, match="holds no triangles"):
        load_site(folder)


def test_a_flat_model_is_no_monument(folder: Path) -> None:
    plate = trimesh.Trimesh([[0, 0, 0], [1, 0, 0], [0, 0, 1]], [[0, 1, 2]])
    write_glb(folder / "kiosk.glb", plate)
    with pytest.raises(SiteError, match="is flat; a monument needs ground and height"):
        load_site(folder)
