"""What waits for one receiver: newest frame, newest pose, and every text message in order. For one event loop, no locks.

Frames are lossy: the slot holds the newest, and at most `MAX_UNACKNOWLEDGED` are under way, so a slow viewer sees fewer frames and
never old ones. Text is reliable: a receiver that lets more than `MAX_TEXTS` pile up is closed. Nobody waits for anybody else.

Whoever puts something in sends it in the same breath where the line is free: with a thousand receivers, a task that wakes for each
would cost more than the sending.
"""

import asyncio
from collections import deque
from collections.abc import Callable
from typing import Final, Protocol

from server.grants import ABILITIES, Role
from server.traffic import Tally
from server.wire import keep_seek

MAX_UNACKNOWLEDGED: Final = 3
MAX_TEXTS: Final = 256
#: WebSocket close codes: "try again later" of RFC 6455's registry.
TOO_SLOW: Final = 1013


class Line(Protocol):
    """The way to one receiver."""

    on_free: Callable[[], None]
    """Called when the line has become free again."""

    def free(self) -> bool:
        """Whether all that was sent before has gone, so that what is sent now does not queue."""

    def send(self, message: str | bytes) -> None:
        """Send a message; never waits. Only while the line is free."""


class Mailbox:
    """One receiver's outgoing mail."""

    def __init__(self) -> None:
        self._texts: deque[str] = deque()
        self._frame: tuple[int, bytes, int | None] | None = None
        self._pose: tuple[bytes, int | None] | None = None
        self._company: str | None = None
        self._unacknowledged: deque[int] = deque()
        self._line: Line | None = None
        self._closed = asyncio.Event()
        self.tally = Tally()
        """What became of frames and poses; receivers of one session share it."""
        self.sent: Callable[[bool, int], None] = lambda is_frame, t_ns: None
        """Called when a frame, or a pose, has gone, with when it had arrived."""
        self.frames_wanted: int | None = None
        """How many frames are wanted yet, for what is told with them: without pictures. None for all, as they may be seen."""
        self.role: Role = "local"
        """Of whom it is for."""
        self.closing: tuple[int, str] | None = None
        """Code and reason with which the connection is to be closed, once there is one."""

    @property
    def sees(self) -> bool:
        """Whether it is for somebody who may see pictures that the walker does not share."""
        return "see" in ABILITIES[self.role]

    def open(self, line: Line) -> None:
        """Send what waits, and from now on everything, over a line; what was put in before that has waited."""
        self._line = line
        line.on_free = self._send
        self._send()

    def put_text(self, text: str) -> None:
        """Queue a text message; too many of them close the mailbox."""
        if self.closing is not None:
            return
        if len(self._texts) >= MAX_TEXTS:
            self.close(TOO_SLOW, "too many messages were waiting")
            return
        self._texts.append(text)
        self._send()

    def put_frame(self, frame_id: int, data: bytes, t_ns: int | None = None) -> None:
        """Replace the waiting frame; `t_ns` is when it arrived."""
        self.tally.frames_dropped += self._frame is not None
        self._frame = (frame_id, keep_seek(self._frame[1] if self._frame else None, data), t_ns)
        self._send()

    def put_pose(self, data: bytes, t_ns: int | None = None) -> None:
        """Replace the waiting pose; `t_ns` is when it arrived."""
        self.tally.poses_dropped += self._pose is not None
        self._pose = (data, t_ns)
        self._send()

    def put_company(self, text: str) -> None:
        """Replace what waits to be told of those who watch."""
        self._company = text
        self._send()

    def acknowledge(self, frame_id: int) -> None:
        """Take note that the receiver is done with a frame and with those sent before it; an unknown one says nothing."""
        if frame_id in self._unacknowledged:
            while self._unacknowledged.popleft() != frame_id:
                pass
            self._send()

    def close(self, code: int, reason: str, last: str | None = None) -> None:
        """End the mailbox: what waits is dropped, a last text still goes; the first reason stays."""
        if self.closing is None:
            self.closing = (code, reason)
            self._texts = deque() if last is None else deque([last])
            self._send()
            self._closed.set()

    async def closed(self) -> None:
        """Wait until it is closed."""
        await self._closed.wait()

    def _send(self) -> None:
        """Send what may go, text before frames before poses, for as long as the line is free."""
        line = self._line
        while line is not None and line.free():
            if self._texts:
                line.send(self._texts.popleft())
            elif self.closing is not None:
                return
            elif self._frame is not None and len(self._unacknowledged) < MAX_UNACKNOWLEDGED:
                (frame_id, frame, t_ns), self._frame = self._frame, None
                self._unacknowledged.append(frame_id)
                self.tally.frames_sent += 1
                self._send_timed(line, frame, True, t_ns)
            elif self._pose is not None:
                (pose, t_ns), self._pose = self._pose, None
                self.tally.poses_sent += 1
                self._send_timed(line, pose, False, t_ns)
            elif self._company is not None:
                company, self._company = self._company, None
                line.send(company)
            else:
                return

    def _send_timed(self, line: Line, data: bytes, is_frame: bool, t_ns: int | None) -> None:
        line.send(data)
        if t_ns is not None:
            self.sent(is_frame, t_ns)
