"""`agora build`: the same facts give the same bytes, nothing is built twice, and the report adds up."""

import json
import shutil
from collections.abc import Iterator
from dataclasses import replace
from hashlib import sha256
from pathlib import Path

import pytest

from assets import build as build_module
from assets import packing
from assets.budgets import BuildReport
from assets.build import build
from assets.errors import AssetError, PackerMissing, SiteError
from assets.site import Site, load_site

SECOND = Path(__file__).parents[1] / "second_site"
NAMES = [f"{model}.{level}.glb" for model in ("roman", "today") for level in (0, 1, 2)]
PROXIES = ["materials.glb", "occluders.glb", "walkable.glb"]


def copied(folder: Path) -> Site:
    """Return the tiny site in a folder of its own."""
    shutil.copytree(SECOND, folder, ignore=shutil.ignore_patterns("built"))
    return load_site(folder)


@pytest.fixture(scope="module")
def built(tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[Site, BuildReport, list[float]]]:
    tiny = copied(tmp_path_factory.mktemp("site") / "tiny")
    shares: list[float] = []
    yield tiny, build(tiny, tiny.folder / "built", shares.append), shares
    shutil.rmtree(tiny.folder)


def test_the_same_facts_give_the_same_bytes(built: tuple[Site, BuildReport, list[float]], tmp_path: Path) -> None:
    again = build(built[0], tmp_path, lambda share: None)
    assert [file.sha256 for file in again.files] == [file.sha256 for file in built[1].files]
    assert (again.draw_calls, again.triangles) == (built[1].draw_calls, built[1].triangles)


def test_the_report_is_of_what_was_written(built: tuple[Site, BuildReport, list[float]]) -> None:
    site, report, _ = built
    facts = json.loads(json.dumps(report.as_dict()))
    assert [file["path"] for file in facts["files"]] == [f"built/{name}" for name in NAMES + PROXIES]
    assert [(f["model"], f["level"]) for f in facts["files"][:4]] == [
        ("roman", 0),
        ("roman", 1),
        ("roman", 2),
        ("today", 0),
    ]
    for file in facts["files"]:
        data = (site.folder / file["path"]).read_bytes()
        assert (file["bytes"], file["sha256"]) == (len(data), sha256(data).hexdigest())
    assert facts["total_bytes"] == sum(file["bytes"] for file in facts["files"])
    assert facts["first_paint_bytes"] == facts["files"][2]["bytes"]
    assert BuildReport.from_dict(facts) == report
    assert set(facts) == {"files", "first_paint_bytes", "total_bytes", "draw_calls", "triangles", "gpu_bytes"}


def test_progress_rises_to_one(built: tuple[Site, BuildReport, list[float]]) -> None:
    shares = built[2]
    assert shares == sorted(shares)
    assert shares[-1] == 1.0
    assert len(shares) > 10


def test_only_whole_files_are_left(built: tuple[Site, BuildReport, list[float]]) -> None:
    assert sorted(path.name for path in (built[0].folder / "built").iterdir()) == sorted(
        [*NAMES, *PROXIES, "report.json"]
    )


def test_what_is_built_is_not_built_again(
    built: tuple[Site, BuildReport, list[float]], monkeypatch: pytest.MonkeyPatch
) -> None:
    site, report, _ = built
    monkeypatch.setattr(build_module, "MODELS", {})
    assert build(site, site.folder / "built", lambda share: None) == report


@pytest.mark.parametrize("damage", ["facts", "file", "memory"])
def test_what_has_changed_is_built_again(
    built: tuple[Site, BuildReport, list[float]], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, damage: str
) -> None:
    folder = tmp_path / "tiny"
    shutil.copytree(built[0].folder, folder)
    site = load_site(folder)
    path = {"facts": "site.toml", "file": "built/roman.2.glb", "memory": "built/report.json"}[damage]
    (folder / path).write_bytes((folder / path).read_bytes()[: -1 if damage != "facts" else None] + b" ")

    def started(*_: object, **__: object) -> None:
        raise AssetError("building")

    monkeypatch.setattr(build_module, "MODELS", {"roman": started})
    with pytest.raises(AssetError, match="building"):
        build(site, folder / "built", lambda share: None)


def test_a_folder_that_cannot_be_made_is_named(built: tuple[Site, BuildReport, list[float]], tmp_path: Path) -> None:
    (tmp_path / "file").write_text("", encoding="utf-8")
    with pytest.raises(AssetError, match=r"file cannot be made .*: name another folder"):
        build(built[0], tmp_path / "file", lambda share: None)


def test_a_file_that_cannot_be_written_is_named_and_leaves_no_half(tmp_path: Path) -> None:
    (tmp_path / "roman.0.glb" / "inside").mkdir(parents=True)
    with pytest.raises(AssetError, match=r"roman\.0\.glb cannot be written"):
        build_module._write(tmp_path / "roman.0.glb", b"new")
    assert [path.name for path in tmp_path.iterdir()] == ["roman.0.glb"]


def test_a_model_that_fails_leaves_the_old_file(built: tuple[Site, BuildReport, list[float]], tmp_path: Path) -> None:
    (tmp_path / "roman.0.glb").write_bytes(b"old")
    odd = replace(built[0].monuments[0], kind="ziggurat")
    with pytest.raises(SiteError):
        build(replace(built[0], monuments=(odd,)), tmp_path, lambda share: None)
    assert (tmp_path / "roman.0.glb").read_bytes() == b"old"


def test_without_node_the_remedy_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(packing, "OWN_NODE", tmp_path / "none")
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(PackerMissing, match="run `make setup`"):
        packing.pack({}, lambda share: None)


def test_a_file_that_cannot_be_packed_is_an_error_in_one_sentence(tmp_path: Path) -> None:
    (tmp_path / "a.glb").write_bytes(b"glTF and nothing else")
    with pytest.raises(AssetError, match="a model could not be packed") as error:
        packing.pack({tmp_path / "a.glb": tmp_path / "b.glb"}, lambda share: None)
    assert "\n" not in str(error.value)
