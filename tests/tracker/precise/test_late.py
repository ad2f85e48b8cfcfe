"""What was measured counts, not when it arrived: late and shuffled measurements end in the same pose, bit for bit."""

from collections import Counter
from collections.abc import Callable, Iterable
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.tracker.precise.stream import NAMES, S, estimator, row, stream
from tracker.measurements import GpsFix, GpsVelocity, ImuSample, Measurement, Outcome, VisualMotion
from tracker.precise.settings import PreciseSettings
from tracker.simulate import START_NS

LAG_NS = round(PreciseSettings().lag_s * S)
Delay = Callable[[np.random.Generator, Measurement], float]


def _delayed(measurements: Iterable[Measurement], delay_ns: Callable[[Measurement], int]) -> list[Measurement]:
    """Return them with other times of arrival, in that order."""
    late = [replace(m, t_recv_ns=m.t_ns + delay_ns(m)) for m in measurements]
    return sorted(late, key=lambda m: m.t_recv_ns)


def _end(name: str, measurements: Iterable[Measurement]) -> tuple[tuple[object, ...], Counter[Outcome]]:
    """Return the last pose, and what was said of the measurements."""
    one = estimator(name)
    outcomes = Counter(one.step(m) for m in measurements)
    return row(one.predict(max(m.t_ns for m in stream()))), outcomes


@pytest.fixture(scope="module")
def ordered() -> dict[str, tuple[object, ...]]:
    """The last pose where nothing is late."""
    return {name: _end(name, _delayed(stream(), lambda m: 0))[0] for name in NAMES}


DELAYS: dict[str, Delay] = {
    "any": lambda rng, m: rng.uniform(),
    "none or all": lambda rng, m: float(rng.integers(0, 2)),
    "only inertial samples": lambda rng, m: rng.uniform() if isinstance(m, ImuSample) else 0.0,
    "none of the inertial samples": lambda rng, m: 0.0 if isinstance(m, ImuSample) else rng.uniform(),
    "all inertial samples": lambda rng, m: 1.0 if isinstance(m, ImuSample) else 0.0,
}


@settings(max_examples=2)
@given(seed=st.integers(0, 2**32))
@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("which", DELAYS)
def test_shuffled_arrivals_end_in_the_same_pose(
    ordered: dict[str, tuple[object, ...]], name: str, which: str, seed: int
) -> None:
    """Delayed by up to the lag, its end included; landmarks, places and pictures among them."""
    rng = np.random.default_rng(seed)
    arrivals = _delayed(stream(), lambda m: round(LAG_NS * DELAYS[which](rng, m)))
    assert arrivals != list(stream())
    end, outcomes = _end(name, arrivals)
    assert end == ordered[name] != ()
    assert set(outcomes) <= {Outcome.USED, Outcome.WAITING, Outcome.IGNORED}


def test_what_is_too_late_is_counted_and_leaves_no_trace() -> None:
    """A receiver that takes 0.6 s to answer is not heard; one that takes just the lag is."""
    receiver = (GpsFix, GpsVelocity)
    since = [m for m in stream() if m.t_ns > START_NS + 10 * S and isinstance(m, receiver)]

    def answered_after(delay_ns: int) -> tuple[tuple[object, ...], Counter[Outcome]]:
        late = _delayed(stream(), lambda m: delay_ns if m in since else 0)
        return _end(NAMES[0], late)

    in_time, outcomes = answered_after(LAG_NS)
    assert outcomes[Outcome.REJECTED_STALE] == 0
    too_late, outcomes = answered_after(LAG_NS + S // 10)
    # the last ones come after the last inertial sample, and so are not known to be late
    assert len(since) - 2 <= outcomes[Outcome.REJECTED_STALE] <= len(since)
    without, _ = _end(NAMES[0], _delayed([m for m in stream() if m not in since], lambda m: 0))
    assert too_late == without != in_time


def test_one_that_comes_within_the_lag_and_one_that_comes_after_it() -> None:
    """To the nanosecond, beside inertial samples that are not late."""
    one = estimator(NAMES[0])
    samples = [m for m in stream() if isinstance(m, ImuSample)]
    for sample in samples[:200]:
        one.step(sample)
    newest_ns = samples[199].t_ns
    oldest_ns = min(m.t_ns for m in samples if m.t_ns >= newest_ns - LAG_NS)
    before_ns = max(m.t_ns for m in samples if m.t_ns < newest_ns - LAG_NS)
    assert one.step(GpsVelocity(oldest_ns, newest_ns, (0.0, 0.0, 0.0))) is Outcome.USED
    assert one.step(GpsVelocity(before_ns + 1, newest_ns, (0.0, 0.0, 0.0))) is Outcome.USED
    assert one.step(GpsVelocity(before_ns, newest_ns, (0.0, 0.0, 0.0))) is Outcome.REJECTED_STALE


def test_pictures_hold_what_they_are_measured_against() -> None:
    """So that the shuffle above shuffles something: without pictures the pose is another."""
    blind = _end(NAMES[1], [m for m in stream() if not isinstance(m, VisualMotion)])[0]
    assert blind != _end(NAMES[1], stream())[0]
