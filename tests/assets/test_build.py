"""`agora build`: the same facts give the same bytes, and the report adds up."""

import shutil
from collections.abc import Iterator
from dataclasses import replace
from hashlib import sha256
from pathlib import Path

import pytest

from assets import build as build_module
from assets.build import BuildReport, build
from assets.errors import AssetError, SiteError
from assets.gltf import read_glb
from assets.site import Site, load_site


@pytest.fixture(scope="module")
def built(site: Site, tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[Path, BuildReport, list[float]]]:
    folder = tmp_path_factory.mktemp("site")
    for name in ("site.toml", "monuments.toml"):
        shutil.copy(site.folder / name, folder / name)
    shares: list[float] = []
    report = build(load_site(folder), folder / "built", shares.append)
    yield folder, report, shares
    shutil.rmtree(folder)


def test_the_same_facts_give_the_same_bytes(
    site: Site, built: tuple[Path, BuildReport, list[float]], tmp_path: Path
) -> None:
    again = build(site, tmp_path, lambda share: None)
    assert [file.sha256 for file in again.files] == [file.sha256 for file in built[1].files]
    shutil.rmtree(tmp_path)


def test_the_report_is_of_what_was_written(built: tuple[Path, BuildReport, list[float]]) -> None:
    folder, report, _ = built
    facts = report.as_dict()
    assert [(file["path"], file["model"], file["level"]) for file in facts["files"]] == [
        ("built/roman.glb", "roman", 0),
        ("built/today.glb", "today", 0),
    ]
    for file in facts["files"]:
        data = (folder / file["path"]).read_bytes()
        assert (file["bytes"], file["sha256"]) == (len(data), sha256(data).hexdigest())
    assert facts["total_bytes"] == sum(file["bytes"] for file in facts["files"])
    assert facts["first_paint_bytes"] == facts["files"][0]["bytes"] <= 6_000_000


def test_counts_are_those_of_the_ancient_model(built: tuple[Path, BuildReport, list[float]]) -> None:
    folder, report, _ = built
    scene = read_glb(folder / "built/roman.glb")
    assert report.triangles == sum(len(mesh.triangles) for node in scene.nodes for mesh in node.meshes)
    assert report.draw_calls == sum(len(node.meshes) for node in scene.nodes)
    pixels = sum(texture.shape[0] * texture.shape[1] for texture in scene.textures.values())
    assert report.gpu_bytes > 4 * pixels + 36 * sum(len(m.positions_m) for n in scene.nodes for m in n.meshes)


def test_progress_rises_to_one(built: tuple[Path, BuildReport, list[float]]) -> None:
    shares = built[2]
    assert shares == sorted(shares)
    assert shares[-1] == 1.0
    assert len(shares) > 10


def test_only_whole_files_are_left(built: tuple[Path, BuildReport, list[float]]) -> None:
    assert sorted(path.name for path in (built[0] / "built").iterdir()) == ["roman.glb", "today.glb"]


def test_a_folder_that_cannot_be_made_is_named(site: Site, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(build_module, "MODELS", {"roman": build_module.MODELS["roman"]})
    (tmp_path / "file").write_text("", encoding="utf-8")
    with pytest.raises(AssetError, match=r"roman\.glb cannot be written"):
        build(replace(site, monuments=()), tmp_path / "file", lambda share: None)


def test_a_model_that_fails_leaves_the_old_file(site: Site, tmp_path: Path) -> None:
    (tmp_path / "roman.glb").write_bytes(b"old")
    odd = replace(site.monument("pollio"), kind="ziggurat")
    with pytest.raises(SiteError):
        build(replace(site, monuments=(odd,)), tmp_path, lambda share: None)
    assert (tmp_path / "roman.glb").read_bytes() == b"old"
