"""What was measured, as the document asks for it: the JSON files beside it, each of which may be missing."""

import json
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from statistics import median

from server.tables import lookup
from tracker.score import Figures

SENSORS = ("gps-imu", "camera-gps-imu")
STATIONARY = 3
MOVING = (1, 2, 4, 5)


@dataclass(frozen=True)
class Results:
    """The contents of the files; None for one that is not there."""

    study: Figures | None = None
    sweep: Figures | None = None
    attitude: Figures | None = None
    readings: Figures | None = None
    ablation: Figures | None = None
    feature: Figures | None = None

    @classmethod
    def read(cls, folder: Path) -> "Results":
        """Read what is in a folder."""
        names = ("study", "sweep", "attitude", "readings", "ablation", "feature")
        return cls(*(_read(folder / f"{name}.json") for name in names))

    @property
    def summary(self) -> Figures:
        """The study's comparisons; every list is empty without a study."""
        return self.study["summary"] if self.study else {"cells": [], "against_cmm": [], "camera": [], "claims": {}}

    @property
    def rows(self) -> list[Figures]:
        """The study's runs."""
        return self.study["rows"] if self.study else []

    @property
    def seeds(self) -> int:
        """How many walks of each dataset there are."""
        return len(self.study["seeds"]) if self.study else 0

    @property
    def sigmas(self) -> list[Figures]:
        """The study's state covariances, means over seeds: dataset, sensors, model, state_covariance."""
        return self.study["sigma"] if self.study else []

    def cell(self, dataset: int, sensors: str, model: str) -> Figures | None:
        """Return one cell's means and spreads over seeds."""
        key = (dataset, sensors, model)
        found = (c for c in self.summary["cells"] if (c["dataset"], c["sensors"], c["model"]) == key)
        return next(found, None)

    def against(self, metric: str, model: str = "famm") -> list[Figures]:
        """Return a model's paired comparisons with CMM, dataset by dataset, without and then with the camera."""
        found = [r for r in self.summary["against_cmm"] if r["metric"] == metric and r["model"] == model]
        return sorted(found, key=lambda row: (SENSORS.index(row["sensors"]), row["dataset"]))

    def camera(self, metric: str) -> list[Figures]:
        """Return the moving cells' comparisons of the camera with no camera, for CMM and FAMM."""
        return [
            row
            for row in self.summary["camera"]
            if row["metric"] == metric and row["dataset"] in MOVING and row["model"] in ("cmm", "famm")
        ]

    def runs(self, sensors: str, model: str, datasets: Iterable[int] = MOVING) -> list[Figures]:
        """Return runs of some datasets."""
        wanted = set(datasets)
        return [r for r in self.rows if (r["sensors"], r["model"]) == (sensors, model) and r["dataset"] in wanted]


def middle(rows: Iterable[Figures], *keys: str) -> float | None:
    """Return the median over rows of what lies at the end of some keys; None where no row has it."""
    values = [value for row in rows if (value := lookup(row, *keys)) is not None]
    return float(median(values)) if values else None


def _read(path: Path) -> Figures | None:
    if not path.is_file():
        return None
    content: Figures = json.loads(path.read_text(encoding="utf-8"))
    return content
