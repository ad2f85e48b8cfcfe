"""A device's clock mapped to the local one, `time.monotonic_ns`. Pure: it is told both times and reads no clock itself.

A stamp made by the device is exact, but of another clock; the time of receipt is of ours, but late by what the way took, never
early. So `receipt - stamp` is the offset plus a delay >= 0, and the line that lies below all of these and is closest to them
is the offset as it drifts: the lower convex hull's edge at their middle. What stays unknown is the least delay of the way.

References:
    Zhang, Liu, Xia: Clock synchronization algorithms for network measurements, INFOCOM 2002 (the convex hull).
    Olson: A passive solution to the sensor synchronization problem, IROS 2010 (delays of one sign).
"""

from collections import deque
from dataclasses import dataclass
from itertools import pairwise
from statistics import median

#: One point of the line is kept for each of these stretches of the device's time: its least delay.
_STRETCH_NS = 1_000_000_000
#: How many stretches are remembered. A crystal's drift changes with its temperature, in minutes.
_STRETCHES = 64
#: Fewer points than this say nothing about drift: a line goes through two of them whatever they are.
_POINTS_FOR_DRIFT = 5
#: No crystal drifts more.
_LARGEST_DRIFT = 200e-6
#: What crystals drift (one sigma): the weight of a drift that has been seen for a short time among long delays.
_USUAL_DRIFT = 50e-6
#: A stamp this much older than the newest is not out of order, and one this much later than it can be was not made by the clock
#: that we know: it was set (or all so far was late).
_SET_NS = 250_000_000
#: Delays that stay above this, and above all that were before, for some stretches are those of a clock that was set back a little.
_LATE_NS = 50_000_000
_LATE_STRETCHES = 3
_ABOVE_ALL = 1.5


@dataclass(slots=True)
class _Point:
    """The least delay of one stretch."""

    stretch: int
    t_device_ns: int
    offset_ns: int


