"""Where a path lies in the site: white errors average out, old fixes are forgotten."""

import numpy as np
import pytest

from tracker.anchor import Anchor

S = 1_000_000_000


def test_the_first_fix_counts_wholly() -> None:
    anchor = Anchor(10.0)
    anchor.fix(0, (5.0, 6.0, 7.0), (1.0, 1.0, 1.0))
    assert anchor.offset_m == (4.0, 5.0, 6.0)


def test_early_fixes_count_alike() -> None:
    anchor = Anchor(1000.0)
    for t_s, x in enumerate((1.0, 2.0, 6.0)):
        anchor.fix(t_s * S, (x, 0.0, 0.0), (0.0, 0.0, 0.0))
    assert anchor.offset_m[0] == pytest.approx(3.0)


def test_white_errors_average_out_along_a_walk() -> None:
    """A metre of white error at each fix, a path without error: a third of a metre is left with ten seconds of memory."""
    rng, anchor, off_m = np.random.default_rng(1), Anchor(10.0), []
    for t_s in range(400):
        path = (1.2 * t_s, 0.0, 0.0)
        anchor.fix(t_s * S, (path[0] + 7.0 + rng.normal(), 0.0, 0.0), path)
        off_m.append(anchor.offset_m[0] - 7.0)
    assert 0.15 < float(np.std(off_m[50:])) < 0.33


def test_a_long_silence_forgets() -> None:
    anchor = Anchor(10.0)
    for t_s in range(20):
        anchor.fix(t_s * S, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
    anchor.fix(200 * S, (8.0, 0.0, 0.0), (0.0, 0.0, 0.0))
    assert anchor.offset_m[0] == pytest.approx(8.0, abs=0.01)


def test_forgetting_begins_anew() -> None:
    anchor = Anchor(1000.0)
    for t_s in range(9):
        anchor.fix(t_s * S, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
    anchor.forget()
    anchor.fix(10 * S, (8.0, 0.0, 0.0), (0.0, 0.0, 0.0))
    assert anchor.offset_m == (8.0, 0.0, 0.0)
