"""Through the walker's eyes: a client's camera is the walker's, and the walker's picture is what stands behind the square."""

from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from server.console.pinhole import fov_of, seen_by_pinhole, upright
from server.console.scene import SKY, START_VIEW_M, decoded
from server.console.walk import Walk
from tracker.geometry import wxyz_from_matrix

_USUAL_FOV_RAD: Final = float(np.radians(60.0))
_QUALITY: Final = 75


@dataclass
class _Looking:
    client: Any
    name: str
    t_capture_ns: int = -1


class Eyes:
    """Who looks through whose eyes. Its methods are called by one thread.

    viser decodes the picture after it has moved the camera, so that it lags behind the square by a picture or two: this shows an
    operator what the walker looks at, and is no measure of how well the square fits. `/ar` is.
    """

    def __init__(self) -> None:
        self._looking: dict[int, _Looking] = {}

    @property
    def names(self) -> frozenset[str]:
        """Of the walks that somebody looks through the eyes of."""
        return frozenset(looking.name for looking in self._looking.values())

    def toggle(self, client: Any, name: str | None) -> bool:
        """Begin for a client, or end; return whether it looks through a walker's eyes now."""
        if client.client_id in self._looking or name is None:
            self._looking.pop(client.client_id, None)
            client.scene.set_background_image(SKY, format="png")
            client.camera.fov = _USUAL_FOV_RAD
            client.camera.up_direction = (0.0, 0.0, 1.0)
            client.camera.position, client.camera.look_at = START_VIEW_M, (0.0, 0.0, 0.0)
            return False
        self._looking[client.client_id] = _Looking(client, name)
        return True

    def forget(self, client: Any) -> None:
        """Forget a client that has left."""
        self._looking.pop(client.client_id, None)

    def show(self, walks: dict[str, Walk]) -> None:
        """Show every client what its walker sees by now."""
        for looking in list(self._looking.values()):
            walk = walks.get(looking.name)
            if walk is None:
                self.toggle(looking.client, None)
            elif walk.frame is not None and walk.frame.pose_valid and walk.frame.t_capture_ns != looking.t_capture_ns:
                looking.t_capture_ns = walk.frame.t_capture_ns
                _show(looking.client, walk)


def go_to(client: Any, walk: Walk) -> None:
    """Bring a client behind and above a walker, looking where they look."""
    frame = walk.frame
    if frame is None or not frame.pose_valid:
        return
    p_site_m, ahead = frame.T_site_cam[:3, 3], frame.T_site_cam[:3, 2] * (1.0, 1.0, 0.0)
    ahead = ahead / max(1e-6, float(np.linalg.norm(ahead)))
    with client.atomic():
        client.camera.position = p_site_m - 14.0 * ahead + (0.0, 0.0, 7.0)
        client.camera.look_at = p_site_m


def _show(client: Any, walk: Walk) -> None:
    frame = walk.frame
    assert frame is not None
    T_site_eye = upright(frame.T_site_cam, frame.quarter_turns)
    picture = decoded(walk.jpeg) if walk.has_picture else None
    if picture is not None:
        picture = seen_by_pinhole(picture, frame.camera, frame.quarter_turns, float(client.camera.aspect))
    with client.atomic():
        client.camera.fov = fov_of(frame.camera, frame.quarter_turns)
        client.camera.up_direction = -T_site_eye[:3, 1]
        client.camera.position = T_site_eye[:3, 3]
        client.camera.wxyz = wxyz_from_matrix(T_site_eye[:3, :3])
        client.scene.set_background_image(picture, format="jpeg", jpeg_quality=_QUALITY)
