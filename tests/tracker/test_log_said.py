"""What visitors say, in a log and out of it again, to the last bit."""

from math import nan
from pathlib import Path

import pytest

from tracker.log import Log
from tracker.log_writer import LogWriter
from tracker.measurements import ImuSample, Measurement, Retraction, Sighting, Standpoint
from tracker.rig import Rig
from tracker.soundness import Soundness

S = 1_000_000_000
RAY = (0.6, 0.0, 0.8)
SAID: tuple[Measurement, ...] = (
    Sighting(5 * S, 7 * S, (10.1, -20.2, 3.3), RAY, 0.012),
    Sighting(5 * S, 7 * S + 1, (11.1, -20.2, 3.3), RAY, 0.012),
    Sighting(4 * S, 7 * S + 2, (10.1, -20.2, 3.3), RAY, 0.012),
    Standpoint(7 * S, 8 * S, (1.0, 2.0, 1.65), 0.5),
    Retraction(9 * S, 9 * S),
    Retraction(9 * S, 9 * S + 1),
)


def test_what_was_said_is_read_as_it_was_written(tmp_path: Path) -> None:
    """Two landmarks in one picture, and one in an older picture after them, are all there."""
    with LogWriter(tmp_path / "said.mcap", Rig()) as writer:
        writer.write(ImuSample(S, S, (0.0, 0.0, 0.0), (0.0, 0.0, 9.8)))
        for measurement in SAID:
            writer.write(measurement)
    log = Log.open(tmp_path / "said.mcap")
    assert log.info.counts["said"] == len(SAID)
    assert tuple(m for m in log.messages() if not isinstance(m, ImuSample)) == SAID
    assert not log.skipped


@pytest.mark.parametrize(
    "broken",
    [
        Sighting(S, S, (nan, 0.0, 0.0), RAY, 0.01),
        Sighting(S, S, (0.0, 0.0, 0.0), (0.0, nan, 1.0), 0.01),
        Sighting(S, S, (0.0, 0.0, 0.0), RAY, nan),
        Standpoint(S, S, (0.0, 0.0, nan), 0.5),
        Standpoint(S, S, (0.0, 0.0, 0.0), nan),
    ],
)
def test_what_is_no_number_is_left_out(broken: Measurement) -> None:
    assert Soundness().fault(broken) == "not_finite"
