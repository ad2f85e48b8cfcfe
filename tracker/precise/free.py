"""The strapdown integral that no measurement corrects: it carries a state of the filter, which is late, on to now.

It is the same in whatever order the samples arrive: a late one has it done again from there, with the biases of its time.
"""

from bisect import bisect_left
from itertools import pairwise
from typing import NamedTuple

from tracker.measurements import ImuSample
from tracker.precise.gap import held, is_gap
from tracker.precise.navigation import Biases, Navigation, advance, carried, mean

#: States are kept for predictions of the recent past.
_KEPT_NS = 2_000_000_000
#: After the newest sample its rates go on for a moment; then the velocity does.
_LONGEST_TURN_NS = 100_000_000
_START = Navigation(0, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0), (1.0, 0.0, 0.0, 0.0))


class _Step(NamedTuple):
    nav: Navigation
    sample: ImuSample
    """Which ended the step."""
    biases: Biases
    """That were taken off in it."""


class FreeIntegral:
    """Where the integral has been in the last two seconds."""

    def __init__(self, gravity_m_s2: float, lag_ns: int) -> None:
        """`lag_ns` is how far behind the filter is whose biases are taken off."""
        self._gravity, self._lag_ns = gravity_m_s2, lag_ns
        self._steps: list[_Step] = []
        self._learnt: list[tuple[int, Biases]] = []

    @property
    def oldest_ns(self) -> int:
        """The earliest time that is known; there must have been a sample."""
        return self._steps[0].nav.t_ns

    @property
    def newest_ns(self) -> int:
        """Stamp of the newest sample; there must have been one."""
        return self._steps[-1].nav.t_ns

    def learn(self, t_ns: int, biases: Biases) -> None:
        """Take what the filter believes at an inertial sample's stamp, after all that was measured by then."""
        if self._learnt and self._learnt[-1][0] == t_ns:
            self._learnt.pop()
        self._learnt.append((t_ns, biases))

    def add(self, sample: ImuSample) -> None:
        """Carry the integral on."""
        steps, after = self._steps, []
        while steps and steps[-1].nav.t_ns > sample.t_ns:
            after.append(steps.pop().sample)
        for one in (sample, *reversed(after)):
            steps.append(self._next(one))
        oldest_ns = self.newest_ns - _KEPT_NS
        while len(steps) > 1 and steps[1].nav.t_ns <= oldest_ns:
            del steps[0]
        while len(self._learnt) > 1 and self._learnt[1][0] <= oldest_ns:
            del self._learnt[0]

    def _next(self, sample: ImuSample) -> _Step:
        if not self._steps:
            return _Step(_START._replace(t_ns=sample.t_ns), sample, Biases())
        nav, last, _ = self._steps[-1]
        # what the filter had taken when the sample before this one came in its turn: later it may know more
        known_ns = last.t_ns - self._lag_ns
        biases = next((biases for t_ns, biases in reversed(self._learnt) if t_ns < known_ns), Biases())
        if is_gap(nav.t_ns, sample.t_ns):
            return _Step(held(nav, sample.t_ns), sample, biases)
        gyro, accel = mean(last.gyro_rad_s, sample.gyro_rad_s), mean(last.accel_m_s2, sample.accel_m_s2)
        return _Step(advance(nav, sample.t_ns, gyro, accel, biases, self._gravity), sample, biases)

    def carry(self, state: Navigation, t_ns: int) -> Navigation:
        """Return a state within what is kept, carried on (or back) to a time not before what is kept."""
        if t_ns == state.t_ns:
            return state
        known_ns = min(t_ns, self.newest_ns)
        nav = carried(state, self._at(state.t_ns), self._at(known_ns), self._gravity)
        return nav if known_ns == t_ns else self._beyond(nav, t_ns)

    def gaps_s(self, from_ns: int, to_ns: int) -> float:
        """Return how much of a time lies in gaps between samples, seconds."""
        first = max(0, bisect_left(self._steps, from_ns, key=lambda step: step.nav.t_ns) - 1)
        times_ns = [step.nav.t_ns for step in self._steps[first:]]
        return sum(
            (min(b, to_ns) - max(a, from_ns)) * 1e-9 for a, b in pairwise(times_ns) if a < to_ns and is_gap(a, b)
        )

    def _at(self, t_ns: int) -> Navigation:
        place = bisect_left(self._steps, t_ns, key=lambda step: step.nav.t_ns)
        after = self._steps[place]
        if after.nav.t_ns == t_ns:
            return after.nav
        before = self._steps[place - 1]
        if is_gap(before.nav.t_ns, after.nav.t_ns):
            return held(before.nav, t_ns)
        gyro = mean(before.sample.gyro_rad_s, after.sample.gyro_rad_s)
        accel = mean(before.sample.accel_m_s2, after.sample.accel_m_s2)
        return advance(before.nav, t_ns, gyro, accel, after.biases, self._gravity)

    def _beyond(self, nav: Navigation, t_ns: int) -> Navigation:
        """Go on from the newest sample with its rates for a moment, then straight on."""
        _, sample, biases = self._steps[-1]
        turned_ns = min(t_ns, nav.t_ns + _LONGEST_TURN_NS)
        on = advance(nav, turned_ns, sample.gyro_rad_s, sample.accel_m_s2, biases, self._gravity)
        rest_s = (t_ns - turned_ns) * 1e-9
        (px, py, pz), (vx, vy, vz) = on.p_m, on.v_m_s
        return on._replace(t_ns=t_ns, p_m=(px + vx * rest_s, py + vy * rest_s, pz + vz * rest_s))
