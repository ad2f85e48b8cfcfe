"""The real Phidget22 library on a USB bus that is not there: the scenes of `phidget_scenes.py`, in a process of their own.

The stand-in must be loaded before the library's first call and stays in its process, so it must not be this one.
"""

import os
import shutil
import subprocess
import sys
from pathlib import Path
from xml.etree import ElementTree

import pytest

from tests.tracker.sources import phidget_scenes
from tests.tracker.sources.usb_standin.bus import build

ROOT = Path(__file__).parents[3]
SCENES = [name for name in vars(phidget_scenes) if name.startswith("test_")]


@pytest.fixture(scope="module")
def played(tmp_path_factory: pytest.TempPathFactory) -> dict[str, list[str]]:
    """What went wrong in each scene, after all were played."""
    if shutil.which("gcc") is None:
        pytest.skip("no gcc")
    folder = tmp_path_factory.mktemp("usb")
    command = [sys.executable, "-X", "faulthandler", "-m", "pytest", "--noconftest", "-p", "no:cacheprovider"]
    done = subprocess.run(
        [*command, f"--junit-xml={folder / 'played.xml'}", phidget_scenes.__file__],
        env=os.environ | {"USB_STANDIN": str(build(folder))},
        cwd=ROOT,
        capture_output=True,
        text=True,
        timeout=280,
        check=False,
    )
    assert done.returncode in (0, 1), done.stdout + done.stderr
    found: dict[str, list[str]] = {name: [] for name in SCENES}
    for case in ElementTree.parse(folder / "played.xml").iter("testcase"):
        found[case.attrib["name"].partition("[")[0]] += [str(wrong.text) for wrong in case]
    return found


@pytest.mark.slow
@pytest.mark.parametrize("scene", SCENES)
def test_scene(scene: str, played: dict[str, list[str]]) -> None:
    assert not played[scene], "\n".join(played[scene])


def test_there_are_scenes() -> None:
    assert len(SCENES) > 15
