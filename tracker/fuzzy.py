"""The fuzzy controller of the paper: two innovations and the present motion model in, the next motion model out.

The paper prints 54 of its 81 rules (table "Rule-base for motion models"). They are separable: the position's index moves by
`NEXT_INDEX` of the positional innovation alone, the rotation's by the rotational innovation alone, and this fixes the 27 rules
that are not printed (those whose present model has rotation index 1).

Reference:
    Bostanci et al., Sensor fusion of camera, GPS and IMU using fuzzy adaptive multiple motion models, arXiv 1512.02766, section 5.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from itertools import product
from typing import Literal, TypeAlias

from tracker.measurements import Vector3

Level: TypeAlias = Literal["Low", "Medium", "High"]
Index: TypeAlias = Literal[0, 1, 2]
#: What follows coefficients 0, 1 and 2, for each level of the innovation.
NextIndex: TypeAlias = dict[Level, tuple[Index, Index, Index]]

LEVELS: tuple[Level, ...] = ("Low", "Medium", "High")
INDICES: tuple[Index, ...] = (0, 1, 2)

#: NEXT_INDEX[level][i]: the velocity coefficient that follows coefficient i. Low keeps it; Medium toggles 1 and 2 (and starts
#: a resting model); High jumps between rest and double. Derived from, and equal to, all 54 printed rows.
NEXT_INDEX: NextIndex = {"Low": (0, 1, 2), "Medium": (1, 2, 1), "High": (2, 0, 0)}


@dataclass(frozen=True, slots=True)
class MotionModel:
    """`PiRj`: the velocity coefficients of position and rotation in the transition matrix, one of the paper's nine models."""

    i: Index
    j: Index

    def __str__(self) -> str:
        return f"P{self.i}R{self.j}"


MOTION_MODELS: tuple[MotionModel, ...] = tuple(MotionModel(i, j) for i, j in product(INDICES, INDICES))
#: `P1R2` and its like, as runs and logs write them.
MODEL_BY_NAME: dict[str, MotionModel] = {str(model): model for model in MOTION_MODELS}

#: The three antecedents of a rule: positional innovation, rotational innovation, present model.
Antecedent: TypeAlias = tuple[Level, Level, MotionModel]
ANTECEDENTS: tuple[Antecedent, ...] = tuple(product(LEVELS, LEVELS, MOTION_MODELS))


def rule_name(antecedent: Antecedent) -> str:
    """Return `Low,Medium,P0R0`: how a rule is named in tables and files."""
    y_p, y_r, model = antecedent
    return f"{y_p},{y_r},{model}"


@dataclass(frozen=True)
class RuleBase:
    """81 rules under a name: for each of `ANTECEDENTS`, in their order, the model that follows.

    One flat tuple is the paper's "look-up table": a rule is read with a single query, at 27 p + 9 r + 3 i + j.
    """

    name: str
    consequents: tuple[MotionModel, ...]

    def __post_init__(self) -> None:
        if len(self.consequents) != len(ANTECEDENTS):
            raise ValueError(f"expected {len(ANTECEDENTS)} rules, got {len(self.consequents)}")

    @classmethod
    def separable(cls, name: str, position: NextIndex, rotation: NextIndex | None = None) -> "RuleBase":
        """Return the rules of two tables of nine entries; of one used twice where `rotation` is None."""
        turn = position if rotation is None else rotation
        followers = (_model(position[y_p][model.i], turn[y_r][model.j]) for y_p, y_r, model in ANTECEDENTS)
        return cls(name, tuple(followers))

    @cached_property
    def table(self) -> dict[Antecedent, MotionModel]:
        """The rules by their antecedents."""
        return dict(zip(ANTECEDENTS, self.consequents, strict=True))

    def by_name(self) -> dict[str, str]:
        """Return the rules as `{"Low,Medium,P0R0": "P0R1"}`."""
        return {rule_name(antecedent): str(model) for antecedent, model in self.table.items()}


def _model(i: Index, j: Index) -> MotionModel:
    return MOTION_MODELS[3 * i + j]


#: The paper's rule base (its table "Rule-base for motion models"), whole: what the controller uses unless told otherwise.
PAPER_RULES = RuleBase.separable("paper", NEXT_INDEX)
#: The same by antecedents.
RULES: dict[Antecedent, MotionModel] = PAPER_RULES.table


def rules_by_name() -> dict[str, str]:
    """Return the paper's 81 rules as `{"Low,Medium,P0R0": "P0R1"}`, as `agora rules --json` prints them."""
    return PAPER_RULES.by_name()


