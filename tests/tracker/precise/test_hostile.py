"""What no sensor should send: refused and counted, without a trace; and whatever comes, no pose that is not finite."""

from collections import Counter
from math import inf, nan

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.tracker.precise.hostile import out_of_place, refused
from tests.tracker.precise.stream import S, estimator, feed, row, stream, walk
from tracker.geometry import matrix_from_wxyz, normalise
from tracker.measurements import (
    CompassHeading,
    GpsFix,
    GpsVelocity,
    ImuSample,
    MagSample,
    Measurement,
    Sighting,
    Standpoint,
    VisualMotion,
)
from tracker.pipeline import Pipeline
from tracker.precise.estimator import PreciseEstimator
from tracker.simulate import START_NS

MIDDLE_NS = START_NS + 20 * S


def test_what_is_refused_is_counted_and_leaves_no_trace() -> None:
    """Every fault there is, once a second, among the sane ones: the same poses, bit for bit."""
    clean, pipeline, counts = estimator(), Pipeline(estimator()), Counter[str]()
    due_ns, before = START_NS + 3 * S, stream()[0]
    for measurement in stream():
        if measurement.t_recv_ns >= due_ns:
            due_ns += S
            for bad, outcome in (*refused(measurement.t_recv_ns), *out_of_place(before)):
                assert pipeline.step(bad) is outcome, bad
                counts[outcome.value] += 1
        assert pipeline.step(measurement) is clean.step(measurement)
        before = measurement
    last_ns = stream()[-1].t_recv_ns
    assert row(pipeline.predict(last_ns)) == row(clean.predict(last_ns)) != ()
    assert pipeline.rejected == counts


# -- anything at all ----------------------------------------------------------------------------------------------------

anything = st.one_of(st.floats(allow_nan=True, allow_infinity=True), st.sampled_from([0.0, nan, inf, 1e30, -1e-300]))
_usual = st.floats(-3.0, 3.0)


def _numbers(scale: float) -> st.SearchStrategy[float]:
    return st.one_of(_usual.map(lambda x: scale * x), _usual.map(lambda x: scale * x), anything)


def _vector(scale: float) -> st.SearchStrategy[tuple[float, float, float]]:
    return st.tuples(_numbers(scale), _numbers(scale), _numbers(scale))


def _unit(vector: tuple[float, float, float]) -> tuple[float, float, float]:
    length = float(np.linalg.norm(vector)) if np.all(np.abs(vector) < 1e9) else 0.0
    return (vector[0] / length, vector[1] / length, vector[2] / length) if length > 1e-9 else (0.0, 0.0, 0.0)


def _rotation(vector: tuple[float, float, float]) -> np.ndarray[tuple[int, ...], np.dtype[np.float64]]:
    return matrix_from_wxyz(normalise((1.0, *_unit(vector))))


_soon = st.one_of(st.floats(-0.6, 0.3), st.sampled_from([0.0, 1.9, -30.0, 3600.0, -1e9, 1e9])).map(
    lambda s: round(s * S)
)
_ahead = st.sampled_from([0, 0, 0, 0, -S, 10**12])
_covariances = st.one_of(
    st.just((0.0,) * 9),
    st.floats(1e-3, 1e4).map(lambda v: (v, 0.0, 0.0, 0.0, v, 0.0, 0.0, 0.0, v)),
    st.tuples(*[anything] * 9),
)


@st.composite
def hostile(draw: st.DrawFn) -> tuple[int, Measurement]:
    """Return a measurement of any kind, stamped about the present; the present is zero."""
    late, kind = draw(_soon), draw(st.integers(0, 7))
    t = (MIDDLE_NS + late, MIDDLE_NS + late + draw(_ahead))
    match kind:
        case 0:
            return late, ImuSample(*t, draw(_vector(3.0)), draw(_vector(10.0)))
        case 1:
            where = draw(
                st.one_of(st.tuples(st.floats(37.936, 37.937), st.floats(27.34, 27.35)), st.tuples(anything, anything))
            )
            return late, GpsFix(*t, *where, draw(_numbers(50.0)), draw(_covariances))
        case 2:
            return late, GpsVelocity(*t, draw(_vector(1.0)))
        case 3:
            return late, MagSample(*t, draw(_vector(2e-5)))
        case 4:
            return late, CompassHeading(*t, draw(_numbers(1.0)))
        case 5:
            key_ns = MIDDLE_NS + draw(_soon) // S * S
            direction = draw(st.one_of(_vector(1.0).map(_unit), _vector(1.0)))
            R_key_cam = _rotation(draw(_vector(1.0)))
            return late, VisualMotion(*t, 0, key_ns, R_key_cam, direction, 50, draw(_numbers(5.0)), draw(st.booleans()))
        case 6:
            x, y, z = walk().at(np.array([MIDDLE_NS])).p_m[0].tolist()
            point = draw(st.one_of(st.just((x, y, z)), _vector(20.0)))
            return late, Sighting(*t, point, draw(_vector(1.0).map(_unit)), draw(_numbers(0.01)))
    return late, Standpoint(*t, draw(_vector(20.0)), draw(_numbers(1.0)))


@pytest.fixture(scope="module")
def walked() -> PreciseEstimator:
    """In the middle of the walk."""
    one = estimator()
    feed(one, (m for m in stream() if m.t_recv_ns < MIDDLE_NS))
    return one


@pytest.fixture(scope="module")
def start(walked: PreciseEstimator) -> object:
    """Of it, to begin from again and again."""
    return walked.snapshot()


@settings(max_examples=30)
@given(st.lists(hostile(), max_size=12))
def test_whatever_comes_no_pose_is_not_finite(start: object, bad: list[tuple[int, Measurement]]) -> None:
    """And none raises. Each arrives when it was measured, or at once."""
    one = estimator()
    one.restore(start)
    later = [(m.t_recv_ns - MIDDLE_NS, m) for m in stream() if MIDDLE_NS <= m.t_recv_ns < MIDDLE_NS + 2 * S]
    for _, measurement in sorted([*later, *bad], key=lambda pair: pair[0]):
        one.step(measurement)
        for t_ns in (measurement.t_ns, one._free.newest_ns, MIDDLE_NS):
            pose = one.predict(t_ns)
            if pose is not None:
                numbers = (*pose.p_site_m, *pose.wxyz_site_body, *pose.v_site_m_s)
                assert np.all(np.isfinite(numbers))
                assert np.all(np.isfinite(pose.cov))
                assert np.linalg.eigvalsh(pose.cov).min() > 0.0
