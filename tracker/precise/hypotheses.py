"""Several filters that differ in where they take north to be, until motion has told: the receiver's velocity decides.

One linearised filter cannot find its way from a heading that is wrong by a right angle. Eight, an eighth of a turn apart, cannot
all be wrong by more than 22 degrees; each is weighed by how well it foresees what the receiver says.
"""

from collections.abc import Callable
from math import exp, log, pi

import numpy as np

from tracker.geometry import multiply, normalise, wrap_rad, wxyz_from_yaw, yaw_of
from tracker.measurements import Matrix
from tracker.precise.error_model import THETA, V
from tracker.precise.error_state import ErrorState
from tracker.precise.navigation import Navigation
from tracker.precise.update import Correction

#: A hypothesis this much less likely than the best one is dropped (natural logarithm).
HOPELESS = 12.0
#: The best one stays the best until another is more likely by this: what is shown does not waver between equals.
CHANGE_OF_MIND = 2.0
#: Two that have come so near to each other are one, rad.
ALIKE_RAD = 0.12
#: A compass is right with this probability; the rest is shared by all directions.
COMPASS_TRUST = 0.7


class Hypotheses:
    """One filter, or several with different headings."""

    def __init__(self, filter_: ErrorState) -> None:
        self._all: list[tuple[ErrorState, float]] = [(filter_, 0.0)]
        """Filters and their log weights, the best one first."""
        self.corrections = 0
        """How many measurements have been taken in."""

    @property
    def best(self) -> ErrorState:
        """The most likely filter."""
        return self._all[0][0]

    @property
    def filters(self) -> list[ErrorState]:
        """All of them."""
        return [filter_ for filter_, _ in self._all]

    @property
    def are_many(self) -> bool:
        """Whether north is still open."""
        return len(self._all) > 1

    def spread(self, count: int, yaw_rad: float | None) -> None:
        """Begin anew from the best filter: its heading turned to `count` directions, of which `yaw_rad` is preferred."""
        seed, best = self.best.copied(), []
        first_rad = yaw_of(seed.nav.wxyz_site_body) if yaw_rad is None else yaw_rad
        for index in range(count):
            offset_rad = 2.0 * pi * index / count
            trust = (
                1.0 / count
                if yaw_rad is None
                else (COMPASS_TRUST if index == 0 else (1.0 - COMPASS_TRUST) / (count - 1))
            )
            best.append((_turned(seed, wrap_rad(first_rad + offset_rad), pi / count), log(trust)))
        self._all = best

    def correct(self, correction: Callable[[ErrorState], Correction | None]) -> Correction | None:
        """Correct every filter, weigh them by what they foresaw, and return what the best one saw."""
        self.corrections += 1
        done = [(filter_, weight, correction(filter_)) for filter_, weight in self._all]
        result = done[0][2]
        if len(done) > 1:
            weighed = [(f, w + (c.log_likelihood if c is not None else 0.0)) for f, w, c in done]
            weighed.sort(key=lambda pair: -pair[1])
            highest = weighed[0][1]
            shown = self._all[0][0]
            self._all = [(f, w - highest) for f, w in weighed if highest - w < HOPELESS]
            self._all.sort(key=lambda pair: pair[0] is not shown or pair[1] < -CHANGE_OF_MIND)
            self._merge()
        return result

    def _merge(self) -> None:
        kept: list[tuple[ErrorState, float]] = []
        for filter_, weight in self._all:
            yaw = yaw_of(filter_.nav.wxyz_site_body)
            if all(abs(wrap_rad(yaw - yaw_of(other.nav.wxyz_site_body))) > ALIKE_RAD for other, _ in kept):
                kept.append((filter_, weight))
        self._all = kept

    @property
    def yaw_variance_rad2(self) -> float:
        """Of all hypotheses together."""
        total = sum(exp(weight) for _, weight in self._all)
        yaw_rad = yaw_of(self.best.nav.wxyz_site_body)
        return sum(
            exp(weight) / total * (float(f.covariance[8, 8]) + wrap_rad(yaw_of(f.nav.wxyz_site_body) - yaw_rad) ** 2)
            for f, weight in self._all
        )


def _turned(seed: ErrorState, yaw_rad: float, sigma_rad: float) -> ErrorState:
    """Return a copy that faces yaw_rad, its horizontal velocity and biases unsure again."""
    filter_ = seed.copied()
    while filter_.clones:
        filter_.forget(0)
    nav = filter_.nav
    by = wxyz_from_yaw(wrap_rad(yaw_rad - yaw_of(nav.wxyz_site_body)))
    filter_.nav = Navigation(nav.t_ns, nav.p_m, nav.v_m_s, normalise(multiply(by, nav.wxyz_site_body)))
    yaw = THETA.start + 2
    cov = filter_.covariance
    cov[yaw, :] = cov[:, yaw] = 0.0
    cov[yaw, yaw] = sigma_rad**2
    _make_independent(cov, V)
    filter_.restart_chunk()
    return filter_


def _make_independent(cov: Matrix, columns: slice) -> None:
    """Keep the variances of some states and drop what they have to do with all others."""
    variances = np.diag(cov)[columns].copy()
    cov[columns, :] = 0.0
    cov[:, columns] = 0.0
    index = np.arange(len(cov))[columns]
    cov[index, index] = np.maximum(variances, 0.25)
