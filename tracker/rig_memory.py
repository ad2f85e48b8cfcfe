"""What a rig has learned, kept in a file beside its rig file from one walk to the next.

In the file its time is UTC, since each start has a monotonic clock of its own. It is of no use once the rig was calibrated anew:
biases are what is left after the calibration.
"""

import logging
import os
from dataclasses import replace
from pathlib import Path

from tracker.errors import MalformedInput
from tracker.precise.memory import Memory, from_toml, to_toml

_logger = logging.getLogger(__name__)


def memory_place(rig_file: Path) -> Path:
    """Return where a rig's memory is kept: beside the rig file."""
    return rig_file.with_suffix(".memory.toml")


def load_memory(rig_file: Path, utc_offset_ns: int) -> Memory | None:
    """Return what the rig of a rig file remembers, by the walk's clock; None where there is nothing of use.

    Args:
        rig_file: The rig's, which need not exist.
        utc_offset_ns: UTC less the walk's clock.
    """
    path = memory_place(rig_file)
    try:
        if rig_file.is_file() and rig_file.stat().st_mtime_ns > path.stat().st_mtime_ns:
            return None
        memory = from_toml(path.read_text(encoding="utf-8"))
    except FileNotFoundError:
        return None
    except (OSError, UnicodeDecodeError, MalformedInput) as error:
        _logger.warning("%s is left out: %s", path, error)
        return None
    return replace(memory, t_ns=memory.t_ns - utc_offset_ns)


def save_memory(rig_file: Path, memory: Memory, utc_offset_ns: int) -> None:
    """Keep what a rig has learned, in one go; where that fails the rig starts anew next time."""
    path = memory_place(rig_file)
    part = path.with_name(f".{path.name}.{os.getpid()}.part")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        try:
            part.write_text(to_toml(replace(memory, t_ns=memory.t_ns + utc_offset_ns)), encoding="utf-8")
            part.replace(path)
        finally:
            part.unlink(missing_ok=True)
    except OSError as error:
        _logger.warning("%s cannot be written: %s", path, error)
