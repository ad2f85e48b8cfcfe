"""What is said of one thing that was looked at."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from enum import Enum
from types import MappingProxyType


class State(Enum):
    """How it is."""

    WELL = "well"
    ADVICE = "advice"
    """A walk runs without it, and better with it."""
    AMISS = "amiss"
    """It was asked for, and does not do."""
    ABSENT = "absent"
    """It is not there, and was not asked for."""


@dataclass(frozen=True, slots=True)
class Verdict:
    """One line of the page."""

    group: str
    name: str
    state: State
    sentence: str
    """What is, and where that is not well, what to do."""
    facts: Mapping[str, object] = field(default_factory=lambda: MappingProxyType({}))
    """Figures for programs, as JSON values."""
    part: str = ""
    """Of what is named, where one line is not enough for it."""

    def as_json(self) -> dict[str, object]:
        """Return it as JSON values."""
        return {
            "group": self.group,
            "name": self.name,
            "part": self.part,
            "state": self.state.value,
            "sentence": self.sentence,
            "facts": dict(self.facts),
        }


def all_is_well(verdicts: Iterable[Verdict]) -> bool:
    """Return whether all that was asked for does what it should."""
    return all(verdict.state is not State.AMISS for verdict in verdicts)
