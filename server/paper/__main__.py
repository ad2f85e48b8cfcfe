"""`python -m server.paper`: everything that docs/paper.md reports, measured and written anew."""

import argparse
import os
from collections.abc import Callable, Sequence

import cv2

from server.paper.cases import ROOT, worlds_closed

DOCS = ROOT / "docs" / "paper"
STEPS = ("study", "sweep", "attitude", "readings", "ablation", "document")


def main(arguments: Sequence[str] | None = None) -> None:
    """Run the steps that are asked for, in order."""
    asked = _parser().parse_args(arguments)
    cv2.setNumThreads(1)
    with worlds_closed():
        for step in STEPS:
            if asked.only in (None, step):
                _step(step, asked.seeds, asked.jobs)()


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser("python -m server.paper", description=__doc__)
    parser.add_argument("--only", choices=STEPS, help="one step; all, in this order, where it is left out")
    parser.add_argument("--seeds", type=int, default=None, metavar="N", help="so many seeds; 16 and, for the sweep, 8")
    parser.add_argument(
        "--jobs", type=int, default=os.cpu_count() or 1, metavar="N", help="processes; one for each core"
    )
    return parser


def _step(name: str, seeds: int | None, jobs: int) -> Callable[[], None]:
    """Return a step, ready to run; each imports what it needs, so that one that lacks something stops no other."""

    def study() -> None:
        from server.paper.study import SEEDS, study

        study(DOCS / "study.json", SEEDS[:seeds], jobs)

    def sweep() -> None:
        from server.paper.sweep import SEEDS, sweep

        sweep(DOCS / "sweep.json", SEEDS[:seeds], jobs)

    def attitude() -> None:
        from server.paper.attitude import main as attitude

        attitude()

    def readings() -> None:
        from server.paper.readings import readings

        readings(DOCS / "readings.json")

    def ablation() -> None:
        from server.paper.ablation import ablation
        from server.paper.study import SEEDS

        ablation(DOCS / "ablation.json", SEEDS[:seeds], jobs)

    def document() -> None:
        from server.paper.document import write_document

        write_document()

    steps: dict[str, Callable[[], None]] = {
        "study": study,
        "sweep": sweep,
        "attitude": attitude,
        "readings": readings,
        "ablation": ablation,
        "document": document,
    }
    return steps[name]


if __name__ == "__main__":
    main()
