"""IMM: interacting multiple models over the paper's nine, the classic rival of its fuzzy choice.

FAMM runs one filter and chooses its model by rules; IMM runs a filter per model, mixes them by a Markov chain and weighs them by
their likelihoods. Position and rotation meet nowhere in F, H, Q and R, so with a chain whose two indices switch independently
the nine filters are the pairs of three position filters and three rotation filters: three `FusionFilter` do the work. What mixing
would add to the covariance between two axes of one part (where both disagree at once) is left out: the filter has no place for it.

Reference:
    Blom and Bar-Shalom, The interacting multiple model algorithm for systems with Markovian switching coefficients, IEEE
    Transactions on Automatic Control 33 (8), 1988.
"""

from dataclasses import dataclass, field
from math import exp, log

import numpy as np

from tracker.fusion import FusionFilter, FusionSettings, innovation
from tracker.fuzzy import INDICES, Index, MotionModel
from tracker.geometry import wrap_rad
from tracker.measurements import Matrix, Vector3

POSITION, ROTATION = (0, 1, 2), (3, 4, 5)
#: Probability that an index stays what it is from one cycle to the next; the two others share the rest.
STAYS = 0.95


@dataclass
class InteractingFilter:
    """Three filters, of which number c multiplies velocities by c; in everything else it is used as a `FusionFilter` is."""

    members: list[FusionFilter]
    position_probability: list[float] = field(default_factory=lambda: [1.0 / 3.0] * 3)
    """Of the coefficients 0, 1 and 2 for position."""
    rotation_probability: list[float] = field(default_factory=lambda: [1.0 / 3.0] * 3)

    @classmethod
    def start(
        cls, settings: FusionSettings, position_m: Vector3, rotation_rad: Vector3, position_var_m2: Vector3
    ) -> "InteractingFilter":
        """Return a filter at its first measurement."""
        return cls([FusionFilter.start(settings, position_m, rotation_rad, position_var_m2) for _ in INDICES])

    @property
    def most_likely(self) -> MotionModel:
        """The model of the highest probability; the lower index on a tie."""
        return MotionModel(_highest(self.position_probability), _highest(self.rotation_probability))

    def predict(self, dt_s: float, model: MotionModel) -> None:
        """Mix the filters by the chain, then predict each with its own coefficient; `model` is not asked."""
        self.position_probability = self._mix(POSITION, self.position_probability)
        self.rotation_probability = self._mix(ROTATION, self.rotation_probability)
        for c, member in zip(INDICES, self.members, strict=True):
            member.predict(dt_s, MotionModel(c, c))

    def innovation(self, position_m: Vector3, rotation_rad: Vector3) -> tuple[Vector3, Vector3]:
        """Return z minus the combined prediction, in its two parts."""
        return innovation(self.value, position_m, rotation_rad)

    def update(self, y_p_m: Vector3, y_r_rad: Vector3, position_var_m2: Vector3) -> None:
        """Take an innovation of the combined prediction into each filter, and weigh the filters by how well they foresaw it."""
        combined = self.value
        rotation_var = self.members[0].settings.rotation_sigma_rad ** 2
        position_log, rotation_log = [0.0] * 3, [0.0] * 3
        for c, member in enumerate(self.members):
            off = [combined[axis] - member.value[axis] for axis in range(6)]
            own_r = (wrap_rad(y_r_rad[0] + off[3]), wrap_rad(y_r_rad[1] + off[4]), wrap_rad(y_r_rad[2] + off[5]))
            rotation_log[c] = sum(_log_density(own_r[i], member.var_value[i + 3] + rotation_var) for i in range(3))
            own_p = (y_p_m[0] + off[0], y_p_m[1] + off[1], y_p_m[2] + off[2])
            spread = [member.var_value[i] + position_var_m2[i] for i in range(3)]
            position_log[c] = sum(_log_density(own_p[i], spread[i]) for i in range(3))
            member.update(own_p, own_r, position_var_m2)
        self.position_probability = _weighed(self.position_probability, position_log)
        self.rotation_probability = _weighed(self.rotation_probability, rotation_log)

    def widen(self, position_var_m2: float) -> None:
        """Doubt the position, in every filter."""
        for member in self.members:
            member.widen(position_var_m2)

    def move_to(self, position_m: Vector3) -> None:
        """Take a position as it is, in every filter."""
        for member in self.members:
            member.move_to(position_m)

    def turn(self, yaw_rad: float) -> None:
        """Turn about the vertical, in every filter."""
        for member in self.members:
            member.turn(yaw_rad)

    # -- what they say together ---------------------------------------------------------------------------------------

    @property
    def value(self) -> list[float]:
        """P and R, as `FusionFilter.value`."""
        return [self._mean(axis, self._probability(axis)) for axis in range(6)]

    @property
    def var_value(self) -> list[float]:
        """Their variances, the disagreement between the filters included."""
        found = []
        for axis in range(6):
            weights = self._probability(axis)
            mean = self._mean(axis, weights)
            found.append(
                sum(
                    w * (m.var_value[axis] + _apart(axis, m.value[axis], mean) ** 2)
                    for w, m in zip(weights, self.members, strict=True)
                )
            )
        return found

    @property
    def position_m(self) -> Vector3:
        """P in the site frame."""
        x, y, z = self.value[:3]
        return (x, y, z)

    @property
    def velocity_m_s(self) -> Vector3:
        """V in the site frame."""
        x, y, z = (
            sum(w * m.rate[axis] for w, m in zip(self.position_probability, self.members, strict=True))
            for axis in POSITION
        )
        return (x, y, z)

    @property
    def rpy_rad(self) -> Vector3:
        """R: roll, pitch, yaw."""
        roll, pitch, yaw = self.value[3:]
        return (roll, pitch, yaw)

    def covariance(self) -> Matrix:
        """Return Sigma of all together, (12, 12), in the paper's order."""
        sigma = np.zeros((12, 12))
        for axis in range(6):
            v = axis if axis in POSITION else axis + 3
            _, _, sigma[v, v], covar, sigma[v + 3, v + 3] = self._moments(axis, self._probability(axis))
            sigma[v, v + 3] = sigma[v + 3, v] = covar
        return sigma

    # -- mixing -------------------------------------------------------------------------------------------------------

    def _probability(self, axis: int) -> list[float]:
        return self.position_probability if axis in POSITION else self.rotation_probability

    def _mean(self, axis: int, weights: list[float]) -> float:
        """Return a weighted mean; angles are averaged about the filter that walks on with its velocity."""
        middle = self.members[1].value[axis]
        mean = middle + sum(w * _apart(axis, m.value[axis], middle) for w, m in zip(weights, self.members, strict=True))
        return wrap_rad(mean) if axis in ROTATION else mean

    def _mix(self, axes: tuple[int, int, int], probability: list[float]) -> list[float]:
        """Give every filter the mean and spread of all, as each of them may have become it; return the prior probabilities."""
        prior = [sum(_switch(i, j) * probability[i] for i in INDICES) for j in INDICES]
        weights = [[_switch(i, j) * probability[i] / prior[j] for i in INDICES] for j in INDICES]
        for axis in axes:
            mixed = [self._moments(axis, weights[j]) for j in INDICES]
            for member, (value, rate, var_value, covar, var_rate) in zip(self.members, mixed, strict=True):
                member.value[axis], member.rate[axis] = value, rate
                member.var_value[axis], member.covar[axis], member.var_rate[axis] = var_value, covar, var_rate
        return prior

    def _moments(self, axis: int, weights: list[float]) -> tuple[float, float, float, float, float]:
        """Return mean value and rate of one axis, and their variances and covariance with the spread of the means."""
        value = self._mean(axis, weights)
        rate = sum(w * m.rate[axis] for w, m in zip(weights, self.members, strict=True))
        var_value = covar = var_rate = 0.0
        for w, m in zip(weights, self.members, strict=True):
            dv, dr = _apart(axis, m.value[axis], value), m.rate[axis] - rate
            var_value += w * (m.var_value[axis] + dv * dv)
            covar += w * (m.covar[axis] + dv * dr)
            var_rate += w * (m.var_rate[axis] + dr * dr)
        return value, rate, var_value, covar, var_rate


def _switch(i: Index, j: Index) -> float:
    """Return the chain's probability that index i becomes j."""
    return STAYS if i == j else (1.0 - STAYS) / 2.0


def _apart(axis: int, a: float, b: float) -> float:
    return wrap_rad(a - b) if axis in ROTATION else a - b


def _log_density(y: float, variance: float) -> float:
    """Return the logarithm of a normal density, without the constant that all filters share."""
    return -0.5 * (y * y / variance + log(variance))


def _weighed(prior: list[float], log_likelihood: list[float]) -> list[float]:
    """Return prior times likelihood, normalised; in logarithms, because an outlier's likelihoods are too small for floats."""
    highest = max(log_likelihood)
    weights = [p * exp(one - highest) for p, one in zip(prior, log_likelihood, strict=True)]
    total = sum(weights)
    return [w / total for w in weights]


def _highest(probability: list[float]) -> Index:
    return max(INDICES, key=lambda i: (probability[i], -i))
