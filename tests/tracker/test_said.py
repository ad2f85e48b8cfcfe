"""Taps as measurements: through the lens and back, and what is refused."""

import numpy as np
import pytest

from tracker import blank
from tracker.errors import InputError
from tracker.lens import project
from tracker.measurements import Outcome
from tracker.said import LANDMARK_SIGMA_M, refusal_words, sighting
from tracker.simulate import default_rig

CAMERA = default_rig().camera or blank.CAMERA
POINT = (1.0, 2.0, 3.0)


@pytest.mark.parametrize("place_px", [(0.0, 0.0), (321.3, 238.6), (639.0, 12.0), (100.0, 479.0)])
def test_the_direction_of_a_tap_is_seen_where_it_was_tapped(place_px: tuple[float, float]) -> None:
    """The lens bends: near the corners by pixels."""
    seen = sighting(CAMERA, place_px, 3.0, POINT, t_ns=5, t_recv_ns=9)
    x, y, z = seen.ray_cam
    assert np.hypot(np.hypot(x, y), z) == pytest.approx(1.0)
    assert project(CAMERA, np.array([[x / z, y / z]]))[0] == pytest.approx(place_px, abs=0.01)
    assert (seen.t_ns, seen.t_recv_ns, seen.point_site_m) == (5, 9, POINT)


def test_a_finger_is_as_good_as_it_says_and_a_landmark_near_by_is_worse() -> None:
    def sigma_rad(sigma_px: float, distance_m: float) -> float:
        return sighting(CAMERA, (9.0, 9.0), sigma_px, POINT, t_ns=0, t_recv_ns=0, distance_m=distance_m).sigma_rad

    assert sigma_rad(5.2, 1e6) == pytest.approx(0.01, rel=1e-3)
    assert sigma_rad(1e-6, 10.0) == pytest.approx(LANDMARK_SIGMA_M / 10.0)
    assert sigma_rad(5.2, 5.0) > sigma_rad(5.2, 50.0)
    assert sigma_rad(5.2, 0.01) == sigma_rad(5.2, 1.0)


@pytest.mark.parametrize("place_px", [(-9.0, 5.0), (5.0, 490.0), (float("nan"), 5.0)])
def test_a_tap_outside_the_picture_is_refused(place_px: tuple[float, float]) -> None:
    with pytest.raises(InputError, match="outside the picture"):
        sighting(CAMERA, place_px, 3.0, POINT, t_ns=0, t_recv_ns=0)


def test_a_refusal_says_what_to_do() -> None:
    assert refusal_words(Outcome.USED, "gps-imu/precise") is None
    assert refusal_words(Outcome.WAITING, "gps-imu/precise") is None
    assert "precise" in (refusal_words(Outcome.IGNORED, "gps-imu/cmm") or "")
    assert "newer picture" in (refusal_words(Outcome.REJECTED_STALE, "gps-imu/precise") or "")
    assert "another landmark" in (refusal_words(Outcome.REJECTED_GATE, "gps-imu/precise") or "")
