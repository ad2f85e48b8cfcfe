"""What visitors say, as measurements: a tap in a picture becomes a direction to a landmark; and why it is refused, in words."""

from math import hypot

import numpy as np

from tracker.errors import InputError
from tracker.lens import unproject
from tracker.measurements import Outcome, Sighting, Vector3
from tracker.rig import CameraModel

#: Landmarks are known, and found again by visitors, to about this: m.
LANDMARK_SIGMA_M = 0.15
#: A landmark that nobody knows how far it is lies so far, m.
_USUAL_M = 40.0
#: Outside the picture by more than this nothing was tapped, px.
_MARGIN_PX = 1.0


def sighting(
    camera: CameraModel,
    place_px: tuple[float, float],
    sigma_px: float,
    point_site_m: Vector3,
    *,
    t_ns: int,
    t_recv_ns: int,
    distance_m: float | None = None,
) -> Sighting:
    """Return what it says that a landmark was tapped.

    Args:
        camera: Of the picture.
        place_px: Where it was tapped, in pixels of the picture as stored, (0, 0) the centre of the first.
        sigma_px: How well a finger does that.
        point_site_m: The landmark.
        t_ns: Capture of the picture.
        t_recv_ns: Now.
        distance_m: How far the landmark is, as far as is known.

    Raises:
        InputError: The place is not in the picture.
    """
    u, v = place_px
    is_inside = (
        -_MARGIN_PX <= u <= camera.width_px - 1 + _MARGIN_PX and -_MARGIN_PX <= v <= camera.height_px - 1 + _MARGIN_PX
    )
    if not is_inside:
        raise InputError(f"A tap at ({u:.0f}, {v:.0f}) is outside the picture: tap inside it.")
    x, y = unproject(camera, np.array([[u, v]]))[0].tolist()
    length = hypot(x, y, 1.0)
    sigma_rad = hypot(sigma_px / min(camera.fx_px, camera.fy_px), LANDMARK_SIGMA_M / max(1.0, distance_m or _USUAL_M))
    return Sighting(t_ns, t_recv_ns, point_site_m, (x / length, y / length, 1.0 / length), sigma_rad)


def refusal_words(outcome: Outcome, estimator: str) -> str | None:
    """Return in a sentence why an estimator did not take what was said; None where it did."""
    match outcome:
        case Outcome.USED | Outcome.WAITING:
            return None
        case Outcome.IGNORED:
            return f"{estimator} takes no alignment: choose an estimator that ends in precise."
        case Outcome.REJECTED_STALE:
            return "That is too long ago: tap again in a newer picture, and take back within a minute."
        case _:
            return "That cannot be where you stand and look: try another landmark."
