"""Mutations of our own inputs, and the fuzzer's first thousands, the same at every run; `make fuzz` goes on from there."""

import subprocess
import sys
from functools import cache
from importlib.util import find_spec
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

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

inputs = cache(seeds)


@pytest.mark.parametrize("target", TARGETS)
def test_our_own_inputs_keep_the_laws(target: str) -> None:
    """And there are some."""
    assert inputs(target)
    for data in inputs(target):
        TARGETS[target](data)


@settings(max_examples=40)
@given(data=st.data())
@pytest.mark.parametrize("target", TARGETS)
def test_no_mutation_breaks_a_law(target: str, data: st.DataObject) -> None:
    """Bytes changed, put in and left out, and the end cut off."""
    changed = bytearray(data.draw(st.sampled_from(inputs(target))))
    for _ in range(data.draw(st.integers(1, 6))):
        at = data.draw(st.integers(0, len(changed)))
        changed[at : at + data.draw(st.integers(0, 8))] = data.draw(st.binary(max_size=8))
    TARGETS[target](bytes(changed[: len(changed) - data.draw(st.integers(0, 40))]))


if find_spec("atheris") is not None:  # it is made for Linux on x86-64 and some versions of Python alone

    @pytest.mark.parametrize("target", RUNS)
    def test_no_input_breaks_a_law(tmp_path: Path, target: str) -> None:
        """In a process of its own, as the fuzzer ends the one that it runs in."""
        command = (sys.executable, "-m", "tests.fuzz", target, f"--runs={RUNS[target]}", f"--folder={tmp_path}")
        done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, errors="replace", check=False)
        assert done.returncode == 0, done.stderr[-4000:]
        assert f"Done {RUNS[target]} runs" in done.stderr
        assert not list((tmp_path / target).glob("crash-*"))
