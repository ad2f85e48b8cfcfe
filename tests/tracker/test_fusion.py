"""Six filters of two states against one of twelve, as filterpy computes it."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tracker.fusion import FusionFilter, FusionSettings, transition
from tracker.fuzzy import MOTION_MODELS, MotionModel
from tracker.measurements import Matrix

small = st.floats(-0.3, 0.3)
steps = st.lists(
    st.tuples(st.sampled_from(MOTION_MODELS), st.floats(0.01, 0.5), st.tuples(*[small] * 6)), min_size=1, max_size=12
)
H: Matrix = np.zeros((6, 12))
H[:3, :3] = H[3:, 6:9] = np.eye(3)
VARIANCES = (4.5, 4.5, 16.0)


def noise(dt_s: float, model: MotionModel, set_: FusionSettings) -> Matrix:
    """Q, (12, 12)."""
    Q = np.zeros((12, 12))
    for axis in range(3):
        for v, rate, sigma, c in (
            (axis, axis + 3, set_.accel_noise_m_s2, model.i),
            (axis + 6, axis + 9, set_.angular_accel_noise_rad_s2, model.j),
        ):
            Q[v, v], Q[rate, rate] = 0.25 * sigma**2 * dt_s**4, sigma**2 * dt_s**2
            Q[v, rate] = Q[rate, v] = 0.5 * sigma**2 * dt_s**3 if c else 0.0
    return Q


@settings(max_examples=40)
@given(steps)
def test_six_pairs_equal_twelve_states(walk: list[tuple[MotionModel, float, tuple[float, ...]]]) -> None:
    set_ = FusionSettings()
    ours = FusionFilter.start(set_, (1.0, 2.0, 3.0), (0.1, -0.1, 0.2), VARIANCES)
    x, P = ours.state(), ours.covariance()
    R = np.diag([*VARIANCES, *[set_.rotation_sigma_rad**2] * 3])
    for model, dt_s, offset in walk:
        F = transition(dt_s, model)
        x, P = F @ x, F @ P @ F.T + noise(dt_s, model, set_)
        z = H @ x + np.array(offset)
        ours.predict(dt_s, model)
        y_p, y_r = ours.innovation((z[0], z[1], z[2]), (z[3], z[4], z[5]))
        assert y_p is not None
        ours.update(y_p, y_r, VARIANCES)
        K = P @ H.T @ np.linalg.inv(H @ P @ H.T + R)
        x, P = x + K @ (z - H @ x), (np.eye(12) - K @ H) @ P
        assert np.allclose(np.angle(np.exp(1j * (ours.state() - x)[6:9])), 0.0, atol=1e-9)
        assert np.allclose(ours.state()[[0, 1, 2, 3, 4, 5, 9, 10, 11]], x[[0, 1, 2, 3, 4, 5, 9, 10, 11]], atol=1e-9)
        assert np.allclose(ours.covariance(), P, atol=1e-9)
        assert np.linalg.eigvalsh(ours.covariance()).min() > -1e-12


def test_an_innovation_takes_the_shorter_way_round() -> None:
    ours = FusionFilter.start(FusionSettings(), (0.0, 0.0, 0.0), (0.0, 0.0, 3.1), VARIANCES)
    _, y_r = ours.innovation(ours.position_m, (0.0, 0.0, -3.1))
    assert y_r[2] == pytest.approx(2 * np.pi - 6.2)


def test_rest_keeps_the_place_and_double_speed_doubles_the_step() -> None:
    for i, expected in ((0, 0.0), (1, 0.5), (2, 1.0)):
        ours = FusionFilter.start(FusionSettings(), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0), VARIANCES)
        ours.rate[0] = 1.0
        ours.predict(0.5, MotionModel(i, 1))  # type: ignore[arg-type]
        assert ours.value[0] == expected
        assert ours.rate[0] == 1.0
