"""The study's cases: a walk in the manner of one of the paper's datasets, by one seed, and all that its sensors say."""

from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from functools import cache
from heapq import merge
from pathlib import Path

from assets.corners import CornerAtlas
from assets.site import Site, load_site
from server.feature_world import dataset_walk, world_of
from server.motions import feature_motions
from server.paper.tasks import content_key
from tracker.choreography import DATASET_UPDATES
from tracker.estimators import SELECTORS, SENSORS
from tracker.evaluate import Run
from tracker.family import PaperFamily, follow_family
from tracker.geomagnetism import declination_rad
from tracker.measurements import Measurement, VisualMotion
from tracker.simulate import START_NS, Walk, simulate

ROOT = Path(__file__).parents[2]
SITE = ROOT / "assets" / "state_agora"
DATASETS = tuple(DATASET_UPDATES)


@dataclass(frozen=True)
class Case:
    """Which walk."""

    dataset: int
    seed: int

    @property
    def name(self) -> str:
        """For instance `dataset-5-seed-12`."""
        return f"dataset-{self.dataset}-seed-{self.seed}"


@dataclass(frozen=True)
class Seen:
    """All that one walk's sensors say."""

    walk: Walk
    measurements: list[Measurement]
    """In order of arrival, truth and camera motions among them."""
    motions: list[VisualMotion]


#: Files of the tracker that filter cycles: what the cycles are does not depend on them.
FILTERING = ("dfa", "fusion", "fuzzy", "imm", "motion")


def sources_key(*names: str, without: tuple[str, ...] = ()) -> str:
    """Return a name for all that results depend on: tracker, site, what makes measurements, and the named files beside this.

    `without` names files of the tracker that have no say.
    """
    files = [
        # not tracker/precise: an estimator of its own, which no study runs
        *(path for path in (ROOT / "tracker").glob("*.py") if path.stem not in without),
        *(ROOT / "assets").rglob("*.py"),
        *SITE.glob("*.toml"),
        *(ROOT / "server").glob("*motions.py"),
        *(ROOT / "server").glob("feature_*.py"),
        *(ROOT / "server" / "paper" / f"{name}.py" for name in ("cases", *names)),
    ]
    return content_key(files)


def see(case: Case) -> Seen:
    """Return what the sensors of a case's walk say; the camera is the feature camera, in the site of today."""
    walk = dataset_walk(_site(), case.dataset, case.seed)
    motions = feature_motions(walk, _world())
    measurements = list(merge(simulate(walk), motions, key=lambda measurement: measurement.t_recv_ns))
    return Seen(walk, measurements, motions)


def runs_of(case: Case, seen: Seen) -> Iterator[tuple[list[Run], PaperFamily]]:
    """Yield, without and then with the camera, a run of every motion model, and the family that made them."""
    origin = seen.walk.settings.origin
    for sensors in SENSORS:
        family = PaperFamily(
            sensors,
            {name: selector() for name, selector in SELECTORS.items()},
            origin=origin,
            rig=seen.walk.rig,
            declination_rad=declination_rad(origin, START_NS),
        )
        template = Run(case.name, sensors, START_NS, seen.walk.settings.duration_s, origin, origin)
        yield follow_family(family, seen.measurements, template), family


@cache
def _site() -> Site:
    return load_site(SITE)


_OPEN = ExitStack()


@cache
def _world() -> CornerAtlas:
    """The site's corners, opened once for each process: it has one thread of its own, and is closed with it."""
    return _OPEN.enter_context(world_of(_site()))


@contextmanager
def worlds_closed() -> Iterator[None]:
    """Close, at the end, the world that `see` has opened in this process."""
    try:
        yield
    finally:
        _OPEN.close()
        _world.cache_clear()
