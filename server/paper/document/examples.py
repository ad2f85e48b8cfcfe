"""One walk of each dataset under the paper's four estimators, for the figures of single walks; kept between runs."""

from collections.abc import Callable
from pathlib import Path

from server.paper.cases import DATASETS, ROOT, Case, runs_of, see, sources_key, worlds_closed
from server.paper.tasks import content_key
from server.plots.trace import Trace, trace_of
from server.tables import PAPER_FOUR

SEED = 1


def examples(folder: Path, progress: Callable[[int, int], None]) -> dict[int, list[Trace]]:
    """Return the traces by dataset, run or read.

    Args:
        folder: Where they are kept.
        progress: Told how many datasets are done, and of how many.
    """
    kept = folder / f"examples-{_key()}"
    found: dict[int, list[Trace]] = {}
    with worlds_closed():
        for done, dataset in enumerate(DATASETS):
            progress(done, len(DATASETS))
            found[dataset] = _of(Case(dataset, SEED), kept)
    progress(len(DATASETS), len(DATASETS))
    return found


def _of(case: Case, kept: Path) -> list[Trace]:
    files = {name: kept / f"{case.name}.{name.replace('/', '-')}.npz" for name in PAPER_FOUR}
    if not all(file.is_file() for file in files.values()):
        for runs, _ in runs_of(case, see(case)):
            for run in runs:
                if run.estimator in files:
                    trace_of(run).save(files[run.estimator])
    return [Trace.load(file) for file in files.values()]


def _key() -> str:
    """Return a name for all that a trace depends on."""
    return f"{sources_key()}-{content_key([ROOT / 'server' / 'plots' / 'trace.py'])}"
