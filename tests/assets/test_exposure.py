"""The camera's exposure, blur and noise against what optics and statistics say of them."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from assets import exposure
from assets.exposure import LONGEST_S, SHORTEST_S, WANTED_LIGHT, Exposure, Picture
from assets.lens import Pinhole

CAMERA = Pinhole(640, 480, 520.0, 520.0, 319.5, 239.5)
PERIOD_S = 1.0 / 12.0
PIXELS_SPREAD_PX = 2.0**0.5
"""What the squares of two neighbouring pixels do to a sharp edge by themselves."""


def scene_lit(light: float) -> Picture:
    return exposure.picture_of(np.full((24, 32, 3), light, np.float32))


def settled(first: Exposure, light: float, duration_s: float) -> Exposure:
    """Return the exposure after some time before a plain wall that has `light` at the usual exposure."""
    exposed = first
    for _ in range(round(duration_s / PERIOD_S)):
        exposed = exposed.after(scene_lit(light * exposed.brightness), PERIOD_S)
    return exposed


def turned(angle_rad: float) -> NDArray[np.float64]:
    """Return the pose of a camera that has turned about its upright axis."""
    pose, cos, sin = np.eye(4), np.cos(angle_rad), np.sin(angle_rad)
    pose[:3, :3] = [[cos, 0.0, sin], [0.0, 1.0, 0.0], [-sin, 0.0, cos]]
    return pose


# -- auto-exposure ----------------------------------------------------------------------------------------------------


@given(light=st.floats(0.28, 0.48), first_s=st.floats(SHORTEST_S, LONGEST_S))
@settings(deadline=None, max_examples=30)
def test_exposure_converges_to_the_wanted_light_from_anywhere(light: float, first_s: float) -> None:
    exposed = settled(Exposure(first_s), light, 6.0)
    assert light * exposed.brightness == pytest.approx(WANTED_LIGHT, rel=0.02)


def test_exposure_follows_slowly_and_never_overshoots() -> None:
    before = settled(Exposure(), 0.3, 6.0)
    times_s = [before.time_s]
    exposed = before
    for _ in range(36):
        exposed = exposed.after(scene_lit(0.45 * exposed.brightness), PERIOD_S)
        times_s.append(exposed.time_s)
    logs = np.log(times_s)
    assert (np.diff(logs) <= 0.0).all()
    after_lag = logs[round(exposure.LAG_S / PERIOD_S)]
    assert (logs[0] - after_lag) / (logs[0] - logs[-1]) == pytest.approx(1.0 - np.exp(-1.0), abs=0.06)


@pytest.mark.parametrize(("light", "limit_s"), [(0.0, LONGEST_S), (1.0, SHORTEST_S)])
def test_exposure_keeps_within_what_the_shutter_can(light: float, limit_s: float) -> None:
    exposed = Exposure()
    for _ in range(120):
        exposed = exposed.after(scene_lit(light), PERIOD_S)
        assert SHORTEST_S <= exposed.time_s <= LONGEST_S
    assert exposed.time_s == pytest.approx(limit_s, abs=exposure.SHUTTER_STEP_S / 2.0)


def test_more_time_is_more_light() -> None:
    assert Exposure(2.0 * SHORTEST_S).brightness == pytest.approx(2.0 * Exposure(SHORTEST_S).brightness)


# -- motion blur ------------------------------------------------------------------------------------------------------


@given(angle_px=st.floats(0.0, 20.0))
def test_the_motion_of_a_turn_is_the_focal_length_times_the_angle_and_more_at_the_edges(angle_px: float) -> None:
    moved_px = exposure.motion_px(turned(0.0), turned(angle_px / CAMERA.fx_px), CAMERA)
    edge = 0.45 * CAMERA.width_px / CAMERA.fx_px
    assert moved_px == pytest.approx(
        angle_px * np.hypot(1.0 + edge**2, edge * 0.45 * 480.0 / 520.0), rel=0.03, abs=1e-9
    )


def test_the_motion_of_a_step_to_the_side_is_that_of_points_five_metres_off() -> None:
    aside = turned(0.0)
    aside[0, 3] = 0.01
    assert exposure.motion_px(turned(0.0), aside, CAMERA) == pytest.approx(520.0 * 0.01 / exposure.METERED_AT_M)


def test_a_still_camera_is_drawn_once_in_the_middle_of_the_exposure() -> None:
    assert exposure.moments(LONGEST_S, 0.0).tolist() == [0.0]


@given(moved_px=st.floats(0.0, 60.0))
def test_moments_are_close_enough_even_and_about_the_middle(moved_px: float) -> None:
    times_s = exposure.moments(LONGEST_S, moved_px)
    assert len(times_s) <= exposure.MOST_MOMENTS
    assert moved_px / len(times_s) <= exposure.STEP_PX or len(times_s) == exposure.MOST_MOMENTS
    assert times_s.sum() == pytest.approx(0.0, abs=1e-12)
    np.testing.assert_allclose(np.diff(times_s), LONGEST_S / len(times_s))


@pytest.mark.parametrize("speed_px_s", [0.0, 300.0, 900.0, 1500.0])
def test_an_edge_is_blurred_over_the_way_that_it_moves(speed_px_s: float) -> None:
    """A sharp edge passes: the light rises over as many pixels as the edge moves while the shutter is open."""
    moved_px = speed_px_s * LONGEST_S

    def drawn(after_s: float) -> Picture:
        covered = np.clip(32.0 + speed_px_s * after_s - np.arange(64) + 0.5, 0.0, 1.0)
        return exposure.picture_of(np.broadcast_to(covered[None, :, None], (4, 64, 3)).astype(np.float32))

    light = exposure.light_of(exposure.mean_of([drawn(t) for t in exposure.moments(LONGEST_S, moved_px)]))[0, :, 0]
    ramp = -np.diff(light)
    at = np.arange(63) + 0.5
    middle = (ramp * at).sum()
    spread_px = np.sqrt(12.0 * (ramp * (at - middle) ** 2).sum())
    assert middle == pytest.approx(32.0, abs=0.1)
    assert spread_px == pytest.approx(np.hypot(moved_px, PIXELS_SPREAD_PX), abs=0.6)


def test_the_mean_of_pictures_is_one_of_light_not_of_levels() -> None:
    black, white = scene_lit(0.0), scene_lit(1.0)
    assert exposure.light_of(exposure.mean_of([black, white])).mean() == pytest.approx(0.5, abs=0.005)


# -- lens and sensor --------------------------------------------------------------------------------------------------


def test_the_vignette_is_one_in_the_middle_and_least_in_the_corners() -> None:
    falloff = exposure.vignette(CAMERA)
    assert falloff.shape == (480, 640)
    assert falloff[239:241, 319:321].min() > 0.9999
    assert falloff.min() == falloff[0, 0] == pytest.approx(1.0 - exposure.VIGNETTE, abs=0.002)


@pytest.mark.parametrize("light", [0.02, 0.1, 0.35, 0.7])
def test_noise_has_the_variance_of_its_electrons(light: float) -> None:
    """Shot noise as Poisson's, read noise beside it, and the rounding to levels."""
    plain = exposure.picture_of(np.full((200, 200, 3), light, np.float32))
    read = exposure.light_of(exposure.sensed(plain, np.ones((200, 200), np.float32), np.random.default_rng(4)))
    true = float(exposure.light_of(plain).mean())
    electrons = true * exposure.FULL_WELL_E
    expected = (electrons + exposure.READ_NOISE_E**2) / exposure.FULL_WELL_E**2
    rounding = (2.0 * np.sqrt(true) / 255.0) ** 2 / 12.0
    assert float(read.mean()) == pytest.approx(true, rel=0.01)
    assert float(read.var()) == pytest.approx(expected + rounding, rel=0.06)


def test_noise_is_the_same_for_the_same_seed_only() -> None:
    plain, flat = scene_lit(0.4), np.ones((24, 32), np.float32)
    first, again, other = (exposure.sensed(plain, flat, np.random.default_rng(seed)) for seed in (1, 1, 2))
    assert (first == again).all()
    assert (first != other).any()
