"""A small trace with round numbers, for the tests of figures."""

from dataclasses import replace

import numpy as np

from server.plots.trace import Trace
from tracker.simulate import AGORA_ORIGIN


def trace(estimator: str = "gps-imu/famm", off_m: float = 2.0, n: int = 200) -> Trace:
    """Return a walk east at 1 m/s over n / 5 seconds, drawn `off_m` too far north, whose yaw is 3 degrees too far left."""
    t_s = np.arange(n) / 5.0
    truth = np.stack([t_s, np.zeros(n), np.full(n, 1.65)], axis=1)
    angles = np.zeros((n, 3))
    updates = np.arange(0.0, t_s[-1], 0.25)
    sigma = np.diag([4.0] * 3 + [1.0] * 3 + [1e-4] * 3 + [1e-2] * 3)
    return Trace(
        log="walk",
        estimator=estimator,
        origin=AGORA_ORIGIN,
        t_s=t_s,
        p_site_m=truth + np.array([0.0, off_m, 0.0]),
        rpy_rad=angles + np.array([0.0, 0.0, np.radians(3.0)]),
        model=np.array(["P0R0"] * (n // 4) + ["P1R1"] * (n - n // 4)),
        truth_p_site_m=truth,
        truth_rpy_rad=angles,
        update_t_s=updates,
        update_m=np.full(len(updates), 0.5),
        update_rad=np.full(len(updates), 0.01),
        update_model=np.array(["P0R0"] * (len(updates) // 4) + ["P1R1"] * (len(updates) - len(updates) // 4)),
        fix_t_s=t_s[::5],
        fix_site_m=truth[::5] + 1.0,
        state_covariance=sigma,
    )


def without_truth(known: Trace) -> Trace:
    """Return the same where nobody knows the truth."""
    return replace(
        known,
        truth_p_site_m=np.full_like(known.truth_p_site_m, np.nan),
        truth_rpy_rad=np.full_like(known.truth_rpy_rad, np.nan),
    )


def without_updates(known: Trace) -> Trace:
    """Return the same of a filter that makes no measurements of the paper's kind, and has no state covariance of its kind."""
    none = np.zeros(0)
    return replace(
        known,
        update_t_s=none,
        update_m=none,
        update_rad=none,
        update_model=none.astype(str),
        state_covariance=np.zeros((0, 0)),
    )
