"""The crisp rival of the fuzzy controller: a deterministic finite automaton on the innovation, as in the authors' earlier work.

Its states are the nine motion models and its alphabet is whether an innovation is small or large, by one threshold for position
and one for rotation. What foresaw well is kept; else a resting model begins to move, and single and double velocity take turns.

Only the abstract and the introduction of that paper could be had: states, and that the innovation drives it, are theirs; thresholds
and transitions are ours. The transitions are those that the fuzzy rules have for Medium. Of the eight ways in which a large
innovation can lead away from every coefficient, only the two that never come back to rest have, as the authors say of theirs, a
smaller filter error than the constant model (measured on two walks; the others' is larger by a tenth to a third).

Three crisp levels in place of two would be no rival: a fuzzy controller that takes the strongest of rules over a partition that
sums to one changes its mind where two memberships cross, and nowhere else, so it is itself such an automaton. The thresholds are
the first of these crossings (half-way between wholly Low and wholly Medium): the two differ in what High does, and in nothing else.

Reference:
    Bostanci, Motion model transitions in GPS-IMU sensor fusion for user tracking in augmented reality, 2015.
"""

from dataclasses import dataclass

from tracker.fuzzy import (
    MOTION_MODELS,
    NEXT_INDEX,
    POSITION_MEMBERSHIP_M,
    ROTATION_MEMBERSHIP_RAD,
    FuzzySettings,
    Index,
    Membership,
    MotionModel,
)

#: NEXT_STATE[i]: the velocity coefficient that follows coefficient i after a large innovation.
NEXT_STATE: tuple[Index, Index, Index] = NEXT_INDEX["Medium"]


@dataclass(frozen=True, slots=True)
class Automaton:
    """Stateless: the model that it is in is handed to it, as to the fuzzy controller."""

    position: float = POSITION_MEMBERSHIP_M.crossovers()[0]
    """The largest innovation that is small, m (or sqrt(NIS))."""
    rotation: float = ROTATION_MEMBERSHIP_RAD.crossovers()[0]
    """The same of rotation, rad (or sqrt(NIS))."""

    def __post_init__(self) -> None:
        if not (self.position > 0.0 and self.rotation > 0.0):
            raise ValueError(f"expected thresholds above 0, got {self.position}, {self.rotation}")

    @classmethod
    def of(cls, settings: FuzzySettings) -> "Automaton":
        """Return one whose thresholds are where Low and Medium cross."""
        return cls(Membership(*settings.position_m).crossovers()[0], Membership(*settings.rotation_rad).crossovers()[0])

    def next_model(self, y_p: float, y_r: float, model: MotionModel) -> MotionModel:
        """Return the state that follows; an innovation that is no number is large.

        Args:
            y_p: Magnitude of the positional innovation, in the threshold's unit.
            y_r: Magnitude of the rotational innovation, in the threshold's unit.
            model: The present state: the model that made the prediction.
        """
        i = model.i if y_p <= self.position else NEXT_STATE[model.i]
        j = model.j if y_r <= self.rotation else NEXT_STATE[model.j]
        return MOTION_MODELS[3 * i + j]
