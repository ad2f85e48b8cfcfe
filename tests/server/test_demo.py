"""The demo's pictures can be tracked: features, their tracks, and the rotation between two views; and its sun is theirs."""

from dataclasses import dataclass

import cv2
import numpy as np
import pytest

from assets.site import load_site
from assets.solar import direction, sun_at
from assets.sun import sun_direction
from server.cli import DEMO_LOG, SITE
from tracker.geometry import matrix_from_wxyz
from tracker.log import Log
from tracker.measurements import Frame, Matrix, TruePose, VisualMotion
from tracker.rig import Rig
from tracker.vision import VisionFrontEnd

SAMPLED = 5
"""Every fifth picture is looked at for features: 2.4 a second."""
FEATURES_WANTED, FEATURES_LEAST, FRAMES_WITH_THEM = 1000, 300, 0.9
ROTATION_ERROR_DEG = 0.3
TRACKS_LEAST = 150


class TrueAttitude:
    """The camera's true attitude between the truth's samples."""

    def __init__(self, poses: list[TruePose], rig: Rig) -> None:
        self._t_ns = np.array([pose.t_ns for pose in poses])
        wxyz = np.array([pose.wxyz_map_body for pose in poses])
        turned_over = np.cumprod(np.where((wxyz[1:] * wxyz[:-1]).sum(axis=1) < 0.0, -1.0, 1.0))
        self._wxyz = wxyz * np.concatenate([[1.0], turned_over])[:, None]
        self._R_body_cam = rig.T_body_cam[:3, :3]

    def R_map_cam(self, t_ns: int) -> Matrix:
        """Return the attitude at a stamp, (3, 3): the truth's samples are 10 ms apart, so a chord will do."""
        w, x, y, z = (float(np.interp(t_ns, self._t_ns, self._wxyz[:, k])) for k in range(4))
        size = float(np.linalg.norm((w, x, y, z)))
        return np.asarray(matrix_from_wxyz((w / size, x / size, y / size, z / size)) @ self._R_body_cam)


def angle_deg(R: Matrix) -> float:
    return float(np.degrees(np.arccos(np.clip((np.trace(R) - 1.0) / 2.0, -1.0, 1.0))))


@dataclass(frozen=True, eq=False)
class Demo:
    """What the tests need of the log, read once."""

    rig: Rig
    frames: list[Frame]
    truth: TrueAttitude
    motions: list[VisualMotion]


@pytest.fixture(scope="module")
def demo() -> Demo:
    log = Log.open(DEMO_LOG)
    messages = [m for m in log.messages() if isinstance(m, Frame | TruePose)]
    frames = [m for m in messages if isinstance(m, Frame)]
    assert log.rig.camera is not None
    front_end = VisionFrontEnd(log.rig.camera)
    motions = [motion for motion in map(front_end.step, frames) if motion is not None]
    return Demo(log.rig, frames, TrueAttitude([m for m in messages if isinstance(m, TruePose)], log.rig), motions)


def test_features_are_found_in_nine_frames_of_ten(demo: Demo) -> None:
    orb = cv2.ORB_create(FEATURES_WANTED)  # type: ignore[attr-defined]  # its stubs leave it out
    counts = np.array([len(orb.detect(frame.picture.gray(), None)) for frame in demo.frames[::SAMPLED]])
    assert len(counts) > 150
    assert np.mean(counts >= FEATURES_LEAST) >= FRAMES_WITH_THEM, np.percentile(counts, [1, 10, 50])


def test_rotation_between_two_views_agrees_with_truth(demo: Demo) -> None:
    errors_deg = [
        angle_deg(motion.R_key_cam.T @ demo.truth.R_map_cam(motion.t_key_ns).T @ demo.truth.R_map_cam(motion.t_ns))
        for motion in demo.motions
    ]
    assert len(errors_deg) > 0.9 * len(demo.frames)
    assert np.median(errors_deg) <= ROTATION_ERROR_DEG


def test_features_stay_on_their_tracks(demo: Demo) -> None:
    assert np.median([motion.inliers for motion in demo.motions]) >= TRACKS_LEAST


def test_the_sun_of_the_walks_date_is_the_sun_of_its_pictures() -> None:
    info = Log.open(DEMO_LOG).info
    origin = load_site(SITE).origin
    assert info.utc_offset_s is not None
    sun = sun_at(info.t_start_ns * 1e-9 + info.utc_offset_s, origin.lat_deg, origin.lon_deg)
    off_deg = np.degrees(np.arccos(np.dot(direction(sun), sun_direction())))
    assert off_deg < 1.0, "shadows in the picture and on the page would fall apart"
