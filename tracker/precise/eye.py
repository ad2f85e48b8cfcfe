"""The camera: holds the poses of its pictures, follows features from one to the next, and corrects by what they say together."""

from math import sqrt

import numpy as np

from tracker.measurements import Matrix, Vector3, VisualMotion
from tracker.precise import observations, parallax
from tracker.precise.error_model import SIZE, THETA
from tracker.precise.error_state import ErrorState
from tracker.precise.hypotheses import Hypotheses
from tracker.precise.settings import PreciseSettings
from tracker.precise.tracks import Tracks, seen_in
from tracker.precise.update import Correction
from tracker.rig import Rig

#: Fewer pictures of a feature say nothing that its unknown place could not explain.
_LEAST_PICTURES = 3
#: So many of them are taken at a time, those seen most often: what a head turn loses all at once would keep samples waiting.
_MOST = 40
#: For the same reason so many are taken with one inertial sample, the rest with those after it.
_AT_ONCE = 14
#: How well features can be followed through these pictures is learned: so much of each new one's misfit, up to so many times
#: the variance that is believed. Blur, a rolling shutter and a stamp that is off all look like that.
_LEARNED, _WORST = 0.1, 25.0
#: Where it is less sure than this how the rig has turned since the last picture, as after a gap, the turn that two pictures show is
#: taken first, for slopes at poses that are so far off are wrong; and its error, rad.
_UNSURE_RAD, _TURN_RAD = 0.1, 0.02


class Eye:
    """The camera on its rig."""

    def __init__(self, settings: PreciseSettings, rig: Rig) -> None:
        self._settings = settings
        self._R_body_cam = rig.T_body_cam[:3, :3]
        x, y, z = rig.T_body_cam[:3, 3].tolist()
        self.lever_m: Vector3 = (x, y, z)
        """Where the camera is in the body, m."""
        self._sigma = settings.feature_px / rig.camera.fx_px if rig.camera is not None else 0.0
        self._misfit = 1.0
        self._tracks = Tracks(settings.feature_pictures)
        self._left: Matrix = np.zeros((0, 0, 2))
        """Features that have told all and are still to be taken, (M, K, 2) in the pictures of `_stamps`."""
        self._stamps: list[int] = []

    def ray_body(self, ray_cam: Vector3) -> Vector3:
        """Return a direction in the body's axes."""
        x, y, z = (self._R_body_cam @ np.array(ray_cam)).tolist()
        return (x, y, z)

    def hold(self, hypotheses: Hypotheses, t_ns: int) -> None:
        """Hold the pose of a picture that was taken now, against which later ones are measured, unless north is open."""
        filter_ = hypotheses.best
        if not hypotheses.are_many and all(clone.t_ns != t_ns for clone in filter_.clones):
            filter_.hold(self._settings.feature_pictures + 1)

    def take(self, hypotheses: Hypotheses, motion: VisualMotion) -> None:
        """Take note of the features that were lost with this picture, or have been seen for long enough.

        As long as north is open nothing is taken: features cannot tell it, and slopes at poses that are turned by who knows how
        much would seem to.
        """
        if motion.tracks is None or hypotheses.are_many:
            return
        while self.is_behind:
            self.go_on(hypotheses)
        is_held = any(clone.t_ns == motion.t_key_ns for clone in hypotheses.best.clones)
        if is_held:
            hypotheses.correct(lambda f: self._turn(f, motion))
        self.hold(hypotheses, motion.t_ns)
        xy = self._tracks.take(motion.tracks, motion.t_key_ns, motion.t_ns, is_held=is_held)
        count = seen_in(xy).sum(axis=1)
        often = np.argsort(-count, kind="stable")[:_MOST]
        self._left, self._stamps = xy[often[count[often] >= _LEAST_PICTURES]], self._tracks.stamps
        self._tracks.forget_oldest()

    @property
    def is_behind(self) -> bool:
        """Whether features are still to be taken."""
        return len(self._left) > 0

    def go_on(self, hypotheses: Hypotheses) -> None:
        """Take in what some of the features say that are still to be taken."""
        xy, self._left = self._left[:_AT_ONCE], self._left[_AT_ONCE:]
        if not hypotheses.are_many:
            hypotheses.correct(lambda f: self._constrain(f, xy))

    def _turn(self, filter_: ErrorState, motion: VisualMotion) -> Correction | None:
        """Correct by how the rig has turned since a held picture; None where that is known well enough."""
        filter_.settle()
        held = next(i for i, clone in enumerate(filter_.clones) if clone.t_ns == motion.t_key_ns)
        at, cov = slice(SIZE + 6 * held + 3, SIZE + 6 * held + 6), filter_.covariance
        unsure = cov[THETA, THETA] + cov[at, at] - cov[THETA, at] - cov[at, THETA]
        if np.diag(unsure).max() < _UNSURE_RAD**2:
            return None
        R_held_now = self._R_body_cam @ motion.R_key_cam @ self._R_body_cam.T
        return filter_.correct(
            *observations.turn(filter_, held, R_held_now), _TURN_RAD**2 * np.eye(3), is_relative=True
        )

    def _constrain(self, filter_: ErrorState, xy: Matrix) -> Correction | None:
        """Correct by features, (M, K, 2); None where they say nothing."""
        held = {clone.t_ns: index for index, clone in enumerate(filter_.clones)}
        there = [k for k, t_ns in enumerate(self._stamps) if t_ns in held]
        at = [held[self._stamps[k]] for k in there]
        xy = xy[:, there]
        xy = xy[seen_in(xy).sum(axis=1) >= _LEAST_PICTURES]
        if len(xy) == 0:
            return None
        filter_.settle()
        rows = SIZE + (6 * np.array(at)[:, None] + np.arange(6)).ravel()
        covariance = filter_.covariance[np.ix_(rows, rows)]
        sigma = sqrt(self._misfit) * self._sigma
        said = parallax.constraint(self._cameras(filter_, at), xy, sigma, covariance, self._settings.feature_nis)
        self._misfit += _LEARNED * (min(max(1.0, self._misfit * said.misfit), _WORST) - self._misfit)
        if len(said.residual) == 0:
            return None
        blocks = [(slice(SIZE + 6 * i, SIZE + 6 * i + 6), said.H[:, 6 * k : 6 * k + 6]) for k, i in enumerate(at)]
        return filter_.correct(said.residual, blocks, np.eye(len(said.residual)), is_relative=True)

    def _cameras(self, filter_: ErrorState, at: list[int]) -> parallax.Cameras:
        clones = [filter_.clones[index] for index in at]
        R_site_body = np.array([clone.R_site_body for clone in clones])
        lever_m = R_site_body @ np.array(self.lever_m)
        p_m = np.array([clone.p_m for clone in clones]) + lever_m
        return parallax.Cameras(R_site_body @ self._R_body_cam, p_m, lever_m)
