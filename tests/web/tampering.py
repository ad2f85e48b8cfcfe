"""Somebody between the server and the page who changes messages."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from playwright.sync_api import Page, WebSocketRoute

from server.wire import decode_frame, encode_frame, is_frame


def change_frames(page: Page, change: Callable[[bytes], bytes]) -> None:
    """Let every frame message that reaches a page go through `change`; all others pass as they are."""

    def passed(message: str | bytes) -> str | bytes:
        return change(message) if isinstance(message, bytes) and is_frame(message) else message

    def join(route: WebSocketRoute) -> None:
        route.connect_to_server().on_message(lambda message: route.send(passed(message)))

    page.route_web_socket("**/ws/view/**", join)


class Tampering:
    """Patches every second frame message, and notes whose."""

    def __init__(self, page: Page, offset: int, patch: bytes, every: int = 2) -> None:
        self.patched: list[int] = []
        self.whole: list[int] = []
        self.patch = patch
        self._offset, self._every = offset, every
        change_frames(page, self._change)

    def _change(self, message: bytes) -> bytes:
        frame_id = int.from_bytes(message[8:12], "little")
        if (len(self.patched) + len(self.whole)) % self._every != self._every - 1:
            self.whole.append(frame_id)
            return message
        self.patched.append(frame_id)
        end = self._offset + len(self.patch)
        return message[: self._offset] + self.patch + message[end:]


class Doubting:
    """Poses with a doubt, and a speed, of the test's choice."""

    def __init__(self, page: Page) -> None:
        self.sigma_m, self.sigma_deg = 0.0, 0.0
        self.v_m_s = (0.0, 0.0, 0.0)
        change_frames(page, self._change)

    def _change(self, message: bytes) -> bytes:
        meta, jpeg = decode_frame(message)
        cov = np.diag([self.sigma_m**2] * 3 + [np.radians(self.sigma_deg) ** 2] * 3)
        return encode_frame(replace(meta, cov=cov, v_site_m_s=self.v_m_s), jpeg)
