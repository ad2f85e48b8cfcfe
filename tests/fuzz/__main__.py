"""Fuzz the readers: `python -m tests.fuzz nmea --runs 100000`, or every target one after the other with `make fuzz`.

The fuzzer is coverage-guided (atheris on libFuzzer). The same runs and seed on an empty folder try the same inputs. What breaks
a law is kept as build/fuzz/TARGET/crash-…; `python -m tests.fuzz TARGET --replay FILE` shows it again.
"""

import argparse
import logging
import subprocess
import sys
from pathlib import Path

import atheris

with atheris.instrument_imports(include=["tracker", "pynmeagps", "mcap"]):
    from tests.fuzz.seeds import seeds
    from tests.fuzz.targets import TARGETS

_LONGEST = {
    "nmea": 2_000,
    "sentences": 2_000,
    "gpsd": 2_000,
    "message": 4_000,
    "log": 20_000,
    "container": 20_000,
    "salvage": 20_000,
}
"""Bytes: some more than the seeds are."""
_TIMEOUT_S = 60
"""For one input: a reader that hangs has broken a law too."""


def main() -> None:
    """Fuzz."""
    parser = argparse.ArgumentParser(prog="python -m tests.fuzz", description="Fuzz the readers.")
    parser.add_argument("target", nargs="?", choices=TARGETS, help="all, one after the other, where none is given")
    parser.add_argument("--runs", type=int, default=100_000, help="inputs for each target")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument(
        "--folder", type=Path, default=Path("build/fuzz"), help="corpus and crashes go to FOLDER/TARGET"
    )
    parser.add_argument("--replay", type=Path, help="try this input alone")
    options = parser.parse_args()
    logging.disable()
    if options.target is None:
        sys.exit(max(_run_alone(target) for target in TARGETS))
    if options.replay is not None:
        TARGETS[options.target](options.replay.read_bytes())
        return
    corpus = options.folder / options.target
    corpus.mkdir(parents=True, exist_ok=True)
    for number, seed in enumerate(seeds(options.target)):
        (corpus / f"seed-{number}").write_bytes(seed)
    arguments = [
        sys.argv[0],
        f"-runs={options.runs}",
        f"-seed={options.seed}",
        f"-max_len={_LONGEST[options.target]}",
        f"-timeout={_TIMEOUT_S}",
        f"-artifact_prefix={corpus}/",
        "-len_control=0",
        str(corpus),
    ]
    atheris.Setup(arguments, TARGETS[options.target])
    atheris.Fuzz()


def _run_alone(target: str) -> int:
    """Fuzz a target in a process of its own, which ends with the fuzzing."""
    return subprocess.run((sys.executable, "-m", "tests.fuzz", target, *sys.argv[1:]), check=False).returncode


if __name__ == "__main__":
    main()
