"""The ground of the simulated walks: gentle hills and flights of steps, added to what a site has; and how well it is known."""

from dataclasses import dataclass

import numpy as np

from tracker.gait import Ground
from tracker.measurements import Matrix
from tracker.precise.ground import EyeHeight

STEP_M, TREAD_M, STEPS = 0.17, 0.4, 3
#: Flights rise west of this easting and north of this northing, each to a terrace of its own.
FLIGHT_E_M, FLIGHT_N_M = -40.0, -12.0
#: A surveyed surface is off by this much, in waves of this length.
SURVEY_M, SURVEY_WAVE_M = 0.03, 23.0
EYE_HEIGHT_M = 1.65
#: A visitor's eyes are not at the height that the estimator is told: standard deviation.
EYE_HEIGHT_SIGMA_M = 0.05


def hills_m(e_m: Matrix, n_m: Matrix) -> Matrix:
    """Return (n,) heights above the site's own ground: slopes up to a seventh, and two flights of three steps."""
    smooth = 1.2 * np.sin(2 * np.pi * (e_m / 63.0 + n_m / 200.0) + 0.3) + 0.8 * np.sin(
        2 * np.pi * (n_m / 41.0 - e_m / 160.0) + 1.1
    )
    return np.asarray(smooth + _flight(FLIGHT_E_M - e_m) + _flight(n_m - FLIGHT_N_M))


def _flight(up_m: Matrix) -> Matrix:
    return np.asarray(STEP_M * np.clip(np.floor(up_m / TREAD_M) + 1.0, 0.0, STEPS))


@dataclass(frozen=True)
class Hills:
    """A site's ground with hills on it."""

    below_z_m: Ground

    def ground_z_m(self, e_m: Matrix, n_m: Matrix) -> Matrix:
        """Return heights (n,)."""
        return np.asarray(self.below_z_m(e_m, n_m) + hills_m(e_m, n_m))

    def eyes_z_m(self) -> EyeHeight:
        """Return what an estimator is told: the eyes' usual height above a ground that was surveyed with small errors."""

        def told(east_m: float, north_m: float) -> float:
            ground_m = float(self.ground_z_m(np.array([east_m]), np.array([north_m]))[0])
            turn = 2.0 * np.pi / SURVEY_WAVE_M
            off_m = SURVEY_M * float(np.sin(turn * east_m) + np.cos(turn * north_m))
            return ground_m + off_m + EYE_HEIGHT_M

        return told
