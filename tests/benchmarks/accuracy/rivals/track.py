"""The inertial samples so far, what they say by themselves (level attitude, gains of velocity, standing), and motion by them."""

from bisect import bisect_left, bisect_right
from collections.abc import Iterator
from math import isfinite

from tracker.attitude import Madgwick
from tracker.geometry import rotate
from tracker.measurements import ImuSample, Vector3, Wxyz
from tracker.precise.activity import Activity
from tracker.precise.navigation import Biases, Navigation, advance, mean, sample_between

#: Judgements of the walker's activity, one every quarter of a second, within this of a time are about it.
_NEAR_NS = (250_000_000, 400_000_000)
#: A mean turn rate while standing moves the idea of the gyroscope's offset by this share.
_OFFSET_SHARE = 0.1


class InertialTrack:
    """Samples in order of stamp, each with the attitude and the gained velocity of a level frame whose yaw is arbitrary."""

    def __init__(self, gravity_m_s2: float) -> None:
        self.gravity_m_s2 = gravity_m_s2
        self._samples: list[ImuSample] = []
        self._stamps: list[int] = []
        self._level: list[Wxyz] = []
        self._gained: list[tuple[float, float]] = []
        self._madgwick, self._activity = Madgwick(), Activity()
        self._offset: Vector3 = (0.0, 0.0, 0.0)
        self._cycle_stamps: list[int] = []
        self._cycles: list[tuple[bool, bool, Vector3]] = []
        """Of every cycle: whether the rig stands, whether the view is still too, and the mean turn rate."""

    def add(self, sample: ImuSample) -> bool:
        """Take a sample; False where it is not finite or not newer than the last one."""
        if not isfinite(sum(sample.gyro_rad_s) + sum(sample.accel_m_s2)):
            return False
        if not self._samples:
            self._keep(sample, self._madgwick.update(sample.gyro_rad_s, sample.accel_m_s2, 0.0), (0.0, 0.0))
            return True
        last = self._samples[-1]
        if sample.t_ns <= last.t_ns:
            return False
        dt_s = (sample.t_ns - last.t_ns) * 1e-9
        gyro, accel = mean(last.gyro_rad_s, sample.gyro_rad_s), mean(last.accel_m_s2, sample.accel_m_s2)
        (gx, gy, gz), (bx, by, bz) = gyro, self._offset
        wxyz = self._madgwick.update((gx - bx, gy - by, gz - bz), accel, dt_s)
        fx, fy, _ = rotate(wxyz, accel)
        ux, uy = self._gained[-1]
        self._keep(sample, wxyz, (ux + fx * dt_s, uy + fy * dt_s))
        return True

    def _keep(self, sample: ImuSample, wxyz: Wxyz, gained: tuple[float, float]) -> None:
        self._samples.append(sample)
        self._stamps.append(sample.t_ns)
        self._level.append(wxyz)
        self._gained.append(gained)
        activity = self._activity
        if not activity.step(sample):
            return
        self._cycle_stamps.append(sample.t_ns)
        self._cycles.append((activity.stands, activity.is_still, activity.gyro_mean_rad_s))
        if activity.is_still:
            x, y, z = (b + _OFFSET_SHARE * (g - b) for b, g in zip(self._offset, activity.gyro_mean_rad_s, strict=True))
            self._offset = (x, y, z)

    @property
    def first_ns(self) -> int:
        """Stamp of the oldest sample."""
        return self._stamps[0]

    @property
    def newest_ns(self) -> int | None:
        """Stamp of the newest sample."""
        return self._stamps[-1] if self._stamps else None

    def level_at(self, t_ns: int) -> Wxyz:
        """Return the attitude against the level frame, of the last sample until t_ns."""
        return self._level[self._row(t_ns)]

    def gained_m_s(self, begin_ns: int, end_ns: int) -> complex:
        """Return the level frame's gain of velocity between two times: x + i y."""
        (ax, ay), (bx, by) = self._gained[self._row(begin_ns)], self._gained[self._row(end_ns)]
        return complex(bx - ax, by - ay)

    def _row(self, t_ns: int) -> int:
        return max(0, bisect_right(self._stamps, t_ns) - 1)

    def rates_at(self, t_ns: int) -> ImuSample:
        """Return the last sample until t_ns."""
        return self._samples[self._row(t_ns)]

    def standing(self, t_ns: int) -> tuple[bool, Vector3 | None]:
        """Return whether the rig stands about a time, and the mean turn rate where the view is still as well."""
        near = slice(
            bisect_left(self._cycle_stamps, t_ns - _NEAR_NS[0]), bisect_right(self._cycle_stamps, t_ns + _NEAR_NS[1])
        )
        cycles = self._cycles[near]
        stands = bool(cycles) and all(one[0] for one in cycles)
        is_still = stands and all(one[1] for one in cycles)
        return stands, cycles[-1][2] if is_still else None

    def steps(self, begin_ns: int, end_ns: int) -> Iterator[ImuSample]:
        """Yield the mean rates from one sample to the next, each at its end; the first and the last step are cut to the times."""
        if end_ns <= begin_ns:
            return
        row = bisect_right(self._stamps, begin_ns)
        last = self._between(row, begin_ns)
        while row < len(self._samples) and self._stamps[row] < end_ns:
            sample = self._samples[row]
            yield _step(last, sample)
            last, row = sample, row + 1
        yield _step(last, self._between(row, end_ns))

    def carried(self, nav: Navigation, biases: Biases, t_ns: int) -> Navigation:
        """Return a state carried on to a later time; beyond the newest sample its rates go on."""
        for step in self.steps(nav.t_ns, t_ns):
            nav = advance(nav, step.t_ns, step.gyro_rad_s, step.accel_m_s2, biases, self.gravity_m_s2)
        return nav

    def _between(self, row: int, t_ns: int) -> ImuSample:
        """Return the sample at a time after row - 1 and until row; the nearest one's rates outside of all."""
        if 0 < row < len(self._samples):
            return sample_between(self._samples[row - 1], self._samples[row], t_ns)
        edge = self._samples[0 if row == 0 else -1]
        return ImuSample(t_ns, t_ns, edge.gyro_rad_s, edge.accel_m_s2)


def _step(last: ImuSample, sample: ImuSample) -> ImuSample:
    gyro, accel = mean(last.gyro_rad_s, sample.gyro_rad_s), mean(last.accel_m_s2, sample.accel_m_s2)
    return ImuSample(sample.t_ns, sample.t_recv_ns, gyro, accel)
