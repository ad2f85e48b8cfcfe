"""The guide for heritage offices: its examples are read as they are printed."""

import re
from pathlib import Path

import pytest
import trimesh

from assets.site import KINDS, load_site

GUIDE = (Path(__file__).parents[2] / "docs" / "new-site.md").read_text(encoding="utf-8")
EXAMPLES: dict[str, str] = dict(re.findall(r"^```toml\n# (\S+)\n(.*?)^```", GUIDE, re.MULTILINE | re.DOTALL))


def write(folder: Path, monuments: str) -> Path:
    (folder / "site.toml").write_text(EXAMPLES["site.toml"], encoding="utf-8")
    (folder / "monuments.toml").write_text(monuments, encoding="utf-8")
    return folder


def test_the_two_files_are_a_site(tmp_path: Path) -> None:
    site = load_site(write(tmp_path, EXAMPLES["monuments.toml"]))
    assert [m.id for m in site.monuments] == ["temple"]
    assert site.tour[0].monument == "temple"


def test_rivals_are_added_as_printed(tmp_path: Path) -> None:
    head, _, rivals = EXAMPLES["variants"].partition("\n\n")
    default = head.removeprefix("[temple]\n")
    first, _, rest = EXAMPLES["monuments.toml"].partition("\n\n")
    temple = load_site(write(tmp_path, f"{first}\n{default}\n\n{rest}\n{rivals}")).monument("temple")
    assert {v.id for v in temple.variants} == {"standing", "absent"}
    assert [a.id for a in temple.attributions] == ["athena"]


def test_a_model_is_added_as_printed(tmp_path: Path) -> None:
    box = trimesh.Scene(trimesh.creation.box((8.0, 4.0, 3.0)))
    box.export(tmp_path / "stoa.glb")  # type: ignore[no-untyped-call]
    site = load_site(write(tmp_path, f"{EXAMPLES['monuments.toml']}\n{EXAMPLES['model']}"))
    assert site.monument("stoa").height_m == pytest.approx(4.0)


@pytest.mark.parametrize("kind", KINDS)
def test_every_kind_is_named(kind: str) -> None:
    assert re.search(rf"\b{kind}\b", GUIDE)
