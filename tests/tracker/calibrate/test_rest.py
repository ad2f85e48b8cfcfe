"""A rest tells bias, noise and scale; a rig that moves is refused, with when and how."""

from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.tracker.calibrate.board_video import rotation
from tracker.calibrate.rest import fit_rest, fit_sides, longest_rest
from tracker.errors import InputError
from tracker.measurements import ImuSample, Matrix

G = 9.80
RATE_HZ = 250.0
GYRO_NOISE, ACCEL_NOISE = 0.0017, 0.0028
"""Of one sample, as a PhidgetSpatial's."""

Motion = Callable[[Matrix], tuple[Matrix, Matrix]]
"""Times to rates and forces that come on top, (N, 3) each."""


def at_rest(
    seconds: float,
    *,
    bias: Matrix | None = None,
    accel: Matrix | None = None,
    seed: int = 1,
    motion: Motion | None = None,
    t_begin_s: float = 0.0,
) -> list[ImuSample]:
    rng = np.random.default_rng(seed)
    t = np.arange(0.0, seconds, 1.0 / RATE_HZ)
    gyro = np.zeros(3) if bias is None else bias
    force = np.array([0.0, 0.0, G]) if accel is None else accel
    gyros = gyro + rng.normal(0.0, GYRO_NOISE, (len(t), 3))
    forces = force + rng.normal(0.0, ACCEL_NOISE, (len(t), 3))
    if motion is not None:
        rates, shakes = motion(t)
        gyros, forces = gyros + rates, forces + shakes
    return [
        ImuSample(round(when * 1e9), round(when * 1e9), (g[0], g[1], g[2]), (a[0], a[1], a[2]))
        for when, g, a in zip((t + t_begin_s).tolist(), gyros.tolist(), forces.tolist(), strict=True)
    ]


@settings(max_examples=15)
@given(
    st.integers(0, 10_000),
    st.tuples(*[st.floats(-0.05, 0.05)] * 3),
    st.tuples(*[st.floats(-3.0, 3.0)] * 3),
    st.floats(0.95, 1.05),
)
def test_planted_errors_are_found_in_any_attitude_and_mount(
    seed: int, bias: tuple[float, float, float], attitude: tuple[float, float, float], scale: float
) -> None:
    R_body_imu = rotation(np.array(attitude))
    bias_imu = np.array(bias)
    accel_body = rotation(np.array(attitude[::-1])) @ np.array([0.0, 0.0, G]) / scale
    fit = fit_rest(at_rest(12.0, bias=R_body_imu @ bias_imu, accel=accel_body, seed=seed), R_body_imu, G)
    assert np.all(np.abs(fit.gyro_bias_rad_s - bias_imu) < 6.0 * fit.gyro_bias_sigma_rad_s + 2e-5)
    np.testing.assert_allclose(fit.accel_scale, scale, rtol=1e-4)
    np.testing.assert_allclose(fit.accel_bias_m_s2, 0.0)
    np.testing.assert_allclose(fit.gyro_noise_rad_s_sqrt_hz, GYRO_NOISE / np.sqrt(RATE_HZ), rtol=0.08)
    np.testing.assert_allclose(fit.accel_noise_m_s2_sqrt_hz, ACCEL_NOISE / np.sqrt(RATE_HZ), rtol=0.08)


def one_axis(rates: Matrix) -> Matrix:
    return np.column_stack([np.zeros_like(rates), np.zeros_like(rates), rates])


def turned_slowly(t: Matrix) -> tuple[Matrix, Matrix]:
    return one_axis(np.where((t > 6.0) & (t < 8.0), np.radians(0.5), 0.0)), np.zeros((len(t), 3))


def held_by_a_hand(t: Matrix) -> tuple[Matrix, Matrix]:
    return one_axis(0.02 * np.sin(2 * np.pi * 0.7 * t)), one_axis(0.05 * np.sin(2 * np.pi * 0.5 * t))


def knocked_at(t: Matrix) -> tuple[Matrix, Matrix]:
    return np.zeros((len(t), 3)), one_axis(np.where(np.abs(t - 9.0) < 0.1, 1.5, 0.0))


def tilted_at_last(t: Matrix) -> tuple[Matrix, Matrix]:
    shift = np.where(t > 11.0, G * np.radians(0.6), 0.0)
    return np.zeros((len(t), 3)), np.column_stack([shift, np.zeros_like(t), np.zeros_like(t)])


@pytest.mark.parametrize(
    ("motion", "words"),
    [
        (turned_slowly, r"moved 6\.\d s after the start \(it turned"),
        (held_by_a_hand, r"moved .* lay it on something firm"),
        (knocked_at, r"moved (8\.5|9\.0) s after the start \(it was shaken"),
        (tilted_at_last, r"moved 1\d\.\d s after the start \(it tilted by 0\.\d degrees"),
    ],
)
def test_a_rig_that_moves_is_refused(motion: Motion, words: str) -> None:
    with pytest.raises(InputError, match=words):
        fit_rest(at_rest(14.0, motion=motion), np.eye(3), G)


def test_short_rests_and_unsound_units_are_refused() -> None:
    with pytest.raises(InputError, match="leave the rig alone for longer"):
        fit_rest(at_rest(5.0), np.eye(3), G)
    with pytest.raises(InputError, match="is the inertial unit attached"):
        fit_rest([], np.eye(3), G)
    with pytest.raises(InputError, match="are its units right"):
        fit_rest(at_rest(12.0, accel=np.array([0.0, 0.0, 1.0])), np.eye(3), G)


def test_the_longest_rest_of_a_recording_is_found() -> None:
    moving = at_rest(8.0, motion=lambda t: (one_axis(np.sin(3.0 * t)), np.zeros((len(t), 3))), t_begin_s=5.0)
    samples = [*at_rest(5.0), *moving, *at_rest(13.0, seed=2, t_begin_s=13.0)]
    rest = longest_rest(samples)
    assert 13.0 <= rest[0].t_ns * 1e-9 < 14.1
    assert rest[-1].t_ns * 1e-9 > 24.5
    assert fit_rest(rest, np.eye(3), G).duration_s > 10.5
    assert not longest_rest(moving)


def test_six_sides_tell_bias_and_scale_of_each_axis() -> None:
    bias, scale = np.array([0.08, -0.12, 0.05]), np.array([1.01, 0.985, 1.004])
    samples: list[ImuSample] = []
    sides = np.array([[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]], np.float64)
    for i, up in enumerate(sides):
        up = rotation(np.random.default_rng(i).normal(0.0, 0.1, 3)) @ up
        samples += at_rest(5.0, accel=up * G / scale + bias, seed=i, t_begin_s=8.0 * i)
        turning = at_rest(
            3.0, motion=lambda t: (one_axis(np.ones_like(t)), np.zeros((len(t), 3))), t_begin_s=8.0 * i + 5.0
        )
        samples += turning
    fit = fit_sides(samples, np.eye(3), G)
    assert fit.attitudes == 6
    np.testing.assert_allclose(fit.accel_bias_m_s2, bias, atol=0.003)
    np.testing.assert_allclose(fit.accel_scale, scale, atol=0.0005)
    with pytest.raises(InputError, match="in 5 attitudes"):
        fit_sides(samples[: len(samples) * 5 // 6], np.eye(3), G)
