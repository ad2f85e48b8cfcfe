"""The error-state filter: a nominal state, and the covariance of what it may be off by.

Its layout, and how it grows: `tracker/precise/error_model.py`.

Reference:
    Sola, Quaternion kinematics for the error-state Kalman filter, 2017, chapter 7 (global angular error).
    Roumeliotis and Burdick, Stochastic cloning, 2002.
"""

from collections.abc import Callable
from dataclasses import dataclass
from math import hypot

import numpy as np

from tracker.geometry import conjugate, matrix_from_wxyz, multiply, normalise
from tracker.geometry import exp as rotation_exp
from tracker.geometry import log as log_rotation
from tracker.measurements import Matrix, Vector3
from tracker.precise.error_model import (
    BG,
    FORGETTING,
    GPS_ERROR,
    GYRO_AXES,
    MAGNETIC,
    SIZE,
    THETA,
    P,
    ProcessNoise,
    V,
    inertial_transition,
    skew,
    skews,
)
from tracker.precise.navigation import Biases, Navigation, advance
from tracker.precise.settings import PreciseSettings
from tracker.precise.update import Blocks, Correction, Observation, dense, joseph, log_likelihood

_INERTIAL, _MOTION = slice(0, 15), slice(0, 9)
#: Of a position that is not known. The first fix then splits it with the receiver's error as it should be.
_UNKNOWN_M2 = 1e4
#: Covariance is carried on in steps of about this long: attitude hardly turns within one.
_CHUNK_S = 0.02

_ITERATIONS = 5
#: Yaw, and the bias, scale and lean of the gyroscope's z.
_NORTH = [THETA.stop - 1, BG.stop - 1, *range(GYRO_AXES.stop - 3, GYRO_AXES.stop)]


@dataclass
class Clone:
    """A held picture's body pose."""

    t_ns: int
    p_m: Vector3
    R_site_body: Matrix
    wxyz_site_body: tuple[float, float, float, float]


