"""What of the camera's gain is the camera's own: the study's walks again, with the IMU's path carrying the fixes to one place.

With a camera, its path carries the fixes of ten seconds to one place and their white error averages out. The paper has neither that
nor anything else for the IMU alone; this gives the IMU the same averaging, so that the camera is held against an equal.
Writes docs/paper/ablation.json, which docs/paper.md tabulates.
"""

from collections.abc import Iterable
from pathlib import Path

from server.paper.cases import ROOT, Case, see, sources_key
from server.paper.digits import write_figures
from server.paper.study import SEEDS
from server.paper.tasks import FOLDER, Task, progress_bar, run_tasks
from server.settings import choose
from tracker.estimators import SELECTORS
from tracker.evaluate import Run, figures
from tracker.family import PaperFamily, follow_family
from tracker.geomagnetism import declination_rad
from tracker.score import Figures
from tracker.simulate import START_NS

OUT = ROOT / "docs" / "paper" / "ablation.json"
#: Those that move: standing still, the camera sees that it does, and no path is needed.
MOVING = (1, 5, 2, 4)
MODELS = ("cmm", "famm")
CHANGES = ("anchor_imu=true",)


def ablation(path: Path = OUT, seeds: Iterable[int] = SEEDS, jobs: int = 1, folder: Path = FOLDER) -> None:
    """Run every case, or read what is kept of it, and write the rows."""
    seeds = tuple(seeds)
    tasks = [
        Task(f"ablation-{Case(dataset, seed).name}", ablation_case, (dataset, seed))
        for dataset in MOVING
        for seed in seeds
    ]
    with progress_bar("ablation") as bar:
        results = run_tasks(tasks, key=sources_key("ablation"), jobs=jobs, folder=folder, done=bar)
    rows = sorted(
        (row for rows in results for row in rows), key=lambda row: (row["dataset"], row["model"], row["seed"])
    )
    write_figures(path, {"seeds": list(seeds), "changes": list(CHANGES), "rows": rows})


def ablation_case(dataset: int, seed: int) -> list[Figures]:
    """Return a row for each motion model: GPS and IMU, the fixes carried to one place by the IMU."""
    seen = see(Case(dataset, seed))
    settings, origin = choose(CHANGES).paper, seen.walk.settings.origin
    family = PaperFamily(
        "gps-imu",
        {name: SELECTORS[name].of(settings.fuzzy) for name in MODELS},
        origin=origin,
        rig=seen.walk.rig,
        declination_rad=declination_rad(origin, START_NS),
        settings=settings,
    )
    template = Run("ablation", "gps-imu", START_NS, seen.walk.settings.duration_s, origin, origin)
    runs = follow_family(family, seen.measurements, template)
    return [
        {
            "dataset": dataset,
            "seed": seed,
            "model": name,
            **{key: figures(run)[key] for key in ("filter_error_m", "truth")},
        }
        for name, run in zip(MODELS, runs, strict=True)
    ]