@dataclass(frozen=True, slots=True)
class Membership:
    """Three input membership functions that sum to one (a Ruspini partition): shoulder, triangle, shoulder.

    The paper's figure of them (fig. "Input membership functions") is lost; `FuzzySettings` has ours.
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

    def crossovers(self) -> tuple[float, float]:
        """Return the largest magnitudes at which Low is no weaker than Medium, and Medium no weaker than High.

        They lie half-way between the breakpoints, but for the rounding of the degrees, which is kept to the last bit: a look-up
        by these two numbers is the comparison of the degrees themselves.
        """

        def no_weaker(level: int) -> Callable[[float], bool]:
            return lambda magnitude: (d := self.degrees(magnitude))[level] >= d[level + 1]

        return _last(no_weaker(0), self.low, self.medium), _last(no_weaker(1), self.medium, self.high)


def _last(holds: Callable[[float], bool], below: float, above: float) -> float:
    """Return the last float at which something holds that holds at `below`, not at `above`, and turns once between them."""
    while below < (middle := 0.5 * (below + above)) < above:
        below, above = (middle, above) if holds(middle) else (below, middle)
    return below


@dataclass(frozen=True)
class FuzzySettings:
    """Breakpoints of the two inputs. The defaults come from the sweep (docs/paper.md, "Sensitivity"), by the rule stated there.

    Only where two functions cross has a say. From 0.8 m on for the first crossing, a standing rig with a camera lies at P0R0 so
    long that the constant model foresees better.
    """

    position_m: Vector3 = (0.15, 0.45, 2.55)
    """Innovations of position that are wholly Low, Medium and High: Low ends at 0.3 m, High begins at 1.5 m."""
    rotation_rad: Vector3 = (0.15, 0.45, 1.55)
    """Innovations of rotation that are wholly Low, Medium and High: Low ends at 0.3 rad, High begins at 1 rad."""

    def __post_init__(self) -> None:
        Membership(*self.position_m)
        Membership(*self.rotation_rad)


POSITION_MEMBERSHIP_M = Membership(*FuzzySettings().position_m)
ROTATION_MEMBERSHIP_RAD = Membership(*FuzzySettings().rotation_rad)


class FuzzyController:
    """Chooses the model of the next prediction; stateless, so one serves everybody.

    Firing strength is the product of the two degrees (product t-norm); rules for another present model have strength zero,
    which is why only the nine rules of the present model can win. The consequent of the strongest is a singleton, one model.
    A tie goes to the lower innovation, which keeps the model.

    The maximum of the products over two independent sets is the product of the two maxima, so each set is searched alone, and
    of two neighbours the stronger is told by where they cross. Every rule's strength is computed in the tests, and compared.
    """

    def __init__(
        self,
        position: Membership = POSITION_MEMBERSHIP_M,
        rotation: Membership = ROTATION_MEMBERSHIP_RAD,
        rules: RuleBase = PAPER_RULES,
    ) -> None:
        self.rules = rules
        self._consequents = rules.consequents
        self._low_p, self._medium_p = position.crossovers()
        self._low_r, self._medium_r = rotation.crossovers()

    def __deepcopy__(self, memo: dict[int, object]) -> "FuzzyController":
        return self

    def next_model(self, y_p: float, y_r: float, model: MotionModel) -> MotionModel:
        """Return the consequent of the rule that fires most strongly.

        Args:
            y_p: Magnitude of the positional innovation, in the unit of its membership functions: m, or sqrt(NIS).
            y_r: Magnitude of the rotational innovation: rad, or sqrt(NIS).
            model: The model that made the prediction.
        """
        p = 0 if y_p <= self._low_p else 1 if y_p <= self._medium_p else 2
        r = 0 if y_r <= self._low_r else 1 if y_r <= self._medium_r else 2
        return self._consequents[27 * p + 9 * r + 3 * model.i + model.j]

    def rule_fired(self, y_p: float, y_r: float, model: MotionModel) -> Antecedent:
        """Return the antecedents of the rule that fires most strongly; arguments as `next_model`'s."""
        p = 0 if y_p <= self._low_p else 1 if y_p <= self._medium_p else 2
        r = 0 if y_r <= self._low_r else 1 if y_r <= self._medium_r else 2
        return LEVELS[p], LEVELS[r], model


class ReducedController(FuzzyController):
    """The paper's future work, "rule-reduction techniques": one table of nine entries, used once for position, once for rotation.

    It is no approximation: the 81 rules are this table twice, so both controllers choose alike, and 9 rules say what 81 said.
    """

    def __init__(
        self,
        position: Membership = POSITION_MEMBERSHIP_M,
        rotation: Membership = ROTATION_MEMBERSHIP_RAD,
        next_index: NextIndex = NEXT_INDEX,
    ) -> None:
        super().__init__(position, rotation, RuleBase.separable("reduced", next_index))
        self._next_index = tuple(next_index[level] for level in LEVELS)

    def next_model(self, y_p: float, y_r: float, model: MotionModel) -> MotionModel:
        """Return what follows each of the two coefficients by its own innovation; arguments as `FuzzyController.next_model`'s."""
        p = 0 if y_p <= self._low_p else 1 if y_p <= self._medium_p else 2
        r = 0 if y_r <= self._low_r else 1 if y_r <= self._medium_r else 2
        following = self._next_index
        return MOTION_MODELS[3 * following[p][model.i] + following[r][model.j]]
