"""Our filter, told what no filter can know: the sizes and times of a receiver's errors, but not when it spikes or echoes.

It corrects in full (`settled_share`), for it is asked how near it comes, not how still it stands.
"""

from collections.abc import Sequence

from tests.benchmarks.accuracy import receiver
from tracker.estimators import Settings
from tracker.precise.settings import PreciseSettings

TOLD = "gps-imu/told"
#: Of errors that there are not: the filter wants three correlation times.
_NEXT_TO_NOTHING, _LONG_S = 1e-6, 3600.0


def settings_of(
    times_s: Sequence[float], sizes_m: Sequence[float], white_m: float, velocity_m_s: float, understated: float = 1.0
) -> Settings:
    """Return the settings of a filter that knows a receiver.

    Args:
        times_s: Correlation times of the parts of its error, at most three.
        sizes_m: Their sizes, level.
        white_m: Its white noise.
        velocity_m_s: White noise of its velocity.
        understated: By how much the sigma that it claims is too small.
    """
    total_m2 = sum(size**2 for size in sizes_m) + white_m**2
    missing = 3 - len(times_s)
    first_s, second_s, third_s = *times_s, *[_LONG_S] * missing
    first, second, third = *(size**2 / total_m2 - _NEXT_TO_NOTHING for size in sizes_m), *[_NEXT_TO_NOTHING] * missing
    return Settings(
        precise=PreciseSettings(
            gps_error_s=(first_s, second_s, third_s),
            gps_error_share=(first, second, third),
            gps_inflation=understated**2,
            gps_velocity_sigma_m_s=velocity_m_s,
            settled_share=1.0,
        )
    )


#: Of the study's receiver.
STUDIED = settings_of(receiver.SLOW_S, receiver.SLOW_M, receiver.WHITE_M, receiver.VELOCITY_M_S)
_SIMULATED = settings_of((60.0,), (1.6,), 0.4, 0.10)
_FOREIGN = settings_of((20.0, 400.0), (0.8, 1.6), 0.3, 0.08, understated=1.5)
#: Of recorded walks whose receiver was simulated, as their makers say.
RECORDED = {
    "walk0827-a": _SIMULATED,
    "tumvi-room1": _SIMULATED,
    "sim-dev-camera": _FOREIGN,
    "sim-dev-long-1": _FOREIGN,
    "sim-dev-long-2": _FOREIGN,
}
