"""The study over seeds: every scenario, every entrant, on the same walks; each result is kept by the content of its sources."""

from collections.abc import Iterable, Sequence
from pathlib import Path

from server.paper.cases import ROOT, sources_key
from server.paper.digits import write_figures
from server.paper.tasks import Task, content_key, progress_bar, run_tasks
from tests.benchmarks.accuracy.entrants import RAW, run_unit
from tests.benchmarks.accuracy.figures import row_of
from tests.benchmarks.accuracy.goals import BOTH, by_cell, summary
from tests.benchmarks.accuracy.pairs import against
from tests.benchmarks.accuracy.scenarios import SCENARIOS
from tests.benchmarks.accuracy.site import agora
from tests.benchmarks.accuracy.told import TOLD
from tests.benchmarks.accuracy.world import record
from tracker.estimators import SENSORS, Settings
from tracker.score import Figures

HERE = Path(__file__).parent
FOLDER = Path("build/accuracy")
#: Never used for tuning.
SEEDS = tuple(range(101, 117))
PAPER = tuple(f"{sensors}/paper" for sensors in SENSORS)
RIVALS = ("gtsam/batch", "gtsam/fixed-lag", "filterpy/imm", "vqf", "imufusion")
#: Where raw GPS stands beside the precise filter: what only it takes in (landmarks, the ground) changes nothing for others.
COMPARED = ("plain", "no-magnetometer", "understated", "wavering", "outage", "walls", "disturbance", "turned-start")
RIVALLED = ("plain", "outage")
#: Where figures are missed without a camera.
TOLD_IN = ("no-magnetometer", "three-taps", "stand-here")
#: What measurements and figures are made by; tables and goals are not among it.
_SOURCES = (
    "alignment",
    "entrants",
    "figures",
    "inertial_unit",
    "magnetometer",
    "raw",
    "receiver",
    "scenarios",
    "site",
    "terrain",
    "told",
    "visitor",
    "world",
)


def units(scenario: str, wanted: Sequence[str] = ()) -> list[str]:
    """Return what is run in a scenario; `wanted` chooses by name or by a part of it between slashes, nothing for all."""
    known = [*BOTH]
    known += [TOLD] if scenario in TOLD_IN else []
    known += [RAW] if scenario in COMPARED else []
    known += [*PAPER, *RIVALS] if scenario in RIVALLED else []
    return [unit for unit in known if is_wanted(unit, wanted)]


def is_wanted(name: str, wanted: Sequence[str]) -> bool:
    """Whether an entrant is chosen, by its name or by a part of it between slashes; all are where nothing is asked for."""
    return not wanted or bool({name, *name.split("/")} & set(wanted))


def study(
    path: Path,
    seeds: Iterable[int] = SEEDS,
    jobs: int = 1,
    *,
    scenarios: Sequence[str] = (),
    wanted: Sequence[str] = (),
    settings: Settings | None = None,
    folder: Path = FOLDER,
) -> Figures:
    """Run every case, or read what is kept of it; write and return all rows with what they mean together.

    Args:
        path: The JSON file that is written.
        seeds: Of the walks.
        jobs: Processes.
        scenarios: By name; none for all.
        wanted: See `units`.
        settings: Of the precise filter; None for the defaults.
        folder: Where results are kept.
    """
    seeds, rows = tuple(seeds), []
    cases = [(scenario, seed) for scenario in scenarios or SCENARIOS for seed in seeds]
    for kind in ("rivals", "paper", "precise"):
        tasks = [
            Task(f"{scenario}-{seed}-{unit.replace('/', '-')}", study_case, (scenario, seed, unit, settings))
            for scenario, seed in cases
            for unit in units(scenario, wanted)
            if kind_of(unit) == kind
        ]
        if tasks:
            with progress_bar(kind) as bar:
                results = run_tasks(tasks, key=key_of(kind, settings), jobs=jobs, folder=folder, done=bar)
            rows += [row for result in results for row in result]
    rows.sort(key=lambda row: (list(SCENARIOS).index(row["scenario"]), row["estimator"], row["seed"]))
    found: Figures = {"seeds": list(seeds), "summary": summary(rows), "against": against(by_cell(rows)), "rows": rows}
    write_figures(path, found)
    return found


def study_case(scenario: str, seed: int, unit: str, settings: Settings | None) -> list[Figures]:
    """Return the rows of one unit on one walk."""
    recording = record(SCENARIOS[scenario], seed, place=agora(), camera=unit.startswith("camera"))
    return [row_of(recording, watched) for watched in run_unit(recording, unit, settings)]


def kind_of(unit: str) -> str:
    """Return which sources a unit's results depend on: `precise`, `paper` or `rivals`."""
    kind = "precise" if unit == TOLD else unit.rpartition("/")[2]
    return kind if kind in ("precise", "paper") else "rivals"


def key_of(kind: str, settings: Settings | None = None) -> str:
    """Return a name for all that results of a kind depend on."""
    files = [HERE / f"{name}.py" for name in _SOURCES]
    if kind != "paper":
        files += (ROOT / "tracker" / "precise").glob("*.py")
    if kind == "rivals":
        files += (HERE / "rivals").glob("*.py")
    return content_key(files, sources_key(), settings if kind == "precise" else None)
