"""Simulated walks with a camera: what the log holds, the same bytes twice, and that an interruption costs nothing."""

from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
import pytest

from assets.materials import MATERIALS
from assets.render import Renderer
from assets.scene import Node, Scene
from assets.shape import Place, Shape
from server.simulation import write_walk
from tests.ci.machine import has_open_gl, is_root
from tracker.itinerary import Itinerary, Leg, Look
from tracker.log import Log
from tracker.measurements import Frame, Image, Matrix, Measurement
from tracker.simulate import Walk, WalkSettings, default_rig, flat_ground

SETTINGS = WalkSettings(seed=3, duration_s=1.0, camera_hz=10.0)
RED_BGR = (0, 0, 255)


class Interrupted(Exception):
    """Somebody pressed ctrl-C."""


@pytest.fixture(scope="module")
def scene() -> Scene:
    """A paved floor."""
    if not has_open_gl() and not is_root():
        pytest.skip("not root")
    floor = Shape()
    floor.box("paving", (-60.0, -60.0, -1.0), (60.0, 60.0, 0.0))
    return Scene([Node("floor", floor.meshes(Place.at(0.0, 0.0, 0.0)))], {"paving": MATERIALS["paving"].paint()})


def write(path: Path, scene: Scene, stop_after: float = 2.0) -> None:
    """Write a walk; give up when this share of it is done."""

    def progress(done: float) -> None:
        if done >= stop_after:
            raise Interrupted

    write_walk(path, SETTINGS, ground_z_m=flat_ground, scene=scene, video="h264", progress=progress)


def frames_of(measurements: list[Measurement]) -> list[Frame]:
    return [measurement for measurement in measurements if isinstance(measurement, Frame)]


def test_the_log_holds_the_pictures_between_the_other_measurements(scene: Scene, tmp_path: Path) -> None:
    path = tmp_path / "walk.mcap"
    write(path, scene)
    log = Log.open(path)
    frames = frames_of(list(log.messages()))
    assert [frame.frame_id for frame in frames] == list(range(10))
    assert log.rig.camera == default_rig().camera
    assert (log.info.camera_encoding, log.info.counts["imu"], log.info.truncated) == ("h264", 250, False)
    assert all(frame.picture.gray().std() > 5.0 for frame in frames)
    assert not log.skipped
    assert [found.name for found in tmp_path.iterdir()] == ["walk.mcap"]


def test_the_same_walk_is_the_same_bytes(scene: Scene, tmp_path: Path) -> None:
    for name in ("a.mcap", "b.mcap"):
        write(tmp_path / name, scene)
    assert (tmp_path / "a.mcap").read_bytes() == (tmp_path / "b.mcap").read_bytes()


def test_an_interrupted_walk_goes_on_with_the_pictures_it_has(scene: Scene, tmp_path: Path) -> None:
    path = tmp_path / "walk.mcap"
    with pytest.raises(Interrupted):
        write(path, scene, stop_after=0.5)
    assert not path.exists()
    kept = sorted(tmp_path.rglob("*.png"))
    assert len(kept) == 5
    # a picture that nobody would render shows that it is not rendered again
    cv2.imwrite(str(kept[2]), np.full((480, 640, 3), RED_BGR, np.uint8))
    write(path, scene)
    frames = frames_of(list(Log.open(path).messages()))
    assert len(frames) == 10
    assert not list(tmp_path.rglob("*.png"))
    assert [frame.picture.gray().mean() < 90.0 for frame in frames] == [i == 2 for i in range(10)]


def test_an_interrupted_walk_ends_as_the_same_bytes(scene: Scene, tmp_path: Path) -> None:
    """The exposure goes on from the pictures that are kept."""
    write(tmp_path / "whole.mcap", scene)
    with pytest.raises(Interrupted):
        write(tmp_path / "broken.mcap", scene, stop_after=0.5)
    write(tmp_path / "broken.mcap", scene)
    assert (tmp_path / "broken.mcap").read_bytes() == (tmp_path / "whole.mcap").read_bytes()


def test_another_world_does_not_go_on_with_kept_pictures(scene: Scene, tmp_path: Path) -> None:
    with pytest.raises(Interrupted):
        write(tmp_path / "walk.mcap", scene, stop_after=0.5)
    darker = {"paving": scene.textures["paving"] // 2}
    write(tmp_path / "walk.mcap", replace(scene, textures=darker))
    write(tmp_path / "other.mcap", replace(scene, textures=darker))
    assert (tmp_path / "walk.mcap").read_bytes() == (tmp_path / "other.mcap").read_bytes()


# -- the camera -------------------------------------------------------------------------------------------------------

TURN_ROUND = Itinerary((0.0, 0.0), (9.0, 0.0, 1.65), (Leg((0.1, 0.0), 1.0, (), (Look((-9.0, 1.0, 1.65), 3.0),)),))


def test_a_moving_camera_is_drawn_more_often_and_always_about_the_stamp(
    scene: Scene, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Half a turn: once a picture at rest, up to the blur's length in the turn, the mean direction that of the stamp."""
    settings = WalkSettings(duration_s=5.0, still_s=1.0, camera_hz=10.0, itinerary=TURN_ROUND)
    taken: list[list[Matrix]] = [[]]

    def render(_: Renderer, T_site_cam: Matrix, *lens: object, brightness: float, fine: bool) -> Image:
        taken[-1].append(T_site_cam)
        return np.full((480, 640, 3), 150, np.uint8)

    monkeypatch.setattr(Renderer, "render", render)
    write_walk(
        tmp_path / "turn.mcap",
        settings,
        ground_z_m=flat_ground,
        scene=scene,
        video="jpeg",
        progress=lambda _: taken.append([]),
    )
    walk = Walk(settings, default_rig())
    pictures = taken[:50]
    counts = [len(poses) for poses in pictures]
    assert counts[0] == 1
    assert counts[-1] == 0  # the picture before is this one
    assert sum(counts) <= 2.5 * len(counts)
    assert max(counts) >= 3
    for (t_ns, _), poses in zip(walk.frame_times(), pictures, strict=True):
        if not poses:
            continue
        middle = np.mean([pose[:3, 2] for pose in poses], axis=0)
        np.testing.assert_allclose(middle, walk.T_site_cam(t_ns)[:3, 2], atol=2e-4)
