"""A planted ellipsoid is found; poor coverage, iron nearby and impossible fields are refused."""

from math import radians

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.tracker.calibrate.board_video import rotation
from tracker.calibrate.magnetometer import directions_seen, fit_magnetometer, sphere_points
from tracker.errors import InputError
from tracker.geomagnetism import MagneticField
from tracker.measurements import ImuSample, MagSample, Matrix

EPHESUS = MagneticField(radians(5.5), radians(56.0), 46.3e-6)


def tumbled(seed: int, count: int = 1500, lean: float = 3.0) -> Matrix:
    """Return (N, 3, 3) attitudes of a rig that a hand turns about all its axes, smoothly; a small lean leaves it level."""
    rng = np.random.default_rng(seed)
    t = np.linspace(0.0, 60.0, count)
    waves = rng.uniform(0.04, 0.13, 3)
    phases = rng.uniform(0.0, 6.28, 3)
    yaw = 2 * np.pi * waves[0] * t * 2 + phases[0]
    pitch, roll = (
        lean * np.sin(2 * np.pi * waves[1] * t + phases[1]),
        lean * np.sin(2 * np.pi * waves[2] * t + phases[2]),
    )
    return np.array(
        [
            rotation(np.array([0, 0, a])) @ rotation(np.array([0, b, 0])) @ rotation(np.array([c, 0, 0]))
            for a, b, c in zip(yaw, pitch, roll, strict=True)
        ]
    )


def readings(
    attitudes: Matrix, soft: Matrix, hard_t: Matrix, *, noise_t: float = 0.15e-6, seed: int = 1
) -> tuple[list[MagSample], list[ImuSample]]:
    """Return what a magnetometer with planted errors and an accelerometer say."""
    rng = np.random.default_rng([seed, 4])
    fields = np.einsum("nji,j->ni", attitudes, np.array(EPHESUS.enu_t)) @ soft.T + hard_t
    fields = fields + rng.normal(0.0, noise_t, fields.shape)
    ups = np.einsum("nji,j->ni", attitudes, np.array([0.0, 0.0, 9.81]))
    times = [i * 40_000_000 for i in range(len(fields))]
    return (
        [MagSample(t, t, (x, y, z)) for t, (x, y, z) in zip(times, fields.tolist(), strict=True)],
        [ImuSample(t, t, (0.0, 0.0, 0.0), (x, y, z)) for t, (x, y, z) in zip(times, ups.tolist(), strict=True)],
    )


def planted(seed: int) -> tuple[Matrix, Matrix]:
    """Return a symmetric soft iron of up to 15 per cent and a hard iron of up to 40 microtesla."""
    rng = np.random.default_rng([seed, 8])
    axes = rotation(rng.normal(0.0, 1.0, 3))
    return axes @ np.diag(rng.uniform(0.87, 1.15, 3)) @ axes.T, rng.uniform(-40e-6, 40e-6, 3)


@settings(max_examples=15)
@given(st.integers(0, 10_000))
def test_a_planted_ellipsoid_is_found(seed: int) -> None:
    soft, hard = planted(seed)
    samples, inertial = readings(tumbled(seed), soft, hard, seed=seed)
    fit = fit_magnetometer(samples, EPHESUS, inertial)
    np.testing.assert_allclose(fit.hard_iron_t, hard, atol=0.3e-6)
    np.testing.assert_allclose(fit.soft_iron @ soft, np.eye(3), atol=0.012)
    assert fit.dip_rad == pytest.approx(EPHESUS.inclination_rad, abs=radians(0.5))
    assert fit.residual < 0.01
    assert fit.verdict == "excellent"


def test_without_a_place_the_sensors_own_scale_is_kept() -> None:
    samples, _ = readings(tumbled(3), np.eye(3) * 1.1, np.array([1e-5, 0.0, 0.0]))
    fit = fit_magnetometer(samples, None)
    assert fit.strength_t == pytest.approx(1.1 * EPHESUS.strength_t, rel=0.01)
    np.testing.assert_allclose(fit.soft_iron, np.eye(3), atol=0.01)
    assert fit.dip_rad is None


@pytest.mark.parametrize("lean", [0.0, 0.25], ids=["level turn", "a little lean"])
def test_poor_coverage_is_refused(lean: float) -> None:
    samples, inertial = readings(tumbled(5, lean=lean), *planted(5))
    with pytest.raises(InputError, match="about each of its three axes"):
        fit_magnetometer(samples, EPHESUS, inertial)


def test_a_car_that_comes_and_goes_is_refused_and_a_post_passed_by_is_not() -> None:
    samples, inertial = readings(tumbled(6), *planted(6))
    raw = np.array([sample.field_body_t for sample in samples])

    def disturbed(share: float) -> list[MagSample]:
        near = np.arange(len(raw)) < share * len(raw)
        wave = 12e-6 * np.sin(np.arange(len(raw)) / 40.0)[:, None] * np.array([0.6, -0.5, 0.6])
        return [
            MagSample(sample.t_ns, sample.t_recv_ns, (x, y, z))
            for sample, (x, y, z) in zip(samples, (raw + wave * near[:, None]).tolist(), strict=True)
        ]

    with pytest.raises(InputError, match="go away from"):
        fit_magnetometer(disturbed(1.0), EPHESUS, inertial)
    fit = fit_magnetometer(disturbed(0.1), EPHESUS, inertial)
    np.testing.assert_allclose(fit.hard_iron_t, planted(6)[1], atol=0.6e-6)


@pytest.mark.parametrize("factor", [1e-4, 10.0], ids=["gauss", "a magnet's"])
def test_a_field_that_no_place_has_is_refused(factor: float) -> None:
    samples, _ = readings(tumbled(7), np.eye(3) * factor, np.zeros(3), noise_t=1e-8 * factor)
    with pytest.raises(InputError, match="check the place and the sensor's units"):
        fit_magnetometer(samples, EPHESUS)


@pytest.mark.parametrize("value", [0.0, 3e-5], ids=["nothing", "one value"])
def test_a_magnetometer_that_says_one_thing_is_refused(value: float) -> None:
    with pytest.raises(InputError):
        fit_magnetometer([MagSample(i, i, (value, value, value)) for i in range(500)], EPHESUS)
    with pytest.raises(InputError, match="0 readings"):
        fit_magnetometer([], EPHESUS)


@given(st.lists(st.tuples(*[st.floats(-1e-3, 1e-3)] * 3), min_size=100, max_size=120))
def test_any_readings_are_a_fit_or_one_sentence(values: list[tuple[float, float, float]]) -> None:
    samples = [MagSample(i, i, value) for i, value in enumerate(values)]
    try:
        fit = fit_magnetometer(samples, None)
    except InputError:
        return
    assert np.all(np.isfinite(fit.soft_iron))
    assert np.linalg.eigvalsh(fit.soft_iron)[0] > 0.0


def test_directions_are_spread_and_counted() -> None:
    points = sphere_points()
    nearest = np.sort(np.arccos(np.clip(points @ points.T, -1.0, 1.0)), axis=1)[:, 1]
    assert nearest.min() > 0.5 * nearest.max()
    assert directions_seen(points * 4e-5 + 1e-5) > 0.9
    assert directions_seen(np.zeros((0, 3))) == 0.0
