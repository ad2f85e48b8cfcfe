"""What a live front end made of pictures, in a log and out of it again, to the last bit."""

from pathlib import Path

import numpy as np
import pytest

from tracker import ros_messages as ros
from tracker.log import Log
from tracker.log_writer import LogWriter
from tracker.measurements import ImuSample, VisualMotion, VisualTracks
from tracker.rig import Rig
from tracker.soundness import Soundness

S = 1_000_000_000


def motion(tracks: VisualTracks | None) -> VisualMotion:
    return VisualMotion(5 * S, 6 * S, 9, 4 * S, np.eye(3), (0.0, 0.6, 0.8), 80, 9.5, tracks is not None, tracks)


def features() -> VisualTracks:
    rays = np.random.default_rng(1).normal(size=(7, 4)).astype(np.float32)
    return VisualTracks(np.arange(3, 10), rays)


@pytest.mark.parametrize("tracks", [None, features()], ids=["no features", "features"])
def test_a_motion_is_read_as_it_was_written(tmp_path: Path, tracks: VisualTracks | None) -> None:
    written = motion(tracks)
    with LogWriter(tmp_path / "seen.mcap", Rig()) as writer:
        writer.write(ImuSample(S, S, (0.0, 0.0, 0.0), (0.0, 0.0, 9.8)))
        writer.write(written)
    log = Log.open(tmp_path / "seen.mcap")
    (read,) = (m for m in log.messages() if isinstance(m, VisualMotion))
    assert not log.skipped
    assert (read.t_ns, read.t_key_ns, read.direction_key) == (written.t_ns, written.t_key_ns, written.direction_key)
    assert (read.inliers, read.parallax_px, read.is_keyframe) == (80, 9.5, written.is_keyframe)
    if tracks is None:
        assert read.tracks is None
        return
    assert read.tracks is not None
    for name in ("ids", "rays"):
        np.testing.assert_array_equal(getattr(read.tracks, name), getattr(tracks, name), strict=True)


def test_a_motion_of_before_features_were_recorded_is_read_without_them() -> None:
    former = ros.message(
        ros.FORMER_MOTION,
        header=ros.header(5 * S, "camera_optical_frame"),
        key_stamp=ros.time(4 * S),
        frame_id=9,
        r_key_cam=np.eye(3).ravel(),
        direction_key=ros.vector((0.0, 0.6, 0.8)),
        inliers=80,
        parallax_px=9.5,
        is_keyframe=True,
    )
    read = ros.visual_motion(ros.decode(ros.encode(former), ros.MOTION), 6 * S)
    assert (read.frame_id, read.inliers, read.is_keyframe, read.tracks) == (9, 80, True, None)


def test_a_ray_that_is_no_number_is_left_out() -> None:
    broken = features()
    broken.xy[2, 1] = np.nan
    assert Soundness().fault(motion(features())) is None
    assert Soundness().fault(motion(broken)) == "not_finite"
