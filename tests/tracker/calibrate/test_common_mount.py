"""Recordings of one rig together: what they share is known better, what is each one's own stays so, and what disagrees is said."""

from functools import cache
from pathlib import Path

import numpy as np
import pytest

from tests.tracker.calibrate.board_video import rotation
from tests.tracker.calibrate.far_points import FarPoints
from tests.tracker.calibrate.rig_motion import RigMotion
from tests.tracker.calibrate.test_camera_mount import degrees_apart, of_log
from tracker.calibrate.camera_mount import CameraMount
from tracker.calibrate.common_mount import common_mount
from tracker.rig import R_BODY_CAM_FORWARD, CameraModel

CAMERA = CameraModel(480, 360, 430.0, 430.0, 239.5, 179.5)
R_BODY_CAM = R_BODY_CAM_FORWARD @ rotation(np.array([0.05, -0.07, 0.03]))
PAN, ROLL = (0.03, 0.03, 0.7), (0.7, 0.03, 0.12)
BIASES = ((0.01, -0.02, 0.005), (-0.015, 0.008, 0.0))


@cache
def recording(
    seed: int, size_rad: tuple[float, float, float], offset_s: float, focal_px: float = 430.0, turned_deg: float = 0.0
) -> CameraMount:
    camera = CameraModel(480, 360, focal_px, focal_px, 239.5, 179.5)
    R = R_BODY_CAM @ rotation(np.radians([turned_deg, 0.0, 0.0]))
    return FarPoints(RigMotion(seed, 8.0, size_rad), camera, R, offset_s, BIASES[seed % 2]).mount()


def test_the_same_recording_twice_says_the_same_more_surely_and_what_no_turn_tells_stays() -> None:
    alone = recording(1, (0.3, 0.45, 0.7), 0.04)
    common = common_mount([alone, alone])
    assert common.camera.fx_px == pytest.approx(alone.camera.fx_px, rel=1e-4)
    assert degrees_apart(common.R_body_cam, alone.alignment.R_body_cam) < 0.002
    assert common.focal_scatter_px == pytest.approx(alone.focal_scatter_px / np.sqrt(2.0), rel=0.05)
    assert common.rotation_sigmas_rad == pytest.approx(alone.alignment.rotation_sigmas_rad / np.sqrt(2.0), rel=0.05)
    assert [mount.alignment.focal_share for mount in common.mounts] == pytest.approx([0.5, 0.5])
    untold_px = np.sqrt(alone.focal_sigma_px**2 - alone.focal_scatter_px**2)
    assert np.sqrt(common.focal_sigma_px**2 - common.focal_scatter_px**2) == pytest.approx(untold_px, rel=1e-3)


@pytest.mark.parametrize("seed", [2, 5])
def test_a_pan_and_a_roll_tell_together_what_neither_tells_alone(seed: int) -> None:
    """Each with clock and bias of its own; whichever comes first."""
    pan, roll = recording(seed, PAN, 0.05), recording(seed + 1, ROLL, -0.12)
    common = common_mount([pan, roll])
    assert degrees_apart(common.R_body_cam, R_BODY_CAM) < 0.2
    assert common.camera.fx_px == pytest.approx(430.0, abs=4.0 * common.focal_scatter_px)
    for k, (alone, offset_s) in enumerate(((pan, 0.05), (roll, -0.12))):
        assert common.rotation_sigmas_rad[-1] < alone.alignment.rotation_sigmas_rad[-1]
        assert common.mounts[k].alignment.offset_s == pytest.approx(offset_s, abs=0.003)
        np.testing.assert_allclose(common.mounts[k].alignment.bias_rad_s, BIASES[(seed + k) % 2], atol=0.002)
    shares = [mount.alignment.focal_share for mount in common.mounts]
    assert sum(shares) == pytest.approx(1.0)
    assert shares[0] > 0.8
    other = common_mount([roll, pan])
    assert other.camera.fx_px == pytest.approx(common.camera.fx_px, rel=1e-3)
    assert degrees_apart(other.R_body_cam, common.R_body_cam) < 0.02


def test_a_camera_that_was_moved_between_recordings_is_noticed_and_one_that_was_not_is_not() -> None:
    still = recording(2, (0.3, 0.45, 0.7), 0.0)
    assert common_mount([still, recording(3, (0.3, 0.45, 0.7), 0.03)]).rotation_apart_rad == 0.0
    moved = common_mount([still, recording(3, (0.3, 0.45, 0.7), 0.03, turned_deg=2.0)])
    assert np.degrees(moved.rotation_apart_rad) == pytest.approx(2.0, abs=0.2)


def test_recordings_that_disagree_leave_the_focal_length_as_uncertain_as_they_are_apart() -> None:
    """A zoom between them: 400 and 440 px cannot be known within less than half of that; 427 and 433 may be one and the same."""
    lively = (0.3, 0.45, 0.7)
    zoomed = common_mount([recording(4, lively, 0.0, 400.0), recording(5, lively, 0.0, 440.0)])
    assert zoomed.disagrees
    assert 400.0 < zoomed.camera.fx_px < 440.0
    assert zoomed.focal_scatter_px == pytest.approx(20.0, rel=0.1)
    alike = common_mount([recording(4, lively, 0.0, 427.0), recording(5, lively, 0.0, 433.0)])
    assert not alike.disagrees
    assert alike.focal_scatter_px < 1.5


def test_clocks_that_differ_from_start_to_start_are_no_better_known_than_that() -> None:
    clocks = common_mount([recording(2, (0.3, 0.45, 0.7), 0.0), recording(3, (0.3, 0.45, 0.7), 0.03)])
    assert clocks.offset_s == pytest.approx(0.015, abs=0.003)
    assert clocks.offset_sigma_s == pytest.approx(0.03 / np.sqrt(2.0), abs=0.003)


def test_the_pan_and_the_roll_of_a_phone_together(shared: Path) -> None:
    """../shared/data/README.md, traps 3 and 4: together they tell the mount, and a focal length that may be 478 px."""
    pan, roll = (of_log(shared / "data" / f"transformflow-{name}.mcap") for name in ("1606", "avonhead-1611"))
    common = common_mount([pan, roll])
    assert roll.camera.fx_px < common.camera.fx_px < pan.camera.fx_px
    assert 1.0 < common.focal_strain < 2.0
    assert common.camera.fx_px == pytest.approx(478.0, abs=1.96 * common.focal_sigma_px)
    assert common.focal_sigma_px / common.camera.fx_px < 0.035
    stated = np.array([[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0]])
    assert degrees_apart(stated, common.R_body_cam) < 3.0
    assert np.degrees(common.rotation_sigmas_rad[-1]) < 0.5 < np.degrees(pan.alignment.rotation_sigmas_rad[-1])
