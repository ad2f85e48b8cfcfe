"""What a rig has to send: newest frame, newest pose, every text in order. Shared between threads, one lock."""

from collections import deque
from threading import Condition
from typing import Any, Final

import msgspec

from server.wire import keep_seek

_MAX_TEXTS: Final = 256


class Outbox:
    """Mail of one rig for its server, which may be away: then the whole state is kept, and only the newest frame and pose."""

    def __init__(self) -> None:
        self._changed = Condition()
        self._frame: bytes | None = None
        self._pose: bytes | None = None
        self._texts: deque[str] = deque()
        self._state: dict[str, Any] = {}
        self._broken = False
        self._closed = False

    @property
    def closed(self) -> bool:
        """Whether `close` was called."""
        return self._closed

    def put_frame(self, data: bytes) -> None:
        """Replace the waiting frame."""
        with self._changed:
            self._frame = keep_seek(self._frame, data)
            self._changed.notify_all()

    def put_pose(self, data: bytes) -> None:
        """Replace the waiting pose."""
        with self._changed:
            self._pose = data
            self._changed.notify_all()

    def put_state(self, changes: dict[str, Any]) -> None:
        """Queue a change of state, and remember it for the next connection."""
        with self._changed:
            self._state |= changes
            self._texts.append(_state_text(changes))
            if len(self._texts) > _MAX_TEXTS:
                self._texts = deque([_state_text(self._state)])
            self._changed.notify_all()

    def put_text(self, text: str) -> None:
        """Queue a text message for the present connection."""
        with self._changed:
            self._texts.append(text)
            self._changed.notify_all()

    def begin(self) -> None:
        """Begin a connection: the whole state goes first, and what was meant for the last connection is dropped."""
        with self._changed:
            self._broken = False
            self._texts = deque([_state_text(self._state)]) if self._state else deque()

    def break_off(self) -> None:
        """End the present connection's `next`."""
        with self._changed:
            self._broken = True
            self._changed.notify_all()

    def close(self) -> None:
        """End for good: texts that wait may still be sent."""
        with self._changed:
            self._closed = True
            self._changed.notify_all()

    def wait_closed(self, timeout_s: float) -> bool:
        """Wait, at most so long, and return whether the outbox is closed."""
        with self._changed:
            return self._changed.wait_for(lambda: self._closed, timeout_s)

    def next(self) -> str | bytes | None:
        """Return what to send next, waiting for it; None where the connection or everything ends."""
        with self._changed:
            while not self._broken:
                if self._texts:
                    return self._texts.popleft()
                if self._closed:
                    return None
                if self._frame is not None:
                    frame, self._frame = self._frame, None
                    return frame
                if self._pose is not None:
                    pose, self._pose = self._pose, None
                    return pose
                self._changed.wait()
            return None


def _state_text(changes: dict[str, Any]) -> str:
    return msgspec.json.encode({"type": "state", "session": changes}).decode()
