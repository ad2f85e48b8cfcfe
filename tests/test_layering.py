"""Who may import whom: `server` both others, which do not know each other; the tracker's core only numpy and Python."""

import ast
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
PACKAGES = ("tracker", "assets", "server")
MAY_IMPORT = {"tracker": {"tracker"}, "assets": {"assets"}, "server": {"tracker", "assets", "server"}}

ALLOWED_LIBRARIES = {
    "tracker/vision.py": {"cv2"},
    "tracker/klt.py": {"cv2"},
    "tracker/pictures.py": {"cv2"},
    "tracker/video.py": {"av"},
    "tracker/container.py": {"mcap"},
    "tracker/log_writer.py": {"mcap"},
    "tracker/salvage.py": {"lz4", "mcap", "zstandard"},
    "tracker/ros_messages.py": {"rosbags"},
    "tracker/calibrate/board.py": {"cv2"},
    "tracker/calibrate/camera_lens.py": {"cv2"},
    "tracker/geomagnetism.py": {"pygeomag"},
    "tracker/sources/camera.py": {"cv2"},
    "tracker/sources/nmea_sentence.py": {"pynmeagps"},
    "tracker/sources/serial_devices.py": {"serial"},
    "tracker/sources/serial_port.py": {"serial"},
    "tracker/sources/camera_file.py": {"cv2"},
    "tracker/sources/camera_mode.py": {"cv2"},
    "tracker/sources/phidget.py": {"Phidget22"},
    "tracker/sources/phidget_devices.py": {"Phidget22"},
    "tracker/sources/phidget_gps.py": {"Phidget22"},
    "tracker/sources/phidget_spatial.py": {"Phidget22"},
    "tracker/sources/phidget_library.py": {"libusb_package"},
}
"""What a file of the tracker may import besides numpy, Python and the tracker itself: files at its border, and no others."""

SOURCES = sorted(path for name in PACKAGES for path in (ROOT / name).rglob("*.py"))


def imported(source: str) -> Iterator[str]:
    """Yield the dotted name of every module that `source` imports, wherever in the file it does so."""
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            yield "." * node.level + (node.module or "")


def violations(name: str, source: str) -> list[str]:
    """Return what file `name` (relative to the root, with slashes) imports against the rules."""
    package = name.partition("/")[0]
    modules = {module.partition(".")[0] for module in imported(source)}
    wrong = {module for module in modules & set(PACKAGES) if module not in MAY_IMPORT[package]} | (
        modules & {"", "tests"}
    )
    if package == "tracker":
        wrong |= modules - set(sys.stdlib_module_names) - {*PACKAGES, "numpy"} - ALLOWED_LIBRARIES.get(name, set())
    return sorted(wrong)


@pytest.mark.parametrize("path", SOURCES, ids=lambda path: path.relative_to(ROOT).as_posix())
def test_a_file_imports_only_what_lies_below_it(path: Path) -> None:
    wrong = violations(path.relative_to(ROOT).as_posix(), path.read_text(encoding="utf-8"))
    assert not wrong, f"{path.relative_to(ROOT)} must not import {', '.join(wrong)}"


@pytest.mark.parametrize(
    ("name", "source", "wrong"),
    [
        ("tracker/fusion.py", "import numpy as np\nimport math\nfrom tracker.rig import Rig", []),
        ("tracker/fusion.py", "import cv2", ["cv2"]),
        ("tracker/fusion.py", "def late():\n    from assets.site import Site", ["assets"]),
        ("tracker/fusion.py", "from . import rig", [""]),
        ("tracker/vision.py", "import cv2", []),
        ("assets/site.py", "import trimesh\nfrom tracker.rig import Rig", ["tracker"]),
        ("assets/site.py", "import server.cli", ["server"]),
        ("server/cli.py", "import assets.site\nimport tracker.log\nimport typer", []),
        ("server/cli.py", "from tests.conftest import browser", ["tests"]),
    ],
)
def test_the_rules_tell_right_from_wrong(name: str, source: str, wrong: list[str]) -> None:
    assert violations(name, source) == wrong