class ErrorState:
    """One filter, at one time."""

    def __init__(
        self,
        settings: PreciseSettings,
        nav: Navigation,
        biases: Biases,
        covariance: Matrix,
        gravity_m_s2: float,
        earth_rad_s: Vector3 = (0.0, 0.0, 0.0),
    ) -> None:
        """`covariance` is (34, 34), without clones; `earth_rad_s` how the site turns, which the gyroscope feels."""
        self.settings = settings
        self.nav = nav
        self.biases = biases
        self.covariance = covariance
        self.gps_error = np.zeros(9)
        self.gps_sigma_m: Vector3 | None = None
        """In units of which the receiver's error is; None until a receiver has claimed something."""
        self.magnetic_rad = 0.0
        self.clones: list[Clone] = []
        self._gravity = gravity_m_s2
        self.earth_rad_s = earth_rad_s
        self.noise = ProcessNoise(settings)
        self.restart_chunk()

    # -- prediction ---------------------------------------------------------------------------------------------------

    def advance(self, t_ns: int, gyro_rad_s: Vector3, accel_m_s2: Vector3) -> None:
        """Carry the nominal state on to t_ns; the covariance follows when a chunk is full, or an update needs it."""
        self.nav = advance(self.nav, t_ns, gyro_rad_s, accel_m_s2, self.biases, self._gravity)
        if t_ns - self._chunk_nav.t_ns >= _CHUNK_S * 1e9:
            self.settle()

    def restart_chunk(self) -> None:
        """Begin a new step of the covariance at the present nominal state, after that was changed."""
        self._chunk_nav = self.nav
        self._chunk_R = matrix_from_wxyz(self.nav.wxyz_site_body)

    def settle(self) -> None:
        """Bring the covariance to the nominal state's time."""
        start, end = self._chunk_nav, self.nav
        dt = (end.t_ns - start.t_ns) * 1e-9
        if dt <= 0.0:
            return
        R_end = matrix_from_wxyz(end.wxyz_site_body)
        gained = np.array(end.v_m_s) - np.array(start.v_m_s)
        gained[2] += self._gravity * dt
        R_mean = 0.5 * (self._chunk_R + R_end)
        Phi = inertial_transition(dt, R_mean, gained)
        cov = self.covariance
        cov[_INERTIAL, _INERTIAL] = Phi @ cov[_INERTIAL, _INERTIAL] @ Phi.T
        cov[_INERTIAL, 15:] = Phi @ cov[_INERTIAL, 15:]
        cov[15:, _INERTIAL] = cov[_INERTIAL, 15:].T
        keep = self.noise.kept(dt)
        cov[FORGETTING, :] *= keep[:, None]
        cov[:, FORGETTING] *= keep
        cov[_DIAGONAL] += self.noise.added(dt)
        turned = log_rotation(multiply(end.wxyz_site_body, conjugate(start.wxyz_site_body)))
        self._lean(R_mean, turned, gained, dt)
        index = np.arange(3)
        cov[6 + index, 6 + index] += (self.settings.gyro_scale * hypot(*turned)) ** 2
        shaken = np.array(end.v_m_s) - np.array(start.v_m_s)
        cov[3 + index, 3 + index] += (self.settings.accel_scale * float(np.linalg.norm(shaken))) ** 2
        half = 0.5 * self.noise.velocity * dt * dt
        cov[_P_V] += half
        cov[_V_P] += half
        self.gps_error = keep[:9] * self.gps_error
        self.magnetic_rad *= float(keep[9])
        self.nav = _turned_back(end, self.earth_rad_s, dt)
        self._chunk_nav, self._chunk_R = self.nav, R_end

    def _lean(self, R_site_body: Matrix, turned_rad: Vector3, gained_m_s: Matrix, dt_s: float) -> None:
        """Add to the motion what the gyroscope's axes are unsure of; `turned_rad` is in site."""
        turned_body = R_site_body.T @ turned_rad
        told = turned_body + np.array(self.biases.gyro_axes) @ turned_body
        turn = -np.outer(R_site_body, told).reshape(3, 9)
        bent = skew(gained_m_s) @ turn
        by_axes = np.concatenate([-dt_s / 6.0 * bent, -0.5 * bent, turn])
        cov = self.covariance
        cov[_MOTION, :] += by_axes @ cov[GYRO_AXES, :]
        cov[:, _MOTION] += cov[:, GYRO_AXES] @ by_axes.T

    # -- update -------------------------------------------------------------------------------------------------------

    def correct(
        self,
        residual: Matrix,
        blocks: Blocks,
        noise: Matrix,
        *,
        gated: bool = True,
        gate_nis: float | None = None,
        tells_north: bool = True,
        is_relative: bool = False,
        share: float = 1.0,
    ) -> Correction:
        """Take a measurement in, in Joseph's form.

        Args:
            residual: (m,) measured minus predicted.
            blocks: Columns of H that are not zero, each (m, width of the slice).
            noise: (m, m) covariance of the measurement.
            gated: Whether what lies far out counts for less, and further out for nothing.
            gate_nis: What lies further out than this counts for less, and the less the further; None for the settings'.
            tells_north: Whether it may tell yaw, now and of what is held, and what is wrong with the gyroscope's z; else their
                doubt is taken into account, and they stay as they are.
            is_relative: Whether it would be the same if all places and attitudes were turned as one (see `_turn_doubts`).
            share: By how much of what is most likely all is moved but the receiver's error.

        Reference:
            Schmidt, Application of state-space methods to navigation problems, 1966 (considered states).
        """
        self.settle()
        m, cov = len(residual), self.covariance
        H = dense(blocks, m, len(cov))
        PHt = cov @ H.T
        foreseen = H @ PHt
        nis = float(residual @ np.linalg.solve(foreseen + noise, residual)) / m
        gate_nis = gate_nis or self.settings.gate_nis
        if gated and nis > gate_nis:
            if nis > self.settings.reject_nis:
                return Correction(nis, -0.5 * m * self.settings.reject_nis, used=False)
            noise = noise * (nis / gate_nis) + foreseen * (nis / gate_nis - 1.0)
        S = foreseen + noise
        K = np.asarray(np.linalg.solve(S, PHt.T).T, np.float64)
        if not tells_north:
            K[_NORTH] = 0.0
            K[SIZE + 5 :: 6] = 0.0
        if share < 1.0:
            receiver = K[GPS_ERROR].copy()
            K *= share
            K[GPS_ERROR] = receiver
        self.covariance, error = joseph(cov, K, H, noise), K @ residual
        if is_relative:
            self._turn_doubts(error)
        self.move(error)
        return Correction(nis, log_likelihood(min(nis, self.settings.reject_nis), S), used=True)

    def correct_far(self, observe: Callable[["ErrorState"], Observation], noise: Matrix) -> Correction:
        """Take in a measurement that may move the state far, unless it is out of the question.

        Its Jacobian is taken again where it leads to.

        Reference:
            Bell and Cathey, The iterated Kalman filter update as a Gauss-Newton method, 1993.
        """
        prior = self.copied()
        cov, error = prior.covariance, np.zeros(len(self.covariance))
        for _ in range(_ITERATIONS):
            at = prior.copied()
            at.move(error)
            residual, blocks = observe(at)
            H = dense(blocks, len(residual), len(cov))
            S = H @ cov @ H.T + noise
            K = np.asarray(np.linalg.solve(S, H @ cov).T, np.float64)
            error = K @ (residual + H @ error)
        first, _ = observe(prior)
        nis = float(first @ np.linalg.solve(S, first)) / len(first)
        if nis > self.settings.reject_nis:
            return Correction(nis, -0.5 * len(first) * self.settings.reject_nis, used=False)
        self.covariance = joseph(cov, K, H, noise)
        self.move(error)
        return Correction(nis, log_likelihood(nis, S), used=True)

    def move(self, error: Matrix) -> None:
        """Move the nominal state by an error."""
        e = error.tolist()
        (px, py, pz), (vx, vy, vz) = self.nav.p_m, self.nav.v_m_s
        q = normalise(multiply(rotation_exp((e[6], e[7], e[8])), self.nav.wxyz_site_body))
        self.nav = Navigation(self.nav.t_ns, (px + e[0], py + e[1], pz + e[2]), (vx + e[3], vy + e[4], vz + e[5]), q)
        (gx, gy, gz), (ax, ay, az) = self.biases.gyro_rad_s, self.biases.accel_m_s2
        (a, b, c), (d, f, g), (h, i, j) = self.biases.gyro_axes
        m = e[GYRO_AXES]
        axes = ((a + m[0], b + m[1], c + m[2]), (d + m[3], f + m[4], g + m[5]), (h + m[6], i + m[7], j + m[8]))
        self.biases = Biases((gx + e[9], gy + e[10], gz + e[11]), (ax + e[12], ay + e[13], az + e[14]), axes)
        self.gps_error = self.gps_error + error[GPS_ERROR]
        self.magnetic_rad += e[MAGNETIC]
        for index, clone in enumerate(self.clones):
            d = e[SIZE + 6 * index : SIZE + 6 * index + 6]
            clone_q = normalise(multiply(rotation_exp((d[3], d[4], d[5])), clone.wxyz_site_body))
            p = (clone.p_m[0] + d[0], clone.p_m[1] + d[1], clone.p_m[2] + d[2])
            self.clones[index] = Clone(clone.t_ns, p, matrix_from_wxyz(clone_q), clone_q)
        self.restart_chunk()

    def _turn_doubts(self, error: Matrix) -> None:
        """Let what all share of the doubt of attitude turn places and velocities as they will be after a move by `error`.

        A filter that forgets this believes after some pictures that these have told it north.

        Reference:
            Barrau and Bonnabel, An EKF-SLAM algorithm with consistency properties, 2015 (right-invariant error).
        """
        cov, clones = self.covariance, SIZE + 6 * np.arange(len(self.clones))
        moved = np.concatenate([[P.start, V.start], clones])[:, None] + np.arange(3)
        turned = np.concatenate([[THETA.start, THETA.start], clones + 3])[:, None] + np.arange(3)
        by_turn = -skews(error[moved])
        cov[moved] += by_turn @ cov[turned]
        cov[:, moved] += np.einsum("inj,nkj->ink", cov[:, turned], by_turn)

    # -- clones -------------------------------------------------------------------------------------------------------

    def hold(self, most: int) -> None:
        """Remember the present pose for pictures to come; the oldest beyond `most` is forgotten."""
        self.settle()
        while len(self.clones) >= most:
            self.forget(0)
        rows = [0, 1, 2, 6, 7, 8]
        cov, n = self.covariance, len(self.covariance)
        grown = np.empty((n + 6, n + 6))
        grown[:n, :n] = cov
        grown[n:, :n] = cov[rows, :]
        grown[:n, n:] = cov[:, rows]
        grown[n:, n:] = cov[np.ix_(rows, rows)]
        self.covariance = grown
        q = self.nav.wxyz_site_body
        self.clones.append(Clone(self.nav.t_ns, self.nav.p_m, matrix_from_wxyz(q), q))

    def forget(self, index: int) -> None:
        """Drop a clone."""
        at = SIZE + 6 * index
        keep = np.r_[0:at, at + 6 : len(self.covariance)]
        self.covariance = self.covariance[np.ix_(keep, keep)]
        del self.clones[index]

    # -- whole-state changes ------------------------------------------------------------------------------------------

    def place(self, p_site_m: Vector3, *, forget_receiver: bool = True) -> None:
        """Begin anew at a position of which nothing is known yet; what is known of velocity and attitude stays."""
        self.settle()
        while self.clones:  # they are where nobody believes to have been any more
            self.forget(0)
        cov = self.covariance
        cov[P, :] = 0.0
        cov[:, P] = 0.0
        cov[P, P] = _UNKNOWN_M2 * np.eye(3)
        if forget_receiver:
            cov[GPS_ERROR, :] = 0.0
            cov[:, GPS_ERROR] = 0.0
            cov[GPS_ERROR, GPS_ERROR] = np.diag(self.noise.receiver[0])
            self.gps_error = np.zeros(9)
        self.nav = self.nav._replace(p_m=p_site_m)
        self.restart_chunk()

    def copied(self) -> "ErrorState":
        """Return a copy that shares nothing that changes."""
        self.settle()
        copy = ErrorState(self.settings, self.nav, self.biases, self.covariance.copy(), self._gravity, self.earth_rad_s)
        copy.noise.receiver = self.noise.receiver
        copy.gps_error, copy.gps_sigma_m = self.gps_error.copy(), self.gps_sigma_m
        copy.magnetic_rad, copy.clones = self.magnetic_rad, list(self.clones)
        return copy

    @property
    def R_site_body(self) -> Matrix:
        """(3, 3)."""
        return matrix_from_wxyz(self.nav.wxyz_site_body)


def _turned_back(nav: Navigation, earth_rad_s: Vector3, dt_s: float) -> Navigation:
    """Return a state less what the site itself has turned (Coriolis's 0.2 mm/s² of who walks is left out)."""
    x, y, z = earth_rad_s
    turned = multiply((1.0, -0.5 * x * dt_s, -0.5 * y * dt_s, -0.5 * z * dt_s), nav.wxyz_site_body)
    return nav._replace(wxyz_site_body=normalise(turned))


_DIAGONAL = (np.arange(SIZE), np.arange(SIZE))
_P_V = (np.arange(3), np.arange(3, 6))
_V_P = (np.arange(3, 6), np.arange(3))
