"""What is believed of a receiver's error, where it becomes another than what it was: in which units, how quick, how large."""

import numpy as np

from tracker.measurements import Matrix, Vector3
from tracker.precise.error_model import GPS_ERROR
from tracker.precise.error_state import ErrorState

_INDEX = np.arange(GPS_ERROR.start, GPS_ERROR.stop)
_QUICKEST, _QUICK = _INDEX[:3], _INDEX[:6]
_NOTHING = np.zeros(9)


def restate(state: ErrorState, sigma_m: Vector3, forgotten: Matrix = _NOTHING) -> None:
    """Tell the error in units of another sigma from now on: in metres it is what it was.

    Args:
        state: A filter.
        sigma_m: What it is told in from now on.
        forgotten: (9,) variances of the error that are not known in metres, but only as a share of what is claimed.
    """
    before_m, state.gps_sigma_m = state.gps_sigma_m, sigma_m
    if before_m is None or before_m == sigma_m:
        return
    state.settle()
    by = np.tile(np.divide(before_m, sigma_m), 3)
    state.covariance[GPS_ERROR, :] *= by[:, None]
    state.covariance[:, GPS_ERROR] *= by
    state.covariance[_INDEX, _INDEX] += forgotten * (1.0 - by**2)
    state.gps_error = by * state.gps_error


def believe(state: ErrorState, shares_and_times: Matrix) -> None:
    """Take the errors to be of these (see `ProcessNoise.receiver`) from now on; what is known of now is slow then.

    Were the shorter errors only made smaller, those of now would fade within seconds, and with them the doubt of the place.
    """
    state.settle()
    all_slow = np.zeros((9, 9))
    all_slow[6:] = np.hstack([np.eye(3)] * 3)
    cov = state.covariance
    cov[GPS_ERROR, :] = all_slow @ cov[GPS_ERROR, :]
    cov[:, GPS_ERROR] = cov[:, GPS_ERROR] @ all_slow.T
    cov[_QUICK, _QUICK] = shares_and_times[0, :6]
    state.gps_error = all_slow @ state.gps_error
    state.noise.receiver = shares_and_times


def doubt(state: ErrorState, variances: Matrix) -> None:
    """Let the quickest error be another one from now on: add (3,) variances, in units of what is claimed."""
    state.settle()
    state.covariance[_QUICKEST, _QUICKEST] += variances
