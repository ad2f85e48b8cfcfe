"""What the paper does to raw inertial samples: offsets found at rest, and the mean of a few samples.

Its table of offsets ("Calibration parameters found for accelerometer and gyroscope") subtracts the accelerometer's mean at rest
too. That mean contains gravity and the tilt of the table it lay on, so subtracting it is right for no other attitude; here only
the gyroscope's offset is removed.
"""

from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass
from math import sqrt

from tracker.measurements import ImuSample, Vector3

#: The paper's number of samples ("~5000, which takes around 30 seconds").
REST_SAMPLES = 5000
#: A block of samples is at rest when no axis of the gyro spreads wider than this, rad/s: a standing person sways by 0.02.
REST_GYRO_STD_RAD_S = 0.04
#: ... and its mean is no faster than this: larger than any offset, smaller than any turn of the head. The paper's are 0.2 deg/s.
REST_GYRO_MEAN_RAD_S = 0.03
#: ... and the length of the specific force spreads no wider than this, m/s2: a step shows 1 to 3.
REST_ACCEL_STD_M_S2 = 0.25
REST_BLOCK_S = 0.5
#: A hand that holds a phone, or begins to turn, looks still for half a second: fewer blocks than this in a row are no rest.
REST_BLOCKS = 5
#: After the first 5000 samples of a rest the newest 5000 count, but for its last blocks: a hand that takes the rig up looks still.
REST_LAG_BLOCKS = 2
#: What a gyroscope's offset may be before anything was measured, rad/s: a standing person's sway must not be taken for one.
OFFSET_SIGMA_RAD_S = 0.006


class RestCalibration:
    """The gyroscope's offset from the rest at the start of a walk.

    Samples are judged in blocks of half a second. Blocks at rest are averaged until the rig moves, the newest 5000 samples of
    them; then the offset stands for good, as in the paper. A walk that starts in motion has offset zero until a first rest.

    The paper takes 5000 samples once. An offset wanders, by 0.4 degrees a minute within a minute at the Phidget's noise: on a rig
    that lies on, the mean of the newest is as exact and not as old.

    On a table the blocks agree and their mean is the offset. A person who stands sways, the blocks scatter, and the mean is
    believed only as far as its standard error allows against what offsets usually are.
    """

    def __init__(self) -> None:
        self.gyro_offset_rad_s: Vector3 = (0.0, 0.0, 0.0)
        self.samples = 0
        """How many samples the offset rests on."""
        self.finished = False
        """5000 samples are in, or the rig has moved."""
        self._moved = False
        self._block: list[ImuSample] = []
        self._rest: deque[tuple[int, Vector3]] = deque()
        """Size and mean of each block of this rest."""

    def step(self, sample: ImuSample) -> None:
        """Take one raw sample."""
        if self._moved:
            return
        self._block.append(sample)
        if sample.t_ns - self._block[0].t_ns < REST_BLOCK_S * 1e9:
            return
        block, self._block = self._block, []
        if not at_rest(block):
            self.finished = self._moved = self.samples > 0
            self._rest.clear()
            return
        x, y, z = (sum(s.gyro_rad_s[axis] for s in block) / len(block) for axis in range(3))
        self._rest.append((len(block), (x, y, z)))
        if len(self._rest) < REST_BLOCKS:
            return
        counted = list(self._rest)[: -REST_LAG_BLOCKS if self.finished else None]
        samples = sum(size for size, _ in counted)
        while samples - counted[0][0] >= REST_SAMPLES:
            samples -= counted.pop(0)[0]
            self._rest.popleft()
        if self.finished and samples < REST_SAMPLES:
            return
        self.samples = samples
        x, y, z = (_believed([mean[axis] for _, mean in counted]) for axis in range(3))
        self.gyro_offset_rad_s = (x, y, z)
        self.finished = self.finished or samples >= REST_SAMPLES


def _believed(means: list[float]) -> float:
    """Return the mean of some blocks' means, drawn towards zero by how little they agree."""
    mean, std = _mean_std(means)
    return mean * OFFSET_SIGMA_RAD_S**2 / (OFFSET_SIGMA_RAD_S**2 + std**2 / (len(means) - 1))


def at_rest(block: Sequence[ImuSample]) -> bool:
    """Return whether the samples of half a second look like a rig that lies, or a person who stands, still."""
    for axis in range(3):
        mean, std = _mean_std([sample.gyro_rad_s[axis] for sample in block])
        if std > REST_GYRO_STD_RAD_S or abs(mean) > REST_GYRO_MEAN_RAD_S:
            return False
    norms = [sqrt(ax * ax + ay * ay + az * az) for ax, ay, az in (sample.accel_m_s2 for sample in block)]
    return _mean_std(norms)[1] <= REST_ACCEL_STD_M_S2


def _mean_std(values: list[float]) -> tuple[float, float]:
    mean = sum(values) / len(values)
    return mean, sqrt(sum((value - mean) ** 2 for value in values) / len(values))


@dataclass(frozen=True, slots=True)
class MeanSample:
    """The mean of a few inertial samples, valid over the `dt_s` that end at `t_ns`."""

    t_ns: int
    dt_s: float
    gyro_rad_s: Vector3
    accel_m_s2: Vector3


#: The paper's four samples, and the time they span at its 250 Hz. A slower IMU averages fewer: four samples of a phone's
#: 16 Hz would blur a quarter of a second.
MEAN_SAMPLES = 4
MEAN_SPAN_S = 0.016
#: A longer silence than this is a gap: nothing is known of the motion inside it.
LONGEST_STEP_S = 0.25


class SampleMean:
    """Groups samples by up to four, within 16 ms, into their mean."""

    def __init__(self, samples: int = MEAN_SAMPLES) -> None:
        self._samples = samples
        self._t_last_ns: int | None = None
        self._group: list[ImuSample] = []

    def step(self, sample: ImuSample) -> MeanSample | None:
        """Take one sample in order of stamps; return a mean when a group is full."""
        if self._t_last_ns is None:
            self._t_last_ns = sample.t_ns
            return MeanSample(sample.t_ns, 0.0, sample.gyro_rad_s, sample.accel_m_s2)
        group = self._group
        group.append(sample)
        span_s = (sample.t_ns - self._t_last_ns) * 1e-9
        # the span that one sample more would give
        if len(group) < self._samples and span_s * (len(group) + 1) / len(group) <= MEAN_SPAN_S * 1.05:
            return None
        n = len(group)
        gyros, accels = [s.gyro_rad_s for s in group], [s.accel_m_s2 for s in group]
        mean = MeanSample(
            sample.t_ns,
            min(span_s, LONGEST_STEP_S),
            (sum(g[0] for g in gyros) / n, sum(g[1] for g in gyros) / n, sum(g[2] for g in gyros) / n),
            (sum(a[0] for a in accels) / n, sum(a[1] for a in accels) / n, sum(a[2] for a in accels) / n),
        )
        self._t_last_ns, self._group = sample.t_ns, []
        return mean
