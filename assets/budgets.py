"""What a build weighs: files, textures on the graphics card, and the tour's most costly view."""

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any

from assets.levels import Drawn, cost_of
from assets.site import Site

FIRST_PAINT = ("roman", 2)
"""The model and level that a page needs before it can draw anything."""


@dataclass(frozen=True)
class BuiltFile:
    """One file of a build."""

    path: str
    """Relative to the site's folder."""
    bytes: int
    sha256: str
    model: str
    level: int
    """0 is the finest."""


@dataclass(frozen=True)
class BuildReport:
    """What was built."""

    files: tuple[BuiltFile, ...]
    draw_calls: int
    """Of the most costly view of the tour, either model, every thing at its chosen level."""
    triangles: int
    """Likewise; not always the same view."""
    gpu_bytes: int
    """Textures with their smaller copies."""

    @property
    def total_bytes(self) -> int:
        """Size of all files."""
        return sum(file.bytes for file in self.files)

    @property
    def first_paint_bytes(self) -> int:
        """Size of what a page loads before it can draw."""
        return sum(file.bytes for file in self.files if (file.model, file.level) == FIRST_PAINT)

    def as_dict(self) -> dict[str, Any]:
        """Return plain values for JSON."""
        return {
            "files": [asdict(file) for file in self.files],
            "total_bytes": self.total_bytes,
            "first_paint_bytes": self.first_paint_bytes,
            "draw_calls": self.draw_calls,
            "triangles": self.triangles,
            "gpu_bytes": self.gpu_bytes,
        }

    @classmethod
    def from_dict(cls, facts: Mapping[str, Any]) -> "BuildReport":
        """Return the report that `as_dict` told; `KeyError` or `TypeError` for anything else."""
        files = tuple(BuiltFile(**file) for file in facts["files"])
        return cls(files, facts["draw_calls"], facts["triangles"], facts["gpu_bytes"])


def tour_costs(site: Site, levels: Mapping[int, Sequence[Drawn]], ground_z_m: Mapping[str, float]) -> tuple[int, int]:
    """Return the most draw calls and the most triangles of any view of the tour; grounds are by view id."""
    views = (site.default_view, *site.tour)
    costs = [cost_of(view, ground_z_m[view.id] + site.eye_height_m, levels) for view in views]
    return max(calls for calls, _ in costs), max(triangles for _, triangles in costs)
