"""Poses for any time: asking changes nothing, they go on smoothly, and say how unsure they are of what nobody has felt yet."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.tracker.precise.stream import NAMES, S, estimator, feed, row, stream, walk
from tracker.estimator import Pose
from tracker.geometry import conjugate, log, multiply
from tracker.measurements import GpsFix, ImuSample, Matrix
from tracker.precise.estimator import PreciseEstimator
from tracker.simulate import START_NS

NOW_NS = START_NS + 24 * S
MS = 1_000_000


@pytest.fixture(scope="module")
def walking() -> PreciseEstimator:
    """An estimator in the middle of a walk."""
    one = estimator()
    feed(one, (m for m in stream() if m.t_recv_ns <= NOW_NS))
    return one


def _pose(one: PreciseEstimator, t_ns: int) -> Pose:
    pose = one.predict(t_ns)
    assert pose is not None
    assert pose.t_ns == t_ns
    return pose


def _sigmas(pose: Pose) -> Matrix:
    return np.asarray(np.sqrt(np.diag(pose.cov)))


times = st.integers(-3 * S, 3 * S) | st.sampled_from([-(10**30), -1, 0, 1, 10**30, 10**400])


@settings(max_examples=30)
@given(asked=st.lists(times, max_size=20))
def test_asking_changes_nothing(walking: PreciseEstimator, asked: list[int]) -> None:
    """In whatever order, and however far from now."""
    alone = {offset: row(walking.predict(NOW_NS + offset)) for offset in sorted(asked)}
    assert [row(walking.predict(NOW_NS + offset)) for offset in asked] == [alone[offset] for offset in asked]


@pytest.mark.parametrize("name", NAMES)
def test_a_run_that_was_asked_goes_on_like_one_that_was_not(name: str) -> None:
    asked, silent = estimator(name), estimator(name)
    for index, measurement in enumerate(stream()):
        asked.step(measurement)
        silent.step(measurement)
        if index % 7 == 0:
            for offset_ns in (900 * MS, -300 * MS, 40 * MS):
                asked.predict(measurement.t_recv_ns + offset_ns)
    last_ns = stream()[-1].t_recv_ns
    assert row(asked.predict(last_ns)) == row(silent.predict(last_ns)) != ()


def test_there_is_none_before_the_start_nor_long_ago_nor_far_ahead(walking: PreciseEstimator) -> None:
    fresh = estimator()
    assert fresh.predict(0) is None
    fresh.step(stream()[0])
    assert fresh.predict(stream()[0].t_ns) is None
    for offset_ns in (-2100 * MS, -(10**30), 1100 * MS, 10**400):
        assert walking.predict(NOW_NS + offset_ns) is None
    for offset_ns in (-1900 * MS, -1000 * MS, 0, 900 * MS):
        _pose(walking, NOW_NS + offset_ns)


def test_they_go_on_smoothly(walking: PreciseEstimator) -> None:
    """From the past into the future, a millisecond a step: by the velocity, and by what is still being faded in."""
    poses = [_pose(walking, NOW_NS + offset * MS) for offset in range(-1500, 900)]
    for a, b in pairwise(poses):
        step_m = np.subtract(b.p_site_m, a.p_site_m)
        assert np.abs(step_m - 0.5e-3 * np.add(a.v_site_m_s, b.v_site_m_s)).max() < 5e-4
        assert np.linalg.norm(log(multiply(b.wxyz_site_body, conjugate(a.wxyz_site_body)))) < 5e-3


def test_what_is_shown_does_not_jump_when_a_measurement_is_taken() -> None:
    """Before and after each sample, for its own time; a fiftieth of a second of a correction's fading is in it."""
    one, jumps_m = estimator(), []
    for measurement in stream():
        if measurement.t_recv_ns > START_NS + 24 * S:
            break
        is_new = isinstance(measurement, ImuSample) and measurement.t_ns > START_NS + 14 * S
        before = one.predict(measurement.t_ns) if is_new else None
        one.step(measurement)
        if before is not None:
            after = _pose(one, measurement.t_ns)
            jumps_m.append(float(np.linalg.norm(np.subtract(after.p_site_m, before.p_site_m))))
    assert max(jumps_m) < 0.02
    assert len(jumps_m) > 400


