"""When a picture was taken, from the time that came with it and the time at which it was read. Pure.

What comes with a picture differs: Linux's V4L2 drivers stamp the buffer with the clock that `time.monotonic_ns` is, at the start
of the exposure or the end of the frame; a network stream carries times from a zero of its own; some cameras say nothing, or the
same each time. The constant that is left over in each of these is what `agora calibrate rig` finds as the time offset.
"""

from typing import Literal

from tracker.device_clock import DeviceClock

StampKind = Literal["driver", "stream", "read"]
"""The driver's own monotonic stamp; the stream's time mapped to ours; the time of reading."""

#: A driver's stamp that is older is no stamp of this clock, but of the time of day or of nothing.
_OLDEST_NS = 2_000_000_000
_LONGEST_NS = 60_000_000_000
#: Stamps are microseconds, read as a float of milliseconds.
_ROUNDING_NS = 2_000


class PictureClock:
    """Maps pictures' times to the local clock, choosing anew with every picture the best that its time allows."""

    def __init__(self, *, is_driver: bool, latency_ns: int) -> None:
        """Begin with a newly opened camera.

        Args:
            is_driver: Whether stamps may be the local clock's own, as V4L2's are.
            latency_ns: From exposure to reading, where no driver's stamp tells.
        """
        self.kind: StampKind = "read"
        """How the latest picture was stamped."""
        self._is_driver, self._latency_ns = is_driver, latency_ns
        self._clock = DeviceClock()
        self._last_stamp_ns = 0
        self._last_ns: int | None = None

    def local_ns(self, stamp_ms: float, t_recv_ns: int) -> int:
        """Return when a picture was taken: later than the one before, never after t_recv_ns.

        Args:
            stamp_ms: What came with it, milliseconds; anything at all.
            t_recv_ns: When it was read, which is later than the one before.
        """
        t_ns = min(self._mapped_ns(stamp_ms, t_recv_ns), t_recv_ns)
        if self._last_ns is not None:
            t_ns = min(max(t_ns, self._last_ns + 1), t_recv_ns)
        self._last_ns = t_ns
        return t_ns

    def _mapped_ns(self, stamp_ms: float, t_recv_ns: int) -> int:
        stamp_ns = round(stamp_ms * 1e6) if 0.0 < stamp_ms < 1e13 else 0
        moves, self._last_stamp_ns = stamp_ns != self._last_stamp_ns, stamp_ns
        age_ns = t_recv_ns - stamp_ns
        # a picture may lie in the buffer for long, but only after others have shown what clock this is
        if (
            self._is_driver
            and moves
            and -_ROUNDING_NS <= age_ns < (_LONGEST_NS if self.kind == "driver" else _OLDEST_NS)
        ):
            self.kind = "driver"
            return stamp_ns
        if moves and stamp_ns:
            self.kind = "stream"
            return self._clock.local_ns(stamp_ns, t_recv_ns) - self._latency_ns
        self.kind = "read"
        return t_recv_ns - self._latency_ns
