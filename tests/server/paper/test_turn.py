"""The gyroscope against a camera of known mounting, and both on recordings of a turning phone."""

from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from server.paper.attitude import CAMERA_LOGS, FULL_TURN
from server.paper.turn import AS_RECORDED, Mounting, Turns, agreement, camera_closing_deg, closing_deg, fit, turns
from tracker.errors import MissingSensor
from tracker.log import Log
from tracker.log_writer import LogWriter
from tracker.measurements import GpsFix, Matrix
from tracker.rig import R_BODY_CAM_FORWARD, Rig
from tracker.simulate import AGORA_ORIGIN, START_NS

MOUNTING = Mounting(np.array([0.01, 0.05, -0.03]), np.array([0.002, -0.004, 0.001]), 0.02)


def rate_rad_s(t_s: Matrix) -> Matrix:
    """A slow look round about all three axes."""
    return np.stack([0.3 * np.sin(t_s), 0.2 * np.cos(0.7 * t_s), 0.4 * np.sin(0.4 * t_s + 1.0)], axis=-1)


def truth(times_s: Matrix) -> list[Rotation]:
    """R_0_body at each time, by steps of five milliseconds."""
    steps = np.arange(0.0, times_s[-1] + 0.005, 0.005)
    turned = [Rotation.identity()]
    for step in Rotation.from_rotvec(rate_rad_s(steps + 0.0025) * 0.005):
        turned.append(turned[-1] * step)
    return [turned[round(time_s / 0.005)] for time_s in times_s.tolist()]


@pytest.fixture(scope="module")
def look() -> Turns:
    """Camera and gyroscope of one look round, the gyroscope mounted, offset and late as `MOUNTING` says."""
    t_s = np.arange(0.0, 12.0, 0.01)
    keys = np.arange(1.0, 11.0, 0.7)
    body = truth(keys)
    body_cam = Rotation.from_matrix(R_BODY_CAM_FORWARD) * Rotation.from_rotvec(MOUNTING.rotation_cam_rad)
    seen = [(body_cam.inv() * a.inv() * b * body_cam).as_matrix() for a, b in pairwise(body)]
    gyro = rate_rad_s(t_s - MOUNTING.lag_s) + MOUNTING.gyro_offset_rad_s
    return Turns(np.stack([keys[:-1], keys[1:]], axis=1), np.array(seen), t_s, gyro, R_BODY_CAM_FORWARD)


def test_a_known_mounting_leaves_nothing(look: Turns) -> None:
    assert agreement(look, MOUNTING)["median_deg"] < 0.01
    assert agreement(look, AS_RECORDED)["median_deg"] > 0.5
    assert agreement(look, MOUNTING)["keyframes"] == 14


def test_the_mounting_is_found(look: Turns) -> None:
    found = fit([look])
    assert found.rotation_cam_rad == pytest.approx(MOUNTING.rotation_cam_rad, abs=1e-3)
    assert found.gyro_offset_rad_s == pytest.approx(MOUNTING.gyro_offset_rad_s, abs=1e-4)
    assert found.lag_s == pytest.approx(MOUNTING.lag_s, abs=2e-3)


def test_a_log_without_camera_is_refused(tmp_path: Path) -> None:
    with LogWriter(tmp_path / "blind.mcap", Rig(), AGORA_ORIGIN, t_start_ns=START_NS) as writer:
        writer.write(
            GpsFix(
                START_NS,
                START_NS,
                AGORA_ORIGIN.lat_deg,
                AGORA_ORIGIN.lon_deg,
                88.4,
                (4.0, 0.0, 0.0, 0.0, 4.0, 0.0, 0.0, 0.0, 9.0),
            )
        )
    with pytest.raises(MissingSensor, match=r"blind has no calibrated camera"):
        turns(Log.open(tmp_path / "blind.mcap"))


def test_camera_and_gyroscope_agree_between_keyframes(shared: Path) -> None:
    """Below half a degree in the median, in both recordings, by one mounting: the camera stands 3 degrees off its nominal axes."""
    recordings = [turns(Log.open(shared / "data" / f"{name}.mcap")) for name in CAMERA_LOGS]
    mounting = fit(recordings)
    for recording in recordings:
        assert agreement(recording, mounting)["median_deg"] < 0.5
        assert agreement(recording, mounting)["turn_median_deg"] > 10.0
    assert 2.0 < np.degrees(np.linalg.norm(mounting.rotation_cam_rad)) < 4.5


def test_a_full_turn_closes_by_camera_and_gyroscope(shared: Path) -> None:
    """Within 5 degrees together; the camera alone, keyframe chained to keyframe, is further off."""
    log = Log.open(shared / "data" / f"{FULL_TURN}.mcap")
    together = closing_deg(log, "camera-gps-imu/famm")
    assert together < 5.0
    assert together < camera_closing_deg(log) < 20.0
