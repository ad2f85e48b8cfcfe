"""What befalls a walk: each scenario is the same walk with the same sensors, and one thing different."""

from dataclasses import dataclass
from typing import Literal

#: The walk stands for its first seconds: a person's standing, not a tripod's.
STILL_S = 20.0
DURATION_S = 300.0
#: How long an outage and a magnetic disturbance last.
SPELL_S = 60.0
#: An outage does not begin before this, nor end later than so much before the walk's end.
SPELL_FROM_S, SPELL_REST_S = 80.0, 40.0
DISTURBED_FROM_S = 140.0
#: A magnetometer that was turned is so for this long, and then silent.
TURNED_S = 10.0
#: The visitor looks to one side, ahead and to the other about here, where landmarks are pointed out.
LOOK_FROM_S = 146.0


@dataclass(frozen=True)
class Scenario:
    """One thing that is different."""

    name: str
    says: str
    magnetometer: Literal["there", "absent", "turned"] = "there"
    """`turned`: by half a turn for the first seconds, and then silent."""
    understates: float = 1.0
    """By how much the receiver's claimed sigma is too small."""
    outage: bool = False
    disturbance: bool = False
    walls: bool = False
    """Whether walls throw back to the receiver what is not for it to hear."""
    wavers: bool = False
    """Whether the receiver claims now more and now less, while its error is as ever."""
    taps: int = 0
    stands_here: bool = False
    knows_ground: bool = False
    """Whether the estimator is told the height of the ground."""


SCENARIOS = {
    scenario.name: scenario
    for scenario in (
        Scenario("plain", "an ordinary visit"),
        Scenario("no-magnetometer", "the rig has none", magnetometer="absent"),
        Scenario("understated", "the receiver claims a sigma 1.5 times too small", understates=1.5),
        Scenario("wavering", "the receiver claims now more and now less, its error as ever", wavers=True),
        Scenario("outage", "no GPS for 60 s while walking", outage=True),
        Scenario("walls", "walls throw echoes to the receiver, a few seconds at a time", walls=True),
        Scenario("disturbance", "iron turns the magnetic field for 60 s", disturbance=True),
        Scenario("turned-start", "the magnetometer is half a turn wrong at first, then silent", magnetometer="turned"),
        Scenario("three-taps", "three landmarks are pointed out", taps=3),
        Scenario("stand-here", "a surveyed point is stood on, and one landmark pointed out", taps=1, stands_here=True),
        Scenario("ground", "the height of the ground is known", knows_ground=True),
    )
}
