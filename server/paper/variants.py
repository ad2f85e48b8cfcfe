"""What the sweep tries: one factor at a time around the defaults, a grid over each membership, and other rules by name.

With maximum firing strength and a singleton output the fuzzy controller is a crisp automaton whose thresholds lie where two
neighbouring membership functions cross: of the three breakpoints only the two crossings matter. Rules, F, Q and R treat position
and rotation apart, so a membership of one has no say in the other's errors: two grids tell all that a joint one would.
"""

from collections.abc import Iterator
from dataclasses import asdict, dataclass, field, replace
from itertools import product
from typing import Any

from tracker.cycle import InnovationReading
from tracker.fusion import FusionSettings
from tracker.fuzzy import (
    NEXT_INDEX,
    PAPER_RULES,
    POSITION_MEMBERSHIP_M,
    ROTATION_MEMBERSHIP_RAD,
    FuzzyController,
    Membership,
    NextIndex,
    RuleBase,
)
from tracker.motion import FuzzyMotion

#: Crossings of Low and Medium, then of Medium and High.
POSITION_LOW_M = (0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.8, 1.0, 1.25, 1.5)
POSITION_HIGH_M = (0.8, 1.5, 2.25, 3.5)
ROTATION_LOW_RAD = (0.02, 0.035, 0.05, 0.075, 0.1, 0.15, 0.2, 0.3)
ROTATION_HIGH_RAD = (0.1, 0.15, 0.275, 0.5, 1.0)
#: The whole position's membership stretched until Low meets Medium here, for the stationary set.
REST_LOW_M = (0.6, 0.8, 1.0, 1.1, 1.2, 1.3, 1.4, 1.5, 1.75, 2.0, 2.5, 3.0, 3.25, 3.5, 3.75, 4.0, 5.0)
ACCEL_NOISE_M_S2 = (0.5, 1.0, 2.0, 3.0, 4.5, 6.0)
ANGULAR_NOISE_RAD_S2 = (0.25, 0.5, 1.0, 2.0, 4.0)
ROTATION_SIGMA_RAD = (0.0011, 0.0022, 0.0044, 0.0088, 0.0176)
VAR_SCALES = (0.25, 0.5, 1.0, 2.0, 4.0)

#: Rule bases beside the paper's: tables as `tracker.fuzzy.NEXT_INDEX`, for position and rotation alike.
OTHER_RULES: dict[str, NextIndex] = {
    "low-settles": {**NEXT_INDEX, "Low": (0, 1, 1)},
    "low-rests": {**NEXT_INDEX, "Low": (0, 0, 1)},
    "medium-walks": {**NEXT_INDEX, "Medium": (1, 1, 1)},
    "high-starts-walking": {**NEXT_INDEX, "High": (1, 0, 0)},
    "low-walks": {**NEXT_INDEX, "Low": (1, 1, 2)},
    "never-doubles": {"Low": (0, 1, 1), "Medium": (1, 1, 1), "High": (1, 0, 0)},
}
RULE_MEANINGS = {
    "paper": "the paper's 81 rules",
    "low-settles": "Low returns 2 to 1: a doubled velocity lasts only while it is needed",
    "low-rests": "Low steps down, 2 to 1 and 1 to 0: what is foreseen well goes to rest",
    "medium-walks": "Medium means 1 always: it never doubles",
    "high-starts-walking": "High takes a resting model to 1 in place of 2",
    "low-walks": "Low takes a resting model to 1: rest does not last",
    "never-doubles": "0 and 1 only: Low keeps, Medium walks, High toggles",
}


