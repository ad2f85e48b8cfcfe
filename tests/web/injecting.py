"""Pictures of a test's own in place of the server's: made with the real wire format, sent on the real connection."""

from collections.abc import Callable

import cv2
import numpy as np
from numpy.typing import NDArray
from playwright.sync_api import Page, WebSocketRoute

from server.wire import FrameMeta, encode_frame, is_frame
from tracker.rig import CameraModel

Pixels = NDArray[np.uint8]
T_START_NS = 1_782_028_800_000_000_000


def frame_message(
    frame_id: int, t_ns: int, T_site_cam: NDArray[np.float64], camera: CameraModel, rgb: Pixels, sigma: float = 1e-3
) -> bytes:
    """Return a message with a picture and the pose of its capture."""
    meta = FrameMeta(
        frame_id=frame_id,
        t_capture_ns=t_ns,
        t_sent_ns=t_ns,
        T_site_cam=T_site_cam,
        cov=np.eye(6) * sigma**2,
        camera=camera,
        motion_model="-",
        estimator="truth",
        v_site_m_s=(0.0, 0.0, 0.0),
        position_s=0.0,
        is_truth=True,
    )
    ok, jpeg = cv2.imencode(".jpg", rgb[..., ::-1], [cv2.IMWRITE_JPEG_QUALITY, 95])
    assert ok
    return encode_frame(meta, bytes(jpeg))


def turned(heading_rad: float, eye_m: float = 1.65) -> NDArray[np.float64]:
    """Return `T_site_cam` of a level camera in the middle of the site, heading clockwise from north."""
    sin, cos = np.sin(heading_rad), np.cos(heading_rad)
    T = np.eye(4)
    T[:3, :3] = np.array([[cos, 0.0, sin], [-sin, 0.0, cos], [0.0, -1.0, 0.0]])
    T[2, 3] = eye_m
    return T


class Injecting:
    """Lets the server's texts through, and for each of its pictures sends some of ours."""

    def __init__(self, page: Page, next_messages: Callable[[], list[bytes]]) -> None:
        self._next = next_messages
        page.route_web_socket("**/ws/view/**", self._join)

    def _join(self, route: WebSocketRoute) -> None:
        server = route.connect_to_server()

        def passed(message: str | bytes) -> None:
            if isinstance(message, str) or not is_frame(message):
                route.send(message)
                return
            for own in self._next():
                route.send(own)
            # the server goes on when its own picture is acknowledged, whatever the page makes of ours
            server.send(f'{{"type": "ack", "frame_id": {int.from_bytes(message[8:12], "little")}}}')

        server.on_message(passed)
        route.on_message(lambda text: None if '"ack"' in str(text) else server.send(text))
