"""What a calibration has come to: tables for the rig file, sentences for people, numbers for machines, figures for both."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from datetime import date
from pathlib import Path
from typing import Any

from server.blocks import Block, Document, Items, Shown
from server.plots.style import Picture
from tracker.rig_file import RigFile, read_rig_file, write_rig_file


@dataclass(frozen=True)
class Result:
    """One calibration's outcome."""

    title: str
    sheets: Mapping[str, Any]
    """Tables to keep, by their names in the rig file; none where nothing is good enough."""
    found: Sequence[str]
    """What was found and how good it is, sentence by sentence."""
    doubts: Sequence[str]
    """What was not good enough to keep, and what to do."""
    numbers: Mapping[str, Any]
    """JSON values."""
    pictures: Callable[[], Sequence[Picture]]
    """Draws the figures; late, since drawing takes a second."""

    def as_json(self) -> dict[str, Any]:
        """Return it for a machine."""
        return {"calibration": self.title, "kept": sorted(self.sheets), "doubts": list(self.doubts), **self.numbers}

    def document(self) -> Document:
        """Return it as a page."""
        blocks: list[Block] = [Items((*self.found, *self.doubts))]
        blocks += [Shown(picture) for picture in self.pictures()]
        kept = f"Kept in the rig file: {', '.join(sorted(self.sheets))}." if self.sheets else "Nothing was kept."
        return Document(f"Calibration of the {self.title}", kept, tuple(blocks))

    def keep(self, path: Path) -> None:
        """Write the tables into a rig file, and leave all others in it as they are.

        Raises:
            InputError: The file cannot be read or written.
        """
        before = read_rig_file(path) if path.exists() else RigFile()
        write_rig_file(path, replace(before, **self.sheets))


def joined(first: Result, second: Result) -> Result:
    """Return two calibrations from the same measurements as one, which bears the second's title."""
    return Result(
        second.title,
        {**first.sheets, **second.sheets},
        (*first.found, *second.found),
        (*first.doubts, *second.doubts),
        {**second.numbers, "lens": dict(first.numbers)},
        lambda: (*first.pictures(), *second.pictures()),
    )


def today() -> date:
    """Return the day that a calibration is dated with."""
    return date.today()
