"""Others on the same measurements: GTSAM as the ceiling of accuracy, filterpy's IMM, and attitude by vqf and imufusion."""

from collections.abc import Callable, Sequence
from typing import TypeAlias

from tests.benchmarks.accuracy.rivals.attitude import by_imufusion, by_vqf
from tests.benchmarks.accuracy.rivals.batch import by_batch
from tests.benchmarks.accuracy.rivals.fixed_lag import by_fixed_lag
from tests.benchmarks.accuracy.rivals.imm import by_imm
from tracker.estimator import Origin, Pose
from tracker.measurements import Measurement
from tracker.rig import Rig

Rival: TypeAlias = Callable[[Sequence[Measurement], Origin, Rig, Sequence[int]], list[Pose]]
"""From measurements in order of arrival (never truth), where the site lies, the rig, and stamps: the poses at those stamps, without
those at which the rival had none. All but the batch know at a stamp only what had arrived by then."""

RIVALS: dict[str, Rival] = {
    "gtsam/batch": by_batch,
    "gtsam/fixed-lag": by_fixed_lag,
    "filterpy/imm": by_imm,
    "vqf": by_vqf,
    "imufusion": by_imufusion,
}
