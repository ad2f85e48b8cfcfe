"""`agora walk` from USB to the browser: the real Phidget22 library, devices that are not there, a file as the camera, Chromium."""

import shutil
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from datetime import date
from pathlib import Path

import cv2
import numpy as np
import pytest
from playwright.sync_api import Browser

from assets.site import load_site
from server.options import SITE, require_built
from tests.web.pages import ArPage, open_page
from tracker.rig_file import RigFile, write_rig_file
from tracker.rig_sheets import CameraSheet
from tracker.simulate import default_rig

pytestmark = pytest.mark.browser

ROOT = Path(__file__).parents[2]
RATE_HZ, PICTURES = 10, 80


def write_video(path: Path) -> None:
    """Write eight seconds of a patterned wall that slides by."""
    blocks = np.random.default_rng(0).integers(0, 255, (60, 160, 3), np.uint8)
    wall = np.kron(blocks, np.ones((8, 8, 1), np.uint8))
    video = cv2.VideoWriter(str(path), cv2.VideoWriter.fourcc(*"MJPG"), RATE_HZ, (640, 480))
    for index in range(PICTURES):
        video.write(np.ascontiguousarray(wall[:, index * 4 : index * 4 + 640]))
    video.release()


def write_rig(path: Path) -> None:
    """Write a rig whose camera was calibrated."""
    camera = default_rig().camera
    assert camera is not None
    found = {
        "date": date(2026, 11, 28),
        "method": "board",
        "rms_px": 0.3,
        "focal_sigma_px": 1.0,
        "views": 20,
        "coverage": 0.8,
    }
    write_rig_file(path, RigFile(camera=CameraSheet.of(camera, **found)))


@dataclass(frozen=True)
class Rig:
    """A rig that walks."""

    url: str
    control: Path

    def do(self, what: str) -> None:
        """Pull out a device, or put it back."""
        with self.control.open("a", encoding="utf-8") as file:
            file.write(what + "\n")


@contextmanager
def walking(folder: Path) -> Iterator[Rig]:
    """Run `agora walk` with both Phidgets, a file as the camera, and a recording."""
    write_video(folder / "wall.avi")
    write_rig(folder / "rig.toml")
    stand_in = [
        sys.executable,
        "-m",
        "tests.tracker.sources.usb_standin.run",
        "simulate:3:300",
        "--control",
        str(folder / "usb"),
    ]
    walk = ["agora", "walk", "--camera", str(folder / "wall.avi"), "--rig", str(folder / "rig.toml")]
    command = [*stand_in, "--", *walk, "--record", str(folder), "--no-browser", "--port", "0"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True, cwd=ROOT) as process:
        assert process.stdout is not None
        try:
            line = process.stdout.readline()
            assert line.startswith("Agora is at http://127.0.0.1:"), line
            yield Rig(line.split()[-1], folder / "usb")
        finally:
            process.terminate()
            assert process.wait(30.0) == 0


def notice(ar: ArPage) -> str:
    """Return the sentence in the middle of the page."""
    return ar.page.inner_text("#notice") if ar.page.is_visible("#notice") else ""


def test_a_walk_reaches_the_page_and_a_sensor_that_is_pulled_out_is_said_both_times(
    browser: Browser, tmp_path: Path
) -> None:
    """Pictures are drawn, each with its own pose; a plug pulled out is said with its remedy, and that it is back."""
    if shutil.which("gcc") is None:
        pytest.skip("no gcc")
    require_built(load_site(SITE))
    with walking(tmp_path) as rig, open_page(browser) as ar:
        ar.page.goto(f"{rig.url}ar")
        ar.until("globalThis.agora && agora.stats()?.framesDrawn > 10 && agora.pose() !== null")
        ar.until("agora.session().kind === 'live' && !agora.session().health.gps.trouble")
        stats = ar.stats()
        assert stats["estimator"] == "camera-gps-imu/precise"
        assert stats["mismatchedFrames"] == 0

        for sensor, name in (("gps", "The GPS receiver"), ("imu", "The inertial unit")):
            rig.do(f"unplug {sensor}")
            ar.until(f"document.querySelector('#notice').textContent.startsWith('{name} is not there')")
            assert "put it back" in notice(ar)
            drawn = ar.stats()["framesDrawn"]
            ar.until(f"agora.stats().framesDrawn > {drawn + 3}")
            rig.do(f"plug {sensor}")
            ar.until(f"document.querySelector('#toast').textContent === '{name} is back.'")
            ar.until(f"!document.querySelector('#notice').textContent.startsWith('{name}')")
        drawn = ar.stats()["posesDrawn"]
        ar.until(f"agora.stats().posesDrawn > {drawn + 3}")
        assert ar.stats()["mismatchedFrames"] == 0
        assert ar.errors == []
    (recording,) = tmp_path.glob("walk-*.mcap")
    assert recording.stat().st_size > 100_000
