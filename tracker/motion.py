"""Who chooses the motion model of the next prediction: one interface for constant and fuzzy."""

from typing import Protocol

from tracker.fuzzy import FuzzyController, MotionModel

#: The paper's constant motion model "correspond[s] to P1R1".
CONSTANT = MotionModel(1, 1)
#: A rig is at rest for its calibration, and Low keeps a model: only a start here gives the paper's P0R0 on its stationary set.
AT_REST = MotionModel(0, 0)


class MotionSelector(Protocol):
    """Chooses velocity coefficients from the innovation of the update before."""

    @property
    def first(self) -> MotionModel:
        """The model of the first prediction."""
        ...

    def following(self, y_p_m: float, y_r_rad: float, model: MotionModel) -> MotionModel:
        """Return the model of the next prediction."""
        ...


class ConstantMotion:
    """CMM: position and rotation always move on with their velocities."""

    first = CONSTANT

    def following(self, y_p_m: float, y_r_rad: float, model: MotionModel) -> MotionModel:
        """Return P1R1, whatever the innovation."""
        return CONSTANT


class FuzzyMotion:
    """FAMM: the fuzzy controller chooses among nine."""

    first = AT_REST

    def __init__(self, controller: FuzzyController | None = None) -> None:
        self._controller = controller or FuzzyController()

    def following(self, y_p_m: float, y_r_rad: float, model: MotionModel) -> MotionModel:
        """Return the consequent of the strongest rule."""
        return self._controller.next_model(y_p_m, y_r_rad, model)
