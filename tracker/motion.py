"""Who chooses the motion model of the next prediction: one interface for the paper's two ways and their rivals.

`cmm` and `famm` are the paper's; `reduced` is its future work, `dfa` the authors' earlier automaton, `imm` the classic way.
"""

from typing import Protocol, Self

from tracker.dfa import Automaton
from tracker.fusion import FusionFilter, FusionSettings
from tracker.fuzzy import FuzzyController, FuzzySettings, Membership, MotionModel, ReducedController
from tracker.imm import InteractingFilter
from tracker.measurements import Matrix, Vector3

#: The paper's constant motion model "correspond[s] to P1R1".
CONSTANT = MotionModel(1, 1)
#: A rig is at rest for its calibration, and Low keeps a model: only a start here gives the paper's P0R0 on its stationary set.
AT_REST = MotionModel(0, 0)


class MotionFilter(Protocol):
    """What the paper's system asks of its filter: one of twelve states, or several that interact."""

    @classmethod
    def start(
        cls, settings: FusionSettings, position_m: Vector3, rotation_rad: Vector3, position_var_m2: Vector3
    ) -> Self:
        """Return a filter at its first measurement."""
        ...

    @property
    def var_value(self) -> list[float]:
        """Variances of P and R."""
        ...

    @property
    def position_m(self) -> Vector3:
        """P in the site frame."""
        ...

    @property
    def rpy_rad(self) -> Vector3:
        """R: roll, pitch, yaw."""
        ...

    def covariance(self) -> Matrix:
        """Return Sigma, (12, 12), in the paper's order."""
        ...

    def predict(self, dt_s: float, model: MotionModel) -> None:
        """Apply F with the model's coefficients."""
        ...

    def innovation(self, position_m: Vector3, rotation_rad: Vector3) -> tuple[Vector3, Vector3]:
        """Return z - H x in its two parts."""
        ...

    def update(self, y_p_m: Vector3, y_r_rad: Vector3, position_var_m2: Vector3) -> None:
        """Take an innovation in."""
        ...

    def widen(self, position_var_m2: float) -> None:
        """Doubt the position."""
        ...

    def move_to(self, position_m: Vector3) -> None:
        """Take a position as it is."""
        ...

    def turn(self, yaw_rad: float) -> None:
        """Turn about the vertical."""
        ...


class MotionSelector(Protocol):
    """Chooses velocity coefficients after an update, and says which filter they are for."""

    filter_kind: type[MotionFilter]

    @classmethod
    def of(cls, settings: FuzzySettings) -> "MotionSelector":
        """Return one with these breakpoints, where it has any."""
        ...

    @property
    def first(self) -> MotionModel:
        """The model of the first prediction."""
        ...

    def following(self, y_p_m: float, y_r_rad: float, filter_: MotionFilter, model: MotionModel) -> MotionModel:
        """Return the model of the next prediction: by the size of the innovation, the filter after it, the model before it."""
        ...


class ConstantMotion:
    """CMM: position and rotation always move on with their velocities."""

    filter_kind: type[MotionFilter] = FusionFilter
    first = CONSTANT

    @classmethod
    def of(cls, settings: FuzzySettings) -> "ConstantMotion":
        """Return one; it has no breakpoints."""
        return cls()

    def following(self, y_p_m: float, y_r_rad: float, filter_: MotionFilter, model: MotionModel) -> MotionModel:
        """Return P1R1, whatever the innovation."""
        return CONSTANT


class FuzzyMotion:
    """FAMM: the fuzzy controller chooses among nine (the paper's fig. "Fuzzy rule-based selection of motion models")."""

    filter_kind: type[MotionFilter] = FusionFilter
    first = AT_REST

    controller_kind: type[FuzzyController] = FuzzyController

    def __init__(self, controller: FuzzyController | None = None) -> None:
        self._controller = controller or self.controller_kind()

    @classmethod
    def of(cls, settings: FuzzySettings) -> "FuzzyMotion":
        """Return one with these breakpoints."""
        return cls(cls.controller_kind(Membership(*settings.position_m), Membership(*settings.rotation_rad)))

    def following(self, y_p_m: float, y_r_rad: float, filter_: MotionFilter, model: MotionModel) -> MotionModel:
        """Return the consequent of the strongest rule."""
        return self._controller.next_model(y_p_m, y_r_rad, model)


class ReducedMotion(FuzzyMotion):
    """FAMM with the paper's rule base reduced to nine rules, used twice."""

    controller_kind = ReducedController


class AutomatonMotion:
    """DFA: crisp thresholds on the innovation lead from one of the nine to another."""

    filter_kind: type[MotionFilter] = FusionFilter
    first = AT_REST

    def __init__(self, automaton: Automaton | None = None) -> None:
        self._automaton = automaton or Automaton()

    @classmethod
    def of(cls, settings: FuzzySettings) -> "AutomatonMotion":
        """Return one whose thresholds are the first crossings of these."""
        return cls(Automaton.of(settings))

    def following(self, y_p_m: float, y_r_rad: float, filter_: MotionFilter, model: MotionModel) -> MotionModel:
        """Return the automaton's next state."""
        return self._automaton.next_model(y_p_m, y_r_rad, model)


class InteractingMotion:
    """IMM: nothing is chosen, all nine run; the likeliest is named."""

    filter_kind: type[MotionFilter] = InteractingFilter
    first = CONSTANT

    @classmethod
    def of(cls, settings: FuzzySettings) -> "InteractingMotion":
        """Return one; it has no breakpoints."""
        return cls()

    def following(self, y_p_m: float, y_r_rad: float, filter_: MotionFilter, model: MotionModel) -> MotionModel:
        """Return the likeliest model."""
        return filter_.most_likely if isinstance(filter_, InteractingFilter) else model
