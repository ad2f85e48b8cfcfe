"""What is refused whatever the state: each fault by its own reason, and nothing that is sane."""

from dataclasses import replace

import pytest

from tests.tracker.precise.hostile import Case, S, refused, sane
from tracker.measurements import GpsFix, Measurement, VisualMotion
from tracker.precise.refusal import refusal

T = 1_700_000_000 * S


@pytest.mark.parametrize("case", refused(T), ids=lambda case: type(case[0]).__name__)
def test_a_fault_is_named(case: Case) -> None:
    measurement, outcome = case
    assert refusal(measurement) is outcome


@pytest.mark.parametrize("measurement", [*sane(T).values(), *sane(-(10**30)).values()], ids=lambda m: type(m).__name__)
def test_what_is_sane_passes(measurement: Measurement) -> None:
    assert refusal(measurement) is None


def test_a_receiver_may_state_no_covariance_and_a_picture_no_direction() -> None:
    fix, vision = sane(T)["fix"], sane(T)["vision"]
    assert isinstance(fix, GpsFix)
    assert isinstance(vision, VisualMotion)
    assert refusal(replace(fix, cov_enu_m2=(0.0,) * 9)) is None
    assert refusal(replace(vision, direction_key=(0.0, 0.0, 0.0), parallax_px=0.0)) is None
