"""Walks that a test tells to a page in a rig's place: each state at once, the same on every machine, and nobody need walk."""

from collections.abc import Mapping, Sequence
from math import radians
from typing import Any

import cv2
import numpy as np
from playwright.sync_api import Page, WebSocketRoute

from server.messages import hello, state
from server.wire import FrameMeta, PoseUpdate, encode_frame, encode_pose
from tests.web.injecting import T_START_NS, turned
from tracker.rig import CameraModel

Walk = Mapping[str, Any]

_CAMERA = CameraModel(640, 480, 512.5, 508.25, 321.25, 238.5, "plumb_bob", (-0.09, 0.02, 0.0005, -0.0004, 0.0))
_HEADING_RAD = 0.4
_STEP_NS = 1_000_000_000
_MOTION_MODEL = "P1R1"
_ALWAYS: Walk = {
    "anchor": "site",
    "notice": None,
    "health": {},
    "sharing": False,
    "connected": True,
    "playback": None,
}


class Telling:
    """What stands between a page and its server: it answers which walks there are, and is each of them."""

    def __init__(self, page: Page, walks: Sequence[Walk], refused: int | None = None) -> None:
        """`refused` is the code by which every connection ends at once."""
        self._sessions = [
            {**_ALWAYS, **walk, "title": walk["title"] or None, "log": walk["log"] or None} for walk in walks
        ]
        self._routes: dict[str, WebSocketRoute] = {}
        self._refused, self._count = refused, 0
        page.route("**/api/sessions", lambda route: route.fulfill(json={"sessions": self._sessions}))
        page.route_web_socket("**/ws/view/**", self._join)

    def _join(self, route: WebSocketRoute) -> None:
        # without a handler of its own the page's messages would wait for one
        route.on_message(lambda _: None)
        if self._refused is not None:
            route.close(code=self._refused)
            return
        name = route.url.split("/ws/view/")[1].split("?")[0]
        self._routes[name] = route
        for session in self._sessions:
            if session["name"] == name:
                route.send(hello(session, role="viewer", sees=True, number=1))

    def news(self, changes: Mapping[str, Any]) -> None:
        """Tell that every walk has changed."""
        self._sessions = [{**session, **changes} for session in self._sessions]
        for session in self._sessions:
            self._routes[session["name"]].send(state(session))

    def picture(self, doubt: Sequence[float]) -> None:
        """Send a picture that is known to so many metres and degrees; none of these: without a pose."""
        sigma_m, sigma_deg = doubt or (0.0, 0.0)
        meta = FrameMeta(
            frame_id=self._next(),
            t_capture_ns=T_START_NS + self._count * _STEP_NS,
            t_sent_ns=T_START_NS + self._count * _STEP_NS,
            T_site_cam=turned(_HEADING_RAD) if doubt else np.eye(4),
            cov=np.diag([sigma_m**2] * 3 + [radians(sigma_deg) ** 2] * 3),
            camera=_CAMERA,
            motion_model=_MOTION_MODEL if doubt else "-",
            estimator=self._sessions[0]["estimator"],
            v_site_m_s=(0.0, 0.0, 0.0),
            position_s=84.0,
            pose_valid=bool(doubt),
            heading_known=bool(doubt),
            did_seek=True,
        )
        jpeg = cv2.imencode(".jpg", np.full((480, 640, 3), 128, np.uint8))[1]
        for route in self._routes.values():
            route.send(encode_frame(meta, bytes(jpeg)))

    def pose(self, sigma_m: float) -> None:
        """Send a pose that is known to so many metres."""
        told = PoseUpdate(
            seq=self._next(),
            t_ns=T_START_NS + self._count * _STEP_NS,
            p_site_body_m=(0.0, 0.0, 1.65),
            wxyz_site_body=(1.0, 0.0, 0.0, 0.0),
            variance=(sigma_m**2, sigma_m**2, 1.0, 1e-4, 1e-4, 1e-3),
            v_site_m_s=(0.0, 0.0, 0.0),
            motion_model=_MOTION_MODEL,
        )
        for route in self._routes.values():
            route.send(encode_pose(told))

    def end(self, code: int) -> None:
        """End every connection, and each that follows."""
        self._refused = code
        for route in self._routes.values():
            route.close(code=code)

    def _next(self) -> int:
        self._count += 1
        return self._count
