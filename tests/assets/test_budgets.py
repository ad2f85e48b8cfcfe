"""The State Agora as it is delivered: within its budgets, and in order for the Khronos validator."""

import json
import subprocess
from collections import Counter
from pathlib import Path

import pytest

from assets.budgets import BuildReport
from assets.build import build
from assets.packing import ROOT, node_program
from assets.site import Site

ALLOWED_WARNINGS = {"VALUE_NOT_IN_LIST", "IMAGE_UNRECOGNIZED_FORMAT"}
"""What the validator says of any KTX2 image."""


@pytest.fixture(scope="module")
def report(site: Site) -> BuildReport:
    """What `make setup` has built, or a build of it now."""
    return build(site, site.folder / "built", lambda share: None)


def test_the_first_paint_is_small(report: BuildReport) -> None:
    assert 0 < report.first_paint_bytes <= 3_000_000


def test_everything_together_is_small(report: BuildReport) -> None:
    assert report.first_paint_bytes < report.total_bytes <= 20_000_000


def test_no_view_of_the_tour_costs_too_much(report: BuildReport) -> None:
    assert 10 < report.draw_calls <= 120
    assert 50_000 < report.triangles <= 250_000


def test_textures_fit_on_the_graphics_card_of_a_phone(report: BuildReport) -> None:
    assert 0 < report.gpu_bytes <= 96_000_000


def test_each_coarser_level_is_smaller(report: BuildReport) -> None:
    sizes = {(file.model, file.level): file.bytes for file in report.files}
    for model in ("roman", "today"):
        assert sizes[model, 0] > sizes[model, 1] > sizes[model, 2] - 800_000  # the first paint has textures of its own


def test_the_validator_finds_no_fault(site: Site, report: BuildReport) -> None:
    files = [site.folder / file.path for file in report.files]
    found = validated(files)
    assert sorted(found) == sorted(map(str, files))
    for name, issues in found.items():
        faults = Counter(
            (issue["severity"], issue["code"])
            for issue in issues
            if issue["severity"] in ("error", "warning") and issue["code"] not in ALLOWED_WARNINGS
        )
        assert not faults, (Path(name).name, faults)


def test_the_validator_would_find_a_fault(site: Site, report: BuildReport, tmp_path: Path) -> None:
    data = (site.folder / report.files[0].path).read_bytes()
    path = tmp_path / "broken.glb"
    path.write_bytes(data.replace(b'"SCALAR"', b'"SCALRA"', 1))
    assert any(issue["severity"] == "error" for issue in validated([path])[str(path)])


def validated(files: list[Path]) -> dict[str, list[dict[str, str]]]:
    """Return what the Khronos validator says of each file."""
    program = ROOT / "web" / "tools" / "validate.mjs"
    done = subprocess.run([node_program(), str(program), *map(str, files)], capture_output=True, check=True, text=True)
    found: dict[str, list[dict[str, str]]] = json.loads(done.stdout)
    return found