@dataclass(frozen=True)
class Variant:
    """FAMM with some of its settings changed; CMM beside it has the same Q and R."""

    factor: str
    """What is varied."""
    value: str
    """To what, in words."""
    position: Membership = POSITION_MEMBERSHIP_M
    rotation: Membership = ROTATION_MEMBERSHIP_RAD
    rules: RuleBase = PAPER_RULES
    fusion: FusionSettings = field(default_factory=FusionSettings)
    var_scale: float = 1.0
    innovation: InnovationReading = "metres"

    @property
    def name(self) -> str:
        """Unique among `variants()`."""
        return f"{self.factor} {self.value}"

    def selector(self) -> FuzzyMotion:
        """Return its FAMM, new."""
        return FuzzyMotion(FuzzyController(self.position, self.rotation, self.rules))

    def described(self) -> dict[str, Any]:
        """Return all that it is, as JSON holds it."""
        return {
            "factor": self.factor,
            "value": self.value,
            "position_m": list(asdict(self.position).values()),
            "rotation_rad": list(asdict(self.rotation).values()),
            "rules": self.rules.name,
            "fusion": asdict(self.fusion),
            "gps_variance_scale": self.var_scale,
            "innovation": self.innovation,
        }


DEFAULT = Variant("default", "as shipped")


def crossing_at(low: float, high: float) -> Membership:
    """Return the membership of the shipped one's shape whose functions cross at these two magnitudes.

    Raises:
        ValueError: They are too near to each other for that shape: high <= 1.5 low.
    """
    return Membership(0.5 * low, 1.5 * low, 2.0 * high - 1.5 * low)


def variants() -> list[Variant]:
    """Return all that the sweep tries, the default first."""
    return [DEFAULT, *_positions(), *_rotations(), *_stretched(), *_noises(), *_rules(), *_nis()]


def _positions() -> Iterator[Variant]:
    for low in POSITION_LOW_M:
        for high in (high for high in POSITION_HIGH_M if high > 1.5 * low):
            yield Variant("position", f"{low:g} m, {high:g} m", position=crossing_at(low, high))


def _rotations() -> Iterator[Variant]:
    for low in ROTATION_LOW_RAD:
        for high in (high for high in ROTATION_HIGH_RAD if high > 1.5 * low):
            yield Variant("rotation", f"{low:g} rad, {high:g} rad", rotation=crossing_at(low, high))


def _stretched() -> Iterator[Variant]:
    low, medium, high = asdict(POSITION_MEMBERSHIP_M).values()
    for scale in (low_m / (0.5 * (low + medium)) for low_m in REST_LOW_M):
        if scale <= 1.0:
            continue
        yield Variant("rest", f"{scale:.4g}", position=Membership(scale * low, scale * medium, scale * high))


def _noises() -> Iterator[Variant]:
    usual = FusionSettings()
    for value in ACCEL_NOISE_M_S2:
        yield Variant("accel noise", f"{value:g} m/s2", fusion=replace(usual, accel_noise_m_s2=value))
    for value, low_m in product(ACCEL_NOISE_M_S2[1:3], POSITION_LOW_M[1:5]):
        fusion = replace(usual, accel_noise_m_s2=value)
        yield Variant(
            "accel noise with position", f"{value:g} m/s2, {low_m:g} m", crossing_at(low_m, 2.25), fusion=fusion
        )
    for value in ANGULAR_NOISE_RAD_S2:
        yield Variant("angular noise", f"{value:g} rad/s2", fusion=replace(usual, angular_accel_noise_rad_s2=value))
    for value in ROTATION_SIGMA_RAD:
        yield Variant("rotation sigma", f"{value:g} rad", fusion=replace(usual, rotation_sigma_rad=value))
    for value in VAR_SCALES:
        yield Variant("GPS variance", f"x {value:g}", var_scale=value)


def _rules() -> Iterator[Variant]:
    for name, table in OTHER_RULES.items():
        yield Variant("rules", name, rules=RuleBase.separable(name, table))


def _nis() -> Iterator[Variant]:
    for scale in (0.25, 0.5, 1.0):
        by = Membership(scale, 2.0 * scale, 3.0 * scale)
        yield Variant("innovation", f"nis x {scale:g}", position=by, rotation=by, innovation="nis")
