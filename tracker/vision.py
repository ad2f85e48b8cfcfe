"""The camera's front end: features tracked from a held keyframe, and the motion since then from the essential matrix.

Deterministic: the same pictures give the same motions (OpenCV's RANSAC starts from a fixed seed).
"""

from dataclasses import dataclass, field, replace

import cv2
import numpy as np
from numpy.typing import NDArray

from tracker import lens, two_view
from tracker.errors import MalformedInput
from tracker.estimator import Snapshot
from tracker.features import NO_FEATURES, Features, FeatureSource, View
from tracker.klt import Klt
from tracker.measurements import Frame, Matrix, Vector3, VisualMotion, VisualTracks
from tracker.rig import CameraModel


@dataclass(frozen=True)
class VisionSettings:
    """Thresholds. The paper gives only "the number of features matched" as its keyframe rule."""

    features: int = 220
    least_inliers: int = 30
    bearing_sigma_px: float = 0.7
    least_parallax_px: float = 2.0
    """Median displacement beyond rotation; with less, the direction of travel is noise."""
    key_share: float = 0.5
    """A new keyframe when fewer of its features than this are still seen,"""
    key_least: int = 60
    """ or fewer than this many,"""
    key_parallax_px: float = 20.0
    """ or they have moved this far against each other,"""
    key_age_s: float = 1.0
    """ or it is this old,"""
    key_period_s: float = 0.25
    """ but not sooner than the paper's four a second, unless nothing else is left to track."""
    told_period_s: float = 0.3
    """So often, and with every keyframe, it is told where the features are."""
    stale_s: float = 0.8
    """Pictures further apart than this cannot be tracked across."""


@dataclass(frozen=True, eq=False)
class _Tracks:
    """The held keyframe and what is still seen of it. Arrays are replaced, never changed."""

    view: View
    """The newest picture."""
    features: Features
    """Where the N features are in it."""
    t_key_ns: int
    bearings_key: Matrix
    """(N, 3) where they were seen at the keyframe."""
    born: int
    """How many features the keyframe began with."""
    ids: NDArray[np.int64]
    """(N,) the same for a feature as long as it is followed."""
    next_id: int
    told_ns: int
    """When it was last told where the features are."""

    def narrowed(self, features: Features, kept: NDArray[np.bool_]) -> "_Tracks":
        """Return what is left of it, `features`, of which `kept` says which they were."""
        return replace(self, features=features, bearings_key=self.bearings_key[kept], ids=self.ids[kept])


@dataclass(frozen=True, eq=False)
class _Motion:
    R_key_cam: Matrix
    direction_key: Vector3
    inliers: NDArray[np.bool_]
    parallax_px: float


