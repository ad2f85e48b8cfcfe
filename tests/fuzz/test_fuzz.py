"""The fuzzer's first thousands of inputs, the same at every run; `make fuzz` goes on from there."""

import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import pytest

from tests.fuzz.seeds import seeds
from tests.fuzz.targets import TARGETS

ROOT = Path(__file__).parents[2]
RUNS = {
    "nmea": 800,
    "sentences": 1_200,
    "gpsd": 500,
    "message": 4_000,
    "log": 500,
    "container": 2_000,
    "salvage": 4_000,
}


@pytest.mark.parametrize("target", TARGETS)
def test_our_own_inputs_keep_the_laws(target: str) -> None:
    """And there are some."""
    inputs = seeds(target)
    assert inputs
    for data in inputs:
        TARGETS[target](data)


@pytest.mark.parametrize("target", TARGETS)
def test_no_input_breaks_a_law(tmp_path: Path, target: str) -> None:
    """In a process of its own, as the fuzzer ends the one that it runs in."""
    if find_spec("atheris") is None:
        pytest.skip("no atheris")
    command = (sys.executable, "-m", "tests.fuzz", target, f"--runs={RUNS[target]}", f"--folder={tmp_path}")
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, errors="replace", check=False)
    assert done.returncode == 0, done.stderr[-4000:]
    assert f"Done {RUNS[target]} runs" in done.stderr
    assert not list((tmp_path / target).glob("crash-*"))