def test_fifty_milliseconds_ahead_it_is_where_it_will_be() -> None:
    one, off_rad = estimator(), []
    samples = [m for m in stream() if isinstance(m, ImuSample) and m.t_ns > START_NS + 15 * S]
    ahead: dict[int, Pose] = {}
    for measurement in stream():
        one.step(measurement)
        if isinstance(measurement, ImuSample) and measurement.t_ns >= samples[0].t_ns:
            ahead[measurement.t_ns + 60 * MS] = _pose(one, measurement.t_ns + 60 * MS)
            if (guess := ahead.get(measurement.t_ns)) is not None:
                there = _pose(one, measurement.t_ns)
                off_rad.append(np.linalg.norm(log(multiply(there.wxyz_site_body, conjugate(guess.wxyz_site_body)))))
    assert np.sqrt(np.mean(np.square(off_rad))) < 0.01


def test_the_first_pose_is_where_the_first_fix_is() -> None:
    one, fixed_ns = estimator(), 0
    for measurement in stream():
        one.step(measurement)
        if isinstance(measurement, GpsFix) and not fixed_ns:
            fixed_ns = measurement.t_ns
        pose = one.predict(measurement.t_recv_ns)
        if pose is not None:
            truth = walk().at(np.array([pose.t_ns])).p_m[0]
            assert np.linalg.norm(np.subtract(pose.p_site_m, truth)[:2]) < 3.0 * np.linalg.norm(_sigmas(pose)[:2])
            assert np.linalg.norm(_sigmas(pose)[:2]) < 10.0
            break
    assert fixed_ns


def test_the_future_is_less_sure_than_the_present(walking: PreciseEstimator) -> None:
    """Sigma of every part grows beyond the newest sample, and north is not known for long."""
    newest_ns = max(m.t_ns for m in stream() if m.t_recv_ns <= NOW_NS and isinstance(m, ImuSample))
    poses = [_pose(walking, newest_ns + offset * MS) for offset in range(0, 1001, 100)]
    for a, b in pairwise(poses):
        assert np.all(_sigmas(b)[3:] > _sigmas(a)[3:])
    assert np.all(_sigmas(poses[-1])[:3] > _sigmas(poses[0])[:3] + 0.2)
    assert np.allclose(_sigmas(poses[1]), _sigmas(poses[0]), atol=0.02), "little is unforeseen in a tenth of a second"
    assert poses[0].heading_known
    assert not poses[-1].heading_known


def test_the_claimed_covariance_is_the_filter_s_carried_on(walking: PreciseEstimator) -> None:
    """Against samples of the filter's own errors, each carried on by itself."""
    rng, best = np.random.default_rng(3), walking._engine.best
    newest_ns = walking._free.newest_ns
    claimed = _pose(walking, newest_ns)
    nominal = walking._free.carry(best.nav, newest_ns)
    errors = []
    for error in rng.multivariate_normal(np.zeros(len(best.covariance)), best.covariance, 4000, method="eigh"):
        error[9:15] = 0.0  # biases take part in the free integral, not in what is carried by it
        moved = best.copied()
        moved.move(error)
        end = walking._free.carry(moved.nav, newest_ns)
        turned = log(multiply(end.wxyz_site_body, conjugate(nominal.wxyz_site_body)))
        errors.append([*np.subtract(end.p_m, nominal.p_m), *turned])
    turned = log(multiply(claimed.wxyz_site_body, conjugate(nominal.wxyz_site_body)))
    faded_in = np.array([*np.subtract(claimed.p_site_m, nominal.p_m), *turned])
    sigmas = np.sqrt(np.mean(np.square(errors), axis=0) + faded_in**2)
    assert _sigmas(claimed) == pytest.approx(sigmas, rel=0.05)
