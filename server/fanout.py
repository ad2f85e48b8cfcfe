"""What waits for one receiver: newest frame, newest pose, and every text message in order. For one event loop, no locks.

Frames are lossy: the slot holds the newest, and at most `MAX_UNACKNOWLEDGED` are under way, so a slow viewer sees fewer frames and
never old ones. Text is reliable: a receiver that lets more than `MAX_TEXTS` pile up is closed. Nobody waits for anybody else.
"""

import asyncio
from collections import deque
from typing import Final

from server.wire import keep_seek

MAX_UNACKNOWLEDGED: Final = 3
MAX_TEXTS: Final = 256
#: WebSocket close codes: "try again later" of RFC 6455's registry.
TOO_SLOW: Final = 1013


class Mailbox:
    """One receiver's outgoing mail."""

    def __init__(self) -> None:
        self._texts: deque[str] = deque()
        self._frame: tuple[int, bytes] | None = None
        self._pose: bytes | None = None
        self._unacknowledged: deque[int] = deque()
        self._news = asyncio.Event()
        self.closing: tuple[int, str] | None = None
        """Code and reason with which the connection is to be closed, once there is one."""

    def put_text(self, text: str) -> None:
        """Queue a text message; too many of them close the mailbox."""
        if self.closing is not None:
            return
        if len(self._texts) >= MAX_TEXTS:
            self.close(TOO_SLOW, "too many messages were waiting")
            return
        self._texts.append(text)
        self._news.set()

    def put_frame(self, frame_id: int, data: bytes) -> None:
        """Replace the waiting frame."""
        self._frame = (frame_id, keep_seek(self._frame[1] if self._frame else None, data))
        self._news.set()

    def put_pose(self, data: bytes) -> None:
        """Replace the waiting pose."""
        self._pose = data
        self._news.set()

    def acknowledge(self, frame_id: int) -> None:
        """Take note that the receiver is done with a frame and with those sent before it; an unknown one says nothing."""
        if frame_id in self._unacknowledged:
            while self._unacknowledged.popleft() != frame_id:
                pass
            self._news.set()

    def close(self, code: int, reason: str, last: str | None = None) -> None:
        """End the mailbox: what waits is dropped, a last text still goes; the first reason stays."""
        if self.closing is None:
            self.closing = (code, reason)
            self._texts = deque() if last is None else deque([last])
        self._news.set()

    async def next(self) -> str | bytes | None:
        """Return what to send next, waiting for it: text before frames before poses; None once closed."""
        while True:
            if self._texts:
                return self._texts.popleft()
            if self.closing is not None:
                return None
            if self._frame is not None and len(self._unacknowledged) < MAX_UNACKNOWLEDGED:
                (frame_id, data), self._frame = self._frame, None
                self._unacknowledged.append(frame_id)
                return data
            if self._pose is not None:
                pose, self._pose = self._pose, None
                return pose
            self._news.clear()
            await self._news.wait()
