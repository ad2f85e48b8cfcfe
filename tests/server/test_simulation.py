"""Simulated walks with a camera: what the log holds, the same bytes twice, and that an interruption costs nothing."""

from pathlib import Path

import cv2
import numpy as np
import pytest

from assets.gltf import Node, Scene, write_glb
from assets.materials import MATERIALS
from assets.shape import Place, Shape
from server.simulation import write_walk
from tests.ci.machine import has_open_gl, is_root
from tracker.log import Log
from tracker.measurements import Frame, Measurement
from tracker.simulate import WalkSettings, default_rig, flat_ground

SETTINGS = WalkSettings(seed=3, duration_s=1.0, camera_hz=10.0)
RED_BGR = (0, 0, 255)


class Interrupted(Exception):
    """Somebody pressed ctrl-C."""


@pytest.fixture(scope="module")
def model(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A paved floor, as a GLB."""
    if not has_open_gl() and not is_root():
        pytest.skip("not root")
    floor = Shape()
    floor.box("paving", (-60.0, -60.0, -1.0), (60.0, 60.0, 0.0))
    path = tmp_path_factory.mktemp("model") / "floor.glb"
    scene = Scene([Node("floor", floor.meshes(Place.at(0.0, 0.0, 0.0)))], {"paving": MATERIALS["paving"].paint()})
    path.write_bytes(write_glb(scene, {}))
    return path


def write(path: Path, model: Path, stop_after: float = 2.0) -> None:
    """Write a walk; give up when this share of it is done."""

    def progress(done: float) -> None:
        if done >= stop_after:
            raise Interrupted

    write_walk(path, SETTINGS, ground_z_m=flat_ground, model=model, video="h264", progress=progress)


def frames_of(measurements: list[Measurement]) -> list[Frame]:
    return [measurement for measurement in measurements if isinstance(measurement, Frame)]


def test_the_log_holds_the_pictures_between_the_other_measurements(model: Path, tmp_path: Path) -> None:
    path = tmp_path / "walk.mcap"
    write(path, model)
    log = Log.open(path)
    frames = frames_of(list(log.messages()))
    assert [frame.frame_id for frame in frames] == list(range(10))
    assert log.rig.camera == default_rig().camera
    assert (log.info.camera_encoding, log.info.counts["imu"], log.info.truncated) == ("h264", 250, False)
    assert all(frame.picture.gray().std() > 5.0 for frame in frames)
    assert not log.skipped
    assert [found.name for found in tmp_path.iterdir()] == ["walk.mcap"]


def test_the_same_walk_is_the_same_bytes(model: Path, tmp_path: Path) -> None:
    for name in ("a.mcap", "b.mcap"):
        write(tmp_path / name, model)
    assert (tmp_path / "a.mcap").read_bytes() == (tmp_path / "b.mcap").read_bytes()


def test_an_interrupted_walk_goes_on_with_the_pictures_it_has(model: Path, tmp_path: Path) -> None:
    path = tmp_path / "walk.mcap"
    with pytest.raises(Interrupted):
        write(path, model, stop_after=0.5)
    assert not path.exists()
    kept = sorted(tmp_path.rglob("*.png"))
    assert len(kept) == 5
    # a picture that nobody would render shows that it is not rendered again
    cv2.imwrite(str(kept[2]), np.full((480, 640, 3), RED_BGR, np.uint8))
    write(path, model)
    frames = frames_of(list(Log.open(path).messages()))
    assert len(frames) == 10
    assert not list(tmp_path.rglob("*.png"))
    assert [frame.picture.gray().std() < 4.0 for frame in frames] == [i == 2 for i in range(10)]
