"""Figures with their limits and verdicts, and the page that they are appended to."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

HEAD = """# Soak

What `make soak` measured, newest run last: ten minutes of `agora walk` in real time, an hour of a replay on `agora serve` with
viewers that come and go, and eight hours of a rig as fast as possible.
The walk is the demo's, to and fro: its drawn pictures, 640x480 JPEG, 15 a second, and 250 inertial samples a second, with its own
server and a recording. The machine is what it was on that day: its load, and how many cores others' work took, are told.
"""


@dataclass(frozen=True)
class Row:
    """One figure; without a limit it is told and not judged."""

    name: str
    value: float
    unit: str
    most: float | None = None
    least: float | None = None

    @property
    def is_met(self) -> bool | None:
        """Whether the limit holds; None where there is none."""
        if self.most is not None:
            return self.value <= self.most
        return None if self.least is None else self.value >= self.least

    @property
    def cells(self) -> tuple[str, str, str, str]:
        """The row of a table."""
        limit = (
            ""
            if self.is_met is None
            else f"at most {self.most:g}"
            if self.most is not None
            else f"at least {self.least:g}"
        )
        verdict = {None: "", True: "yes", False: "**no**"}[self.is_met]
        value = f"{self.value:.0f}" if self.value == round(self.value) else f"{self.value:.2f}"
        return self.name, f"{value} {self.unit}".strip(), f"{limit} {self.unit}".strip() if limit else "", verdict


def section(title: str, sentences: Sequence[str], rows: Sequence[Row]) -> str:
    """Return a run as Markdown."""
    lines = [f"## {title}", "", " ".join(sentences), ""]
    if rows:
        lines += ["| figure | measured | asked for | met |", "| --- | ---: | ---: | --- |"]
        lines += [f"| {' | '.join(row.cells)} |" for row in rows]
        lines.append("")
    return "\n".join(lines)


def append(document: Path, text: str) -> None:
    """Append a section to the page, which begins with its head."""
    before = document.read_text(encoding="utf-8") if document.exists() else HEAD
    document.write_text(f"{before.rstrip()}\n\n{text.rstrip()}\n", encoding="utf-8")
