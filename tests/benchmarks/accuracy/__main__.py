"""`make bench-accuracy`: how accurate the trackers are, in one run; writes build/accuracy/*.json and docs/accuracy.md."""

import argparse
import os
from collections.abc import Callable, Container, Sequence
from pathlib import Path

import cv2
from rich.console import Console

from server.settings import choose
from tests.benchmarks.accuracy import site
from tests.benchmarks.accuracy.document import write_document
from tests.benchmarks.accuracy.logs import DATA, logs
from tests.benchmarks.accuracy.redrawn import draws
from tests.benchmarks.accuracy.scenarios import SCENARIOS
from tests.benchmarks.accuracy.study import FOLDER, SEEDS, study
from tests.benchmarks.accuracy.tables import print_draws, print_logs, print_study

STEPS = ("study", "logs", "document")


def main(arguments: Sequence[str] | None = None) -> None:
    """Run the steps that are asked for, in order."""
    asked = _parser().parse_args(arguments)
    cv2.setNumThreads(1)
    console = Console(width=None if Console().is_terminal else 220)
    settings = choose(asked.set) if asked.set else None
    try:
        if asked.only in (None, "study"):
            chosen = {"scenarios": asked.scenarios, "wanted": asked.estimators, "settings": settings}
            print_study(study(asked.out / "study.json", asked.seeds, asked.jobs, **chosen)["summary"], console)
        if asked.only in (None, "logs"):
            chosen = {"wanted": asked.estimators, "settings": settings}
            print_logs(logs(asked.out / "logs.json", asked.logs, asked.jobs, **chosen), console)
            print_draws(draws(asked.out / "draws.json", asked.logs, asked.jobs, **chosen), console)
        if asked.only == "document" or (asked.only is None and _is_whole(asked)):
            for file in write_document(*(asked.out / f"{name}.json" for name in ("study", "logs", "draws"))):
                console.print(f"{file}", soft_wrap=True)
    finally:
        site.close()


def _is_whole(asked: argparse.Namespace) -> bool:
    """Whether a run is what the document tells of: all seeds, scenarios and entrants, and no setting changed."""
    return asked.seeds == SEEDS and not (asked.scenarios or asked.estimators or asked.set)


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser("python -m tests.benchmarks.accuracy", description=__doc__)
    parser.add_argument("--only", choices=STEPS, help="one step; all, in this order, where it is left out")
    parser.add_argument("--seeds", type=_seeds, default=SEEDS, metavar="A-B", help="for instance 201-204,210; 101-116")
    parser.add_argument(
        "--scenarios", type=_names(SCENARIOS), default=(), metavar="NAME,...", help=", ".join(SCENARIOS)
    )
    parser.add_argument(
        "--estimators",
        type=_names(None),
        default=(),
        metavar="NAME,...",
        help="by name or a part: precise, paper, gtsam",
    )
    parser.add_argument("--logs", type=Path, default=DATA, metavar="FOLDER", help="recorded walks; ../shared/data")
    parser.add_argument("--set", action="append", metavar="KEY=VALUE", help="a setting of the precise filter")
    parser.add_argument(
        "--jobs", type=int, default=os.cpu_count() or 1, metavar="N", help="processes; one for each core"
    )
    parser.add_argument("--out", type=Path, default=FOLDER, metavar="FOLDER", help=f"where JSON is written; {FOLDER}")
    return parser


def _seeds(text: str) -> tuple[int, ...]:
    """Return the seeds of `101-104,110`."""
    found: list[int] = []
    for part in text.split(","):
        first, _, last = part.partition("-")
        found += range(int(first), int(last or first) + 1)
    return tuple(found)


def _names(known: Container[str] | None) -> Callable[[str], tuple[str, ...]]:
    def names(text: str) -> tuple[str, ...]:
        found = tuple(text.split(","))
        unknown = [name for name in found if known is not None and name not in known]
        if unknown:
            raise argparse.ArgumentTypeError(f"there is no {', '.join(unknown)}")
        return found

    return names


if __name__ == "__main__":
    main()
