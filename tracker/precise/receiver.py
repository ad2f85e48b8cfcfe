"""What the filter makes of a receiver: how far its fixes and velocities are believed, and who is right where they disagree."""

from math import hypot

import numpy as np

from tracker.geodesy import SiteFrame
from tracker.measurements import GpsFix, GpsVelocity, Vector3
from tracker.precise import observations, receiver_error
from tracker.precise.claims import Claims, claimed_m
from tracker.precise.doubt import Doubt
from tracker.precise.error_state import ErrorState
from tracker.precise.evenness import Evenness
from tracker.precise.hypotheses import Hypotheses
from tracker.precise.insistence import Insistence
from tracker.precise.leaps import Leaps
from tracker.precise.memory import Memory, forgotten
from tracker.precise.settings import PreciseSettings
from tracker.precise.update import Correction

#: Who has been so far from where the receiver was first has walked: then motion tells north.
_WALKED_M = 6.0
#: A receiver that was silent for longer than its usual second leaves the filter blind.
_BLIND_NS = 2_500_000_000


class Receiver:
    """The antenna on its rig, and all that is remembered of what it told."""

    def __init__(
        self, settings: PreciseSettings, site: SiteFrame, lever_body_m: Vector3, memory: Memory | None = None
    ) -> None:
        """`lever_body_m` is where the antenna is in the body; `memory` what the filter began with."""
        self._settings, self._site, self._lever_m = settings, site, lever_body_m
        self.fix_ns: int | None = None
        """Of the last fix taken in."""
        self._velocity_ns = -_BLIND_NS
        self._insistence = Insistence(settings.insist)
        self._evenness = Evenness(settings)
        self._doubt = Doubt(settings)
        self._leaps = Leaps()
        self._claims = Claims()
        self._memory = memory
        self._first_fix_m: Vector3 | None = None
        self._has_walked = False

    def is_blind(self, t_ns: int) -> bool:
        """Whether it has been silent for longer than its usual second."""
        return self.fix_ns is None or t_ns - self.fix_ns > _BLIND_NS

    def may_tell_north(self, filter_: ErrorState) -> bool:
        """Whether standing and fixes may: of a rig that has not walked they would tell something, a little, again and again."""
        return self._has_walked or float(filter_.covariance[8, 8]) < self._settings.heading_known_rad**2

    def place(self, hypotheses: Hypotheses, fix: GpsFix) -> None:
        """Begin at a first fix, of which the receiver's own error is left open."""
        for filter_ in hypotheses.filters:
            filter_.place(self._place_of(fix), forget_receiver=False)
            if self._memory is not None:
                unknown = forgotten(self._memory, fix.t_ns, self._settings)
                receiver_error.restate(filter_, claimed_m(fix, self._settings), unknown)

    def take_fix(self, hypotheses: Hypotheses, fix: GpsFix, walked_m: Vector3) -> None:
        """Correct by a fix; one that is refused again and again is believed after all.

        Args:
            hypotheses: What is corrected.
            fix: What the receiver says.
            walked_m: The way so far in site axes, corrections left out.
        """
        p = self._place_of(fix)
        sigma, noisier_m2 = self._claims.take(claimed_m(fix, self._settings))
        for filter_ in hypotheses.filters:
            receiver_error.restate(filter_, sigma)
        if self._evenness.take(fix.t_ns, p, sigma):
            for filter_ in hypotheses.filters:
                receiver_error.believe(filter_, self._evenness.errors)
        noise = np.diag(self._evenness.white_share * np.square(sigma) + noisier_m2)
        self._note_way(p)
        hypotheses.best.settle()
        leap_m = self._leaps.take(fix.t_ns, np.subtract(p, walked_m) - hypotheses.best.R_site_body @ self._lever_m)
        if leap_m.any() and fix.t_ns - self._velocity_ns <= _BLIND_NS:  # else fixes alone hold the inertial unit
            for filter_ in hypotheses.filters:
                receiver_error.doubt(filter_, np.square(leap_m / sigma))
        share = self._doubt.share(fix.t_ns, hypotheses.best.covariance)
        done = hypotheses.correct(
            lambda f: f.correct(
                *observations.gps_position(f, p, sigma, self._lever_m),
                noise,
                tells_north=self.may_tell_north(hypotheses.best),
                share=share,
            )
        )
        self._doubt.corrected(hypotheses.best.covariance)
        self.fix_ns = fix.t_ns
        if done is None or done.used:
            self._insistence.accepted()
        elif self._insistence.believes(fix.t_ns, p, hypotheses.best.nav.p_m, max(sigma[:2])):
            for filter_ in hypotheses.filters:
                filter_.place(p)
                filter_.correct(*observations.gps_position(filter_, p, sigma, self._lever_m), noise)
            self._doubt.begin()

    def _place_of(self, fix: GpsFix) -> Vector3:
        return self._site.site_from_geodetic(fix.lat_deg, fix.lon_deg, fix.h_ellipsoid_m)

    def _note_way(self, p_site_m: Vector3) -> None:
        self._first_fix_m = self._first_fix_m or p_site_m
        x, y, _ = self._first_fix_m
        self._has_walked |= hypot(p_site_m[0] - x, p_site_m[1] - y) > _WALKED_M

    def take_velocity(self, hypotheses: Hypotheses, measured: GpsVelocity, gyro_rad_s: Vector3) -> Correction | None:
        """Correct by a velocity; `gyro_rad_s` with its bias."""
        self._has_walked = True  # or stands, as far as can be told: a velocity is better evidence than a way
        self._velocity_ns = measured.t_ns
        sigma = self._settings.gps_velocity_sigma_m_s
        if self._leaps.is_aside(measured.t_ns):
            sigma *= self._settings.gps_velocity_aside
        noise = np.diag([sigma**2, sigma**2, (1.5 * sigma) ** 2])
        return hypotheses.correct(
            lambda f: f.correct(
                *observations.gps_velocity(f, measured.v_enu_m_s, gyro_rad_s, self._lever_m),
                noise,
                gate_nis=self._settings.velocity_nis,
            )
        )
