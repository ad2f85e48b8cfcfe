"""What the filter is told of a receiver is what that receiver is."""

import numpy as np
import pytest

from tests.benchmarks.accuracy import receiver
from tests.benchmarks.accuracy.told import STUDIED, settings_of


def test_it_knows_the_studys_receiver() -> None:
    precise = STUDIED.precise
    assert precise.gps_error_s[:2] == receiver.SLOW_S
    variances = np.array(precise.gps_error_share) * receiver.claimed_m()[0] ** 2
    assert np.sqrt(variances[:2]) == pytest.approx(receiver.SLOW_M, rel=1e-3)
    assert np.sqrt(receiver.claimed_m()[0] ** 2 - variances.sum()) == pytest.approx(receiver.WHITE_M, rel=1e-3)
    assert precise.gps_inflation == 1.0


def test_an_understated_sigma_is_made_good() -> None:
    assert settings_of((20.0,), (1.0,), 0.3, 0.1, understated=1.5).precise.gps_inflation == 2.25


def test_nothing_but_the_receiver_is_told() -> None:
    """And that it corrects in full; how still it stands is not asked."""
    told, usual = (vars(settings.precise) for settings in (STUDIED, type(STUDIED)()))
    changed = {name for name in usual if told[name] != usual[name]}
    receivers = {"gps_error_s", "gps_error_share", "gps_inflation", "gps_velocity_sigma_m_s"}
    assert changed == receivers | {"settled_share"}