@dataclass
class VisionFrontEnd:
    """Turns pictures into motions since a keyframe."""

    camera: CameraModel
    settings: VisionSettings = field(default_factory=VisionSettings)
    source: FeatureSource = field(default_factory=Klt)
    _tracks: _Tracks | None = None

    def step(self, frame: Frame) -> VisualMotion | None:
        """Take a picture in order of capture; None for the first, and for one that shows no motion for certain."""
        try:
            view = self.source.look(frame)
        except MalformedInput:
            return None
        tracks = self._tracks
        if tracks is not None and frame.t_ns <= tracks.view.t_ns:
            return None
        if tracks is None or not self._follows(tracks.view, view):
            self._tracks = self._keyframe(view, None)
            return None
        tracks = replace(tracks.narrowed(*self.source.follow(tracks.view, view, tracks.features)), view=view)
        if len(tracks.features) < 8:
            self._tracks = self._keyframe(view, tracks)
            return None
        motion = self._motion(tracks, self._camera_of(view))
        good = motion.inliers
        seen = tracks.narrowed(tracks.features.chosen(good), good)
        is_keyframe = self._is_due(seen, motion.parallax_px)
        is_told = is_keyframe or frame.t_ns - seen.told_ns >= self.settings.told_period_s * 1e9
        if is_keyframe:
            self._tracks = self._keyframe(view, seen)
        else:
            self._tracks = replace(seen, told_ns=frame.t_ns) if is_told else seen
        inliers = int(np.count_nonzero(good))
        if inliers < self.settings.least_inliers:
            return None
        return VisualMotion(
            frame.t_ns,
            frame.t_recv_ns,
            frame.frame_id,
            tracks.t_key_ns,
            motion.R_key_cam,
            motion.direction_key,
            inliers,
            motion.parallax_px,
            is_keyframe,
            self._followed(seen) if is_told else None,
        )

    def _followed(self, seen: _Tracks) -> VisualTracks:
        xy, key = self._rays(seen.view, seen.features), seen.bearings_key
        return VisualTracks(seen.ids, np.hstack([key[:, :2] / key[:, 2:], xy]).astype(np.float32))

    def _follows(self, before: View, after: View) -> bool:
        """Return whether one picture can be tracked into another."""
        return after.size_px == before.size_px and after.t_ns - before.t_ns <= self.settings.stale_s * 1e9

    def _is_due(self, seen: _Tracks, parallax_px: float) -> bool:
        settings, left = self.settings, len(seen.features)
        if left < settings.least_inliers:
            return True
        age_s = (seen.view.t_ns - seen.t_key_ns) * 1e-9
        if age_s < settings.key_period_s:
            return False
        few = left < settings.key_share * seen.born or left < settings.key_least
        return few or parallax_px > settings.key_parallax_px or age_s >= settings.key_age_s

    def _camera_of(self, view: View) -> CameraModel:
        if view.size_px == (self.camera.width_px, self.camera.height_px):
            return self.camera
        return lens.scaled(self.camera, view.width_px, view.height_px)

    def _rays(self, view: View, features: Features) -> Matrix:
        """Return (N, 2) features on the plane z = 1."""
        return lens.unproject(self._camera_of(view), features.points_px.astype(np.float64))

    def _keyframe(self, view: View, tracks: _Tracks | None) -> _Tracks:
        """Hold a picture: what is tracked already goes on, new features fill the empty parts."""
        features = kept = tracks.features if tracks is not None else NO_FEATURES
        wanted = self.settings.features - len(kept)
        if wanted > 0:
            pixels = view.width_px * view.height_px
            apart_px = max(5, round(0.7 * (pixels / self.settings.features) ** 0.5 / 2))
            features = kept.joined(self.source.detect(view, kept, wanted, apart_px))
        bearings = two_view.bearings(self._rays(view, features))
        first = self._tracks.next_id if self._tracks is not None else 0
        end = first + len(features) - len(kept)
        new = np.arange(first, end)
        ids = np.concatenate([tracks.ids, new]) if tracks is not None else new
        return _Tracks(view, features, view.t_ns, bearings, len(features), ids, end, view.t_ns)

    def _motion(self, tracks: _Tracks, camera: CameraModel) -> _Motion:
        settings = self.settings
        b_key, b_cam = tracks.bearings_key, two_view.bearings(self._rays(tracks.view, tracks.features))
        sigma_rad = settings.bearing_sigma_px / camera.fx_px
        R_turn = two_view.fit_rotation(b_key, b_cam, sigma_rad)
        moved_px = camera.fx_px * two_view.parallax(b_key, b_cam, R_turn)
        median_px = float(np.median(moved_px))
        if median_px >= settings.least_parallax_px and len(b_key) >= settings.least_inliers:
            motion = _by_essential_matrix(b_key, b_cam, sigma_rad, median_px)
            if motion is not None:
                return motion
        limit = max(3.0, 3.0 * median_px)
        return _Motion(R_turn, (0.0, 0.0, 0.0), moved_px < limit, median_px)

    def snapshot(self) -> Snapshot:
        """Return the whole state."""
        return self._tracks

    def restore(self, snapshot: Snapshot) -> None:
        """Become what the snapshot was taken of."""
        self._tracks = snapshot


def _by_essential_matrix(b_key: Matrix, b_cam: Matrix, sigma_rad: float, parallax_px: float) -> _Motion | None:
    """Return the motion by five points in RANSAC, refined over all inliers; None where they agree on none."""
    ahead = (b_key[:, 2] > 0.1) & (b_cam[:, 2] > 0.1)
    xy_key, xy_cam = b_key[:, :2] / b_key[:, 2:], b_cam[:, :2] / b_cam[:, 2:]
    try:
        E, mask = cv2.findEssentialMat(xy_key, xy_cam, np.eye(3), cv2.RANSAC, 0.999, 1.5 * sigma_rad, maxIters=200)
        if E is None or E.shape != (3, 3):
            return None
        count, R_cam_key, t_cam, mask = cv2.recoverPose(E, xy_key, xy_cam, np.eye(3), mask=mask)
    except cv2.error:
        return None  # degenerate points
    chosen = (mask.ravel() != 0) & ahead
    if count < 8 or np.count_nonzero(chosen) < 8:
        return None
    R_key_cam = np.asarray(R_cam_key.T, np.float64)
    direction = -R_key_cam @ np.asarray(t_cam, np.float64).ravel()
    R_key_cam, direction = two_view.refine(
        b_key[chosen], b_cam[chosen], R_key_cam, direction / np.linalg.norm(direction), sigma_rad
    )
    inliers = np.abs(two_view.sampson(b_key, b_cam, R_key_cam, direction)) < 3.0 * sigma_rad
    x, y, z = (float(value) for value in direction)
    return _Motion(R_key_cam, (x, y, z), inliers & ahead, parallax_px)
