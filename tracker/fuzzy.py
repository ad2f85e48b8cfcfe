"""The fuzzy controller of the paper: two innovations and the present motion model in, the next motion model out.

The paper prints 54 of its 81 rules (table "Rule-base for motion models"). They are separable: the position's index moves by
`NEXT_INDEX` of the positional innovation alone, the rotation's by the rotational innovation alone, and this fixes the 27 rules
that are not printed (those whose present model has rotation index 1).
"""

from dataclasses import dataclass
from itertools import product
from typing import Literal, TypeAlias

Level: TypeAlias = Literal["Low", "Medium", "High"]
Index: TypeAlias = Literal[0, 1, 2]

LEVELS: tuple[Level, ...] = ("Low", "Medium", "High")
INDICES: tuple[Index, ...] = (0, 1, 2)

#: NEXT_INDEX[level][i]: the velocity coefficient that follows coefficient i. Low keeps it; Medium toggles 1 and 2 (and starts
#: a resting model); High jumps between rest and double. Derived from, and equal to, all 54 printed rows.
NEXT_INDEX: dict[Level, tuple[Index, Index, Index]] = {"Low": (0, 1, 2), "Medium": (1, 2, 1), "High": (2, 0, 0)}


@dataclass(frozen=True, slots=True)
class MotionModel:
    """`PiRj`: the velocity coefficients of position and rotation in the transition matrix."""

    i: Index
    j: Index

    def __str__(self) -> str:
        return f"P{self.i}R{self.j}"


MOTION_MODELS: tuple[MotionModel, ...] = tuple(MotionModel(i, j) for i, j in product(INDICES, INDICES))

#: The whole rule base as a look-up table, read with a single query as the paper asks.
RULES: dict[tuple[Level, Level, MotionModel], MotionModel] = {
    (y_p, y_r, model): MotionModel(NEXT_INDEX[y_p][model.i], NEXT_INDEX[y_r][model.j])
    for y_p, y_r, model in product(LEVELS, LEVELS, MOTION_MODELS)
}


def rules_by_name() -> dict[str, str]:
    """Return the 81 rules as `{"Low,Medium,P0R0": "P0R1"}`, as `agora rules --json` prints them."""
    return {f"{y_p},{y_r},{model}": str(following) for (y_p, y_r, model), following in RULES.items()}


@dataclass(frozen=True, slots=True)
class Membership:
    """Three input membership functions that sum to one (a Ruspini partition): shoulder, triangle, shoulder.

    The paper's figure of them is lost; these breakpoints are our default, chosen so that its stationary set (mean filter error
    0.15 to 0.37 m) is Low and its walking sets (0.5 to 1.2 m) are Low to Medium.
    """

    low: float
    """Up to here the innovation is wholly Low."""
    medium: float
    """Here it is wholly Medium."""
    high: float
    """From here on it is wholly High."""

    def __post_init__(self) -> None:
        if not 0.0 <= self.low < self.medium < self.high:
            raise ValueError(f"expected 0 <= low < medium < high, got {self.low}, {self.medium}, {self.high}")

    def degrees(self, magnitude: float) -> tuple[float, float, float]:
        """Return the degrees of Low, Medium and High for a magnitude >= 0."""
        if magnitude <= self.low:
            return 1.0, 0.0, 0.0
        if magnitude <= self.medium:
            medium = (magnitude - self.low) / (self.medium - self.low)
            return 1.0 - medium, medium, 0.0
        if magnitude <= self.high:
            high = (magnitude - self.medium) / (self.high - self.medium)
            return 0.0, 1.0 - high, high
        return 0.0, 0.0, 1.0


POSITION_MEMBERSHIP_M = Membership(0.5, 1.5, 3.0)
ROTATION_MEMBERSHIP_RAD = Membership(0.05, 0.15, 0.40)


class FuzzyController:
    """Chooses the model of the next prediction; stateless, so one serves everybody."""

    def __init__(
        self, position: Membership = POSITION_MEMBERSHIP_M, rotation: Membership = ROTATION_MEMBERSHIP_RAD
    ) -> None:
        self._position = position
        self._rotation = rotation

    def next_model(self, y_p_m: float, y_r_rad: float, model: MotionModel) -> MotionModel:
        """Return the consequent of the rule that fires most strongly.

        Firing strength is the product of the two degrees (product t-norm); rules for another present model have strength zero,
        which is why only the nine rules of `model` are looked at. A tie goes to the lower innovation, which keeps the model.

        Args:
            y_p_m: Magnitude of the positional innovation.
            y_r_rad: Magnitude of the rotational innovation.
            model: The model that made the prediction.
        """
        level_p = _strongest(self._position.degrees(y_p_m))
        level_r = _strongest(self._rotation.degrees(y_r_rad))
        return RULES[level_p, level_r, model]


def _strongest(degrees: tuple[float, float, float]) -> Level:
    """Return the level of highest degree, the lower one on a tie.

    The maximum of the products over two independent sets is the product of the two maxima, so each set is searched alone.
    """
    low, medium, high = degrees
    if low >= medium and low >= high:
        return "Low"
    return "Medium" if medium >= high else "High"