class DeviceClock:
    """Maps stamps of one device to the local clock, from the pairs of stamp and receipt that it is shown.

    A clock that restarts, or is set by more than a quarter of a second, is noticed and followed from that stamp on; one that is
    set back by less, within three seconds where delays are less than the step, else within a minute. Memory is constant; the same
    pairs give the same answers.
    """

    def __init__(self) -> None:
        self.reset()

    def reset(self) -> None:
        """Forget everything: after a device was put back, its clock is another."""
        self._points: deque[_Point] = deque(maxlen=_STRETCHES)
        self._drift = 0.0
        self._resets = 0
        self._base = (0, 0)
        self._last: tuple[int, int] | None = None

    @property
    def offset_ns(self) -> int:
        """Local minus device time, at the newest stamp; 0 before the first."""
        return 0 if self._last is None else self._line_ns(self._last[0]) - self._last[0]

    @property
    def drift_ppm(self) -> float:
        """How many millionths the local clock is faster than the device's."""
        return self._drift * 1e6

    @property
    def resets(self) -> int:
        """How often the clock was found set since `reset`, or everything before a stamp late by as much as that."""
        return self._resets

    def local_ns(self, t_device_ns: int, t_recv_ns: int) -> int:
        """Return when, on the local clock, the device's clock showed `t_device_ns`.

        Args:
            t_device_ns: The device's stamp, in its own time, from any zero.
            t_recv_ns: When it was here, on the local clock; not before the receipt of the one before.

        Returns:
            A local time, never after `t_recv_ns`, and never before the last one where `t_device_ns` is not before its. A line
            that moves back makes time run at half its speed for a while, so that no two samples get the same stamp for it.
        """
        if self._last is None or self._was_set(t_device_ns, t_recv_ns):
            self._resets += self._last is not None
            self._points.clear()
            self._last = (t_device_ns, self._last[1] if self._last is not None else t_recv_ns)
        self._learn(t_device_ns, t_recv_ns)
        last_device_ns, last_ns = self._last
        t_ns = self._line_ns(t_device_ns)
        if t_device_ns < last_device_ns:
            return min(t_ns, last_ns, t_recv_ns)
        t_ns = min(max(t_ns, last_ns + (t_device_ns - last_device_ns) // 2), t_recv_ns)
        self._last = (t_device_ns, t_ns)
        return t_ns

    def _was_set(self, t_device_ns: int, t_recv_ns: int) -> bool:
        """Whether no delay explains the stamp, so that it is of a clock that was set, or restarted, since the last."""
        assert self._last is not None
        return self._last[0] - t_device_ns > _SET_NS or self._line_ns(t_device_ns) - t_recv_ns > _SET_NS

    def _learn(self, t_device_ns: int, t_recv_ns: int) -> None:
        """Move the line, where the pair lies below it or begins a stretch."""
        stretch, offset_ns = t_device_ns // _STRETCH_NS, t_recv_ns - t_device_ns
        newest = self._points[-1] if self._points else None
        if newest is None or stretch > newest.stretch:
            self._points.append(_Point(stretch, t_device_ns, offset_ns))
            while self._points[0].stretch <= stretch - _STRETCHES:
                self._points.popleft()
            self._drop_what_was_before_a_small_step()
            self._fit()
        elif stretch == newest.stretch and offset_ns < newest.offset_ns:
            newest.t_device_ns, newest.offset_ns = t_device_ns, offset_ns
            if t_recv_ns < self._line_ns(t_device_ns):
                self._fit()

    def _drop_what_was_before_a_small_step(self) -> None:
        """Drop older points where the latest complete stretches all lie far above the line: the clock was set back a little."""
        late = [point.offset_ns + point.t_device_ns - self._line_ns(point.t_device_ns) for point in self._points]
        usual, latest = late[: -_LATE_STRETCHES - 1], late[-_LATE_STRETCHES - 1 : -1]
        if len(usual) >= _POINTS_FOR_DRIFT and min(latest) > max(_LATE_NS, _ABOVE_ALL * max(usual)):
            for _ in usual:
                self._points.popleft()
            self._resets += 1

    def _fit(self) -> None:
        """Lay the line below all points: first its drift, then as high as they let it."""
        x_ns, y_ns = self._points[-1].t_device_ns, self._points[-1].offset_ns
        points = [(float(point.t_device_ns - x_ns), float(point.offset_ns - y_ns)) for point in self._points]
        if len(points) > _POINTS_FOR_DRIFT:
            self._drift = _drift(points[:-1])  # the newest stretch is not complete, and its least delay not its least
        self._base = (x_ns, y_ns + int(min(y - self._drift * x for x, y in points)))

    def _line_ns(self, t_device_ns: int) -> int:
        """Return the line at a stamp, as local time."""
        x_ns, offset_ns = self._base
        return t_device_ns + offset_ns + int(self._drift * (t_device_ns - x_ns))


def _drift(points: list[tuple[float, float]]) -> float:
    """Return the slope of the line below the points that is closest to them, as far as it is to be believed.

    The slope is uncertain by the points' median height above that line over their length; what is less certain than what
    crystals do anyway counts accordingly less.

    Args:
        points: (stamp, offset) in nanoseconds, by stamp, at least two.
    """
    middle = sum(x for x, _ in points) / len(points)
    hull = _lower_hull(points)
    (x0, y0), (x1, y1) = next(edge for edge in pairwise(hull) if edge[1][0] >= middle)
    slope = (y1 - y0) / (x1 - x0)
    height = median(y - y0 - slope * (x - x0) for x, y in points)
    sigma = height / (points[-1][0] - points[0][0])
    believed = slope * _USUAL_DRIFT**2 / (_USUAL_DRIFT**2 + sigma**2)
    return max(-_LARGEST_DRIFT, min(believed, _LARGEST_DRIFT))


def _lower_hull(points: list[tuple[float, float]]) -> list[tuple[float, float]]:
    """Return those of the points, which come by x, that a string pulled tight from below touches (Andrew's monotone chain)."""
    hull: list[tuple[float, float]] = []
    for x, y in points:
        while len(hull) > 1:
            (ax, ay), (bx, by) = hull[-2:]
            if (bx - ax) * (y - ay) > (by - ay) * (x - ax):
                break
            hull.pop()
        hull.append((x, y))
    return hull
