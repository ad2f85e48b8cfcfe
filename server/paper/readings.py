"""What each reading of the paper's text does to the result: FAMM on one walk, with one choice changed at a time.

Writes docs/paper/readings.json, which docs/paper.md tabulates.
"""

from pathlib import Path

from server.paper.cases import ROOT, Case, Seen, see, sources_key, worlds_closed
from server.paper.digits import write_figures
from server.paper.tasks import FOLDER, Task, progress_bar, run_tasks
from server.settings import choose
from tracker.estimators import SELECTORS, SENSORS
from tracker.evaluate import Run, figures
from tracker.family import PaperFamily, follow_family
from tracker.geomagnetism import declination_rad
from tracker.score import Figures
from tracker.simulate import START_NS

OUT = ROOT / "docs" / "paper" / "readings.json"
#: The shortest walk that moves.
DATASET, SEED = 4, 1
#: As `--set` is given them; a reading of m_P is one of Tr, and without a camera there is none. The last two take away what the
#: paper does not have: the mean of the fixes that the camera's path carries to one place, and north from the camera.
CHANGES: dict[str, tuple[tuple[str, ...], ...]] = {
    "gps-imu": (
        (),
        ("m_imu=literal",),
        ("innovation=nis",),
        ("innovation=nis", "fuzzy.position_m=[1, 2, 3]", "fuzzy.rotation_rad=[1, 2, 3]"),
        ("calibration=false",),
        ("mean_samples=1",),
    ),
    "camera-gps-imu": (
        (),
        ("m_imu=literal",),
        ("innovation=nis", "fuzzy.position_m=[1, 2, 3]", "fuzzy.rotation_rad=[1, 2, 3]"),
        ("m_P=literal_enu",),
        ("m_P=literal_ecef",),
        ("m_P=literal_ecef", "m_imu=literal"),
        ("anchor_s=0.1",),
        ("camera_north=false",),
    ),
}


def readings(path: Path = OUT, jobs: int = 1, folder: Path = FOLDER) -> None:
    """Run every reading, or read what is kept of it, and write the rows."""
    task = Task(f"readings-dataset-{DATASET}-seed-{SEED}", reading_rows, (DATASET, SEED))
    with progress_bar("readings") as bar, worlds_closed():
        rows = run_tasks([task], key=sources_key("readings"), jobs=jobs, folder=folder, done=bar)[0]
    write_figures(path, {"dataset": DATASET, "seed": SEED, "rows": rows})


def reading_rows(dataset: int, seed: int) -> list[Figures]:
    """Return one row for each reading."""
    seen = see(Case(dataset, seed))
    return [reading_row(seen, sensors, changes) for sensors in SENSORS for changes in CHANGES[sensors]]


def reading_row(seen: Seen, sensors: str, changes: tuple[str, ...]) -> Figures:
    """Return FAMM's figures under some changed settings."""
    origin, settings = seen.walk.settings.origin, choose(changes).paper
    family = PaperFamily(
        sensors,
        {"famm": SELECTORS["famm"].of(settings.fuzzy)},
        origin=origin,
        rig=seen.walk.rig,
        declination_rad=declination_rad(origin, START_NS),
        settings=settings,
    )
    template = Run("readings", sensors, START_NS, seen.walk.settings.duration_s, origin, origin)
    run = figures(follow_family(family, seen.measurements, template)[0])
    kept = ("filter_error_m", "filter_error_rad", "truth", "motion_model_share")
    return {"sensors": sensors, "changes": list(changes), **{name: run[name] for name in kept}}
