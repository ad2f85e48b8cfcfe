"""What waits for one receiver: newest frame, newest pose, and every text message in order. For one event loop, no locks.

Frames are lossy: the slot holds the newest, and at most `MAX_UNACKNOWLEDGED` are under way, so a slow viewer sees fewer frames and
never old ones. Text is reliable: a receiver that lets more than `MAX_TEXTS` pile up is closed. Nobody waits for anybody else.
"""

import asyncio
from collections import deque
from collections.abc import Callable
from typing import Final

from server.grants import ABILITIES, Role
from server.traffic import Tally
from server.wire import keep_seek

MAX_UNACKNOWLEDGED: Final = 3
MAX_TEXTS: Final = 256
#: WebSocket close codes: "try again later" of RFC 6455's registry.
TOO_SLOW: Final = 1013


class Mailbox:
    """One receiver's outgoing mail."""

    def __init__(self) -> None:
        self._texts: deque[str] = deque()
        self._frame: tuple[int, bytes, int | None] | None = None
        self._pose: tuple[bytes, int | None] | None = None
        self._unacknowledged: deque[int] = deque()
        self._news = asyncio.Event()
        self.tally = Tally()
        """What became of frames and poses; receivers of one session share it."""
        self.sent: Callable[[bool, int], None] = lambda is_frame, t_ns: None
        """Called when a frame, or a pose, has gone, with when it had arrived."""
        self._under_way: tuple[bool, int | None] = (False, None)
        self.role: Role = "local"
        """Of whom it is for."""
        self.closing: tuple[int, str] | None = None
        """Code and reason with which the connection is to be closed, once there is one."""

    @property
    def sees(self) -> bool:
        """Whether it is for somebody who may see pictures that the walker does not share."""
        return "see" in ABILITIES[self.role]

    def put_text(self, text: str) -> None:
        """Queue a text message; too many of them close the mailbox."""
        if self.closing is not None:
            return
        if len(self._texts) >= MAX_TEXTS:
            self.close(TOO_SLOW, "too many messages were waiting")
            return
        self._texts.append(text)
        self._news.set()

    def put_frame(self, frame_id: int, data: bytes, t_ns: int | None = None) -> None:
        """Replace the waiting frame; `t_ns` is when it arrived."""
        self.tally.frames_dropped += self._frame is not None
        self._frame = (frame_id, keep_seek(self._frame[1] if self._frame else None, data), t_ns)
        self._news.set()

    def put_pose(self, data: bytes, t_ns: int | None = None) -> None:
        """Replace the waiting pose; `t_ns` is when it arrived."""
        self.tally.poses_dropped += self._pose is not None
        self._pose = (data, t_ns)
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
        """Return what to send next, waiting for it: text before frames before poses; None once closed.

        Who asks has sent what it was given before.
        """
        is_frame, t_ns = self._under_way
        if t_ns is not None:
            self._under_way = (False, None)
            self.sent(is_frame, t_ns)
        while True:
            if self._texts:
                return self._texts.popleft()
            if self.closing is not None:
                return None
            if self._frame is not None and len(self._unacknowledged) < MAX_UNACKNOWLEDGED:
                (frame_id, data, t_ns), self._frame = self._frame, None
                self._under_way = (True, t_ns)
                self._unacknowledged.append(frame_id)
                self.tally.frames_sent += 1
                return data
            if self._pose is not None:
                (pose, t_ns), self._pose = self._pose, None
                self._under_way = (False, t_ns)
                self.tally.poses_sent += 1
                return pose
            self._news.clear()
            await self._news.wait()
