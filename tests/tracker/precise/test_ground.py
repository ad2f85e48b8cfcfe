"""Which ground a rig stands on: the one below it, the one beside it where a step is near, or none."""

from math import inf

import pytest

from tracker.precise.ground import standing_z_m

EYES_M = 1.65


def terrace(east_m: float, north_m: float) -> float:
    """Return the eyes' height over a square with a terrace of 0.9 m east of 10 m, which ends at 20 m."""
    if east_m > 20.0:
        return inf
    return EYES_M + (0.9 if east_m > 10.0 else 0.0)


def test_a_height_that_is_off_by_what_it_may_be_is_that_of_the_ground_below() -> None:
    assert standing_z_m(terrace, (0.0, 3.0, EYES_M + 0.4), 1.0, 0.5) == EYES_M
    assert standing_z_m(terrace, (12.0, 3.0, EYES_M + 0.6), 1.0, 0.5) == EYES_M + 0.9


@pytest.mark.parametrize(("east_m", "up_m", "ground_m"), [(10.8, 0.1, 0.0), (9.2, 0.8, 0.9), (20.8, 0.8, 0.9)])
def test_at_a_step_the_height_tells_the_side(east_m: float, up_m: float, ground_m: float) -> None:
    """The estimate is off by less than it may be, over the edge or past the end."""
    assert standing_z_m(terrace, (east_m, 0.0, EYES_M + up_m), 1.0, 0.5) == EYES_M + ground_m


@pytest.mark.parametrize("p_site_m", [(0.0, 0.0, EYES_M + 0.6), (12.0, 0.0, EYES_M), (25.0, 0.0, EYES_M + 0.9)])
def test_off_the_ground_nothing_is_said(p_site_m: tuple[float, float, float]) -> None:
    """On something that nobody told of, with the step too far away; and where nobody can stand."""
    assert standing_z_m(terrace, p_site_m, 1.0, 0.5) is None
