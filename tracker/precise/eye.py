"""What a picture says of the filter's state: how far its camera has turned since a held one, and which way it went."""

from math import hypot

import numpy as np

from tracker.geometry import log, wxyz_from_matrix
from tracker.measurements import Vector3, VisualMotion
from tracker.precise import observations
from tracker.precise.error_state import Correction, ErrorState
from tracker.precise.settings import PreciseSettings
from tracker.rig import Rig


class Eye:
    """The camera on its rig, and how far its motions are believed."""

    def __init__(self, settings: PreciseSettings, rig: Rig) -> None:
        self._settings = settings
        self._R_body_cam = rig.T_body_cam[:3, :3]
        x, y, z = rig.T_body_cam[:3, 3].tolist()
        self.lever_m: Vector3 = (x, y, z)
        """Where the camera is in the body, m."""

    def ray_body(self, ray_cam: Vector3) -> Vector3:
        """Return a direction in the body's axes."""
        x, y, z = (self._R_body_cam @ np.array(ray_cam)).tolist()
        return (x, y, z)

    def rotation(self, filter_: ErrorState, motion: VisualMotion) -> Correction | None:
        """Take in the turn since the held picture; None where that is not held."""
        index = _index_of(filter_, motion.t_key_ns)
        if index is None:
            return None
        settings, parallax_px = self._settings, motion.parallax_px
        doubt = settings.vision_mixed * parallax_px / (1.0 + (parallax_px / 2.0) ** 2)
        turned_rad = hypot(*log(wxyz_from_matrix(motion.R_key_cam)))
        sigma = hypot(settings.vision_rotation_rad * (1.0 + doubt), settings.vision_scale * turned_rad)
        seen = observations.rotation_to_clone(filter_, index, motion.R_key_cam, self._R_body_cam)
        return filter_.correct(*seen, sigma**2 * np.eye(3))

    def direction(self, filter_: ErrorState, motion: VisualMotion) -> Correction | None:
        """Take in the direction of travel; None where the picture is not held, or the state has hardly moved from it."""
        index = _index_of(filter_, motion.t_key_ns)
        if index is None:
            return None
        seen = observations.direction_from_clone(filter_, index, motion.direction_key, self._R_body_cam, self.lever_m)
        if seen is None:
            return None
        settings = self._settings
        sigma = max(settings.vision_direction_rad, settings.vision_point_px / max(motion.parallax_px, 0.1))
        sigma = hypot(sigma, *seen[0].tolist())  # points that are mismatched agree on anything
        return filter_.correct(*seen, sigma**2 * np.eye(2))


def _index_of(filter_: ErrorState, t_ns: int) -> int | None:
    return next((i for i, clone in enumerate(filter_.clones) if clone.t_ns == t_ns), None)
