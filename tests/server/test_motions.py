"""Motions of whole walks: made once, and the same when they are read again."""

from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from server.motions import feature_motions, poses_of, rendered_motions
from tracker.feature_camera import Faults
from tracker.log import Log
from tracker.log_writer import LogWriter
from tracker.measurements import Frame, Matrix, VisualMotion
from tracker.pictures import ArrayPicture
from tracker.simulate import START_NS, Walk, WalkSettings, default_rig, simulate
from tracker.vision import VisionSettings

WALK = Walk(WalkSettings(duration_s=4.0, still_s=0.5, dataset=1), default_rig())


@dataclass
class Field:
    """Points all about the site, and how often somebody looked."""

    key: str = "field"
    looked: int = 0
    p_site_m: Matrix = field(default_factory=lambda: np.random.default_rng(3).uniform(-90.0, 90.0, (40_000, 3)))
    strength: Matrix = field(default_factory=lambda: np.linspace(1.0, 0.5, 40_000))
    on_rim: NDArray[np.bool_] = field(default_factory=lambda: np.zeros(40_000, np.bool_))

    def corners(self, p_site_m: Matrix) -> "Field":
        self.looked += 1
        return self


def told(motion: VisualMotion) -> tuple[object, ...]:
    """Everything that a motion says, to be compared."""
    return (
        motion.t_ns,
        motion.t_recv_ns,
        motion.frame_id,
        motion.t_key_ns,
        motion.R_key_cam.tolist(),
        motion.direction_key,
        motion.inliers,
        motion.parallax_px,
        motion.is_keyframe,
    )


def same(a: list[VisualMotion], b: list[VisualMotion]) -> bool:
    return list(map(told, a)) == list(map(told, b))


def test_motions_of_features_are_made_once(tmp_path: Path) -> None:
    world = Field()
    first = feature_motions(WALK, world, folder=tmp_path)
    looked = world.looked
    assert len(first) > 40
    assert looked > 0
    again = feature_motions(WALK, world, folder=tmp_path)
    assert world.looked == looked
    assert same(first, again)
    assert isinstance(again[0].t_ns, int)
    assert type(again[0].is_keyframe) is bool


def test_motions_follow_everything_behind_them(tmp_path: Path) -> None:
    """Another seed, world, fault or keyframe rule: other motions, and none of them read for another."""
    walk = Walk(replace(WALK.settings, seed=2), WALK.rig)
    runs = [
        feature_motions(WALK, Field(), folder=tmp_path),
        feature_motions(walk, Field(), folder=tmp_path),
        feature_motions(WALK, Field(key="other", strength=np.linspace(0.9, 0.2, 40_000)), folder=tmp_path),
        feature_motions(WALK, Field(), Faults(drift_px=0.3), folder=tmp_path),
        feature_motions(WALK, Field(), vision=VisionSettings(key_age_s=0.3), folder=tmp_path),
    ]
    assert len(list(tmp_path.iterdir())) == len(runs)
    assert not any(same(runs[0], other) for other in runs[1:])


def test_poses_are_the_walk_s_own() -> None:
    poses = poses_of(WALK)
    assert list(poses) == [t_ns for t_ns, _ in WALK.frame_times()]
    t_ns = WALK.frame_times()[-1][0]
    np.testing.assert_allclose(poses[t_ns], WALK.T_site_cam(t_ns), atol=1e-12)


@pytest.fixture
def log(tmp_path: Path) -> Log:
    """Half a second of a walk whose pictures shift by a pixel each."""
    path, settings = tmp_path / "walk.mcap", WalkSettings(duration_s=0.5)
    walk = Walk(settings, default_rig())
    noise = np.kron(np.random.default_rng(0).integers(0, 255, (60, 90)), np.ones((9, 9), int)).astype(np.uint8)
    frames = [
        Frame(t_ns, t_recv_ns, i, ArrayPicture(np.repeat(noise[30:510, i : i + 640, None], 3, axis=2)))
        for i, (t_ns, t_recv_ns) in enumerate(walk.frame_times())
    ]
    with LogWriter(path, walk.rig, settings.origin, t_start_ns=START_NS, video="jpeg", rate_hz=12.0) as writer:
        for measurement in sorted([*simulate(walk), *frames], key=lambda m: m.t_recv_ns):
            writer.write(measurement)
    return Log.open(path)


def test_motions_of_pictures_are_made_once(log: Log, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    folder = tmp_path / "tracks"
    first = rendered_motions(log, folder=folder)
    assert [motion.frame_id for motion in first] == list(range(1, 6))
    other = rendered_motions(log, VisionSettings(features=100), folder=folder)
    assert not same(first, other)
    monkeypatch.setattr("tracker.klt.Klt.look", None)  # whoever looked now would fail
    assert same(rendered_motions(log, folder=folder), first)


def test_a_walk_without_a_camera_has_no_motions(log: Log, tmp_path: Path) -> None:
    blind = Walk(WALK.settings, replace(WALK.rig, camera=None))
    with pytest.raises(ValueError, match="camera"):
        feature_motions(blind, Field(), folder=tmp_path)
    log.rig = replace(log.rig, camera=None)
    with pytest.raises(ValueError, match="walk has no camera"):
        rendered_motions(log, folder=tmp_path)
