"""The command line as people and programs use it: what it prints, how it ends, and one sentence for every mistake."""

import json
import os
import re
import shutil
import signal
import socket
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import httpx
import pytest

from server import cli, live_commands, serve_command
from server.calibrating import commands as calibrating
from server.cli import SITE
from server.doctor import command as doctor
from tests.server.command import agora_here
from tests.server.serving import until
from tests.walks import write_walk
from tracker.estimators import ESTIMATORS
from tracker.log_writer import LogWriter
from tracker.rig import Rig

AGORA = (str(Path(sys.executable).with_name("agora")),)
#: Lines wrap where a terminal ends, and a test should not depend on that.
ENVIRONMENT = os.environ | {"COLUMNS": "300", "NO_COLOR": "1"}


def agora(*arguments: str | Path) -> "subprocess.CompletedProcess[str]":
    """Run a command to its end."""
    command = (*AGORA, *map(str, arguments))
    return subprocess.run(command, capture_output=True, text=True, timeout=120, check=False, env=ENVIRONMENT)


@pytest.fixture(scope="module")
def walk(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Thirty seconds without pictures."""
    return write_walk(tmp_path_factory.mktemp("logs") / "small.mcap", 30.0)


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A copy of the State Agora's facts, without models."""
    folder = tmp_path_factory.mktemp("site") / "state_agora"
    shutil.copytree(SITE, folder, ignore=shutil.ignore_patterns("built"))
    return folder


def is_one_sentence(text: str, *words: str) -> None:
    """Assert that standard error is one line of ours that holds these words, and no traceback."""
    lines = text.strip().splitlines()
    assert len(lines) == 1, text
    assert lines[0].startswith("agora: ")
    assert lines[0].endswith(".")
    for word in words:
        assert word in lines[0]


# -- mistakes ---------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("command", ["replay", "evaluate"])
def test_a_log_that_is_none_is_one_sentence_and_exit_code_2(command: str, tmp_path: Path) -> None:
    missing, text, empty = (tmp_path / name for name in ("missing.mcap", "text.mcap", "empty.mcap"))
    text.write_text("no log at all")
    with LogWriter(empty, Rig()):
        pass
    for run, path, word in (
        (agora, missing, "missing.mcap"),
        (agora_here, text, "MCAP"),
        (agora_here, empty, "no IMU and no GPS"),
    ):
        result = run(command, path)
        assert (result.returncode, result.stdout) == (2, "")
        is_one_sentence(result.stderr, word, path.name)


@pytest.mark.parametrize("command", ["replay", "evaluate"])
def test_an_estimator_that_does_not_exist_is_named_beside_those_that_do(command: str, walk: Path) -> None:
    result = agora_here(command, walk, "--estimator", "precice")
    assert result.returncode == 2
    is_one_sentence(result.stderr, "precice", *ESTIMATORS)


def test_an_estimator_that_the_walk_cannot_feed_says_what_is_missing(walk: Path) -> None:
    for command in ("replay", "evaluate"):
        result = agora_here(command, walk, "--estimator", "camera-gps-imu/famm")
        assert result.returncode == 2
        is_one_sentence(result.stderr, "camera-gps-imu/famm", "no camera")


def test_a_port_in_use_is_one_sentence(walk: Path) -> None:
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = str(taken.getsockname()[1])
        result = agora_here("replay", walk, "--no-browser", "--port", port)
    assert result.returncode == 2
    is_one_sentence(result.stderr, port, "--port")


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        (r"\[origin\]", "[origin", ("site.toml", "TOML")),
        ("lat_deg = 37.9366", "", ("site.toml", "origin.lat_deg")),
        ("lat_deg = 37.9366", "lat_deg = 379.366", ("site.toml", "origin.lat_deg", "-90")),
        ("lat_deg = 37.9366", 'lat_deg = "north"', ("site.toml", "origin.lat_deg", "number")),
        (r"fine_step_m = [\d.]+", "fine_step_m = 0.0", ("site.toml", "terrain.fine_step_m")),
    ],
)
def test_a_broken_site_is_one_sentence(
    site: Path, walk: Path, tmp_path: Path, old: str, new: str, words: tuple[str, ...]
) -> None:
    broken = tmp_path / "broken"
    shutil.copytree(site, broken)
    text = (broken / "site.toml").read_text(encoding="utf-8")
    changed, count = re.subn(old, new, text)
    assert count == 1
    (broken / "site.toml").write_text(changed, encoding="utf-8")
    for arguments in (("build", broken), ("simulate", tmp_path / "out.mcap", "--site", broken)):
        result = agora_here(*arguments)
        assert result.returncode == 2
        is_one_sentence(result.stderr, *words)
    assert not (tmp_path / "out.mcap").exists()


def test_a_site_that_is_not_there_is_one_sentence(walk: Path, tmp_path: Path) -> None:
    for arguments in (("build", tmp_path / "none"), ("replay", walk, "--site", tmp_path / "none")):
        result = agora_here(*arguments)
        assert result.returncode == 2
        is_one_sentence(result.stderr, "site.toml")


def test_models_that_are_not_built_are_asked_for(site: Path, walk: Path) -> None:
    result = agora_here("replay", walk, "--no-browser", "--port", "0", "--site", site)
    assert result.returncode == 3
    is_one_sentence(result.stderr, "make setup")


def test_a_folder_that_cannot_be_written_is_one_sentence(walk: Path, tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    for arguments in (
        ("simulate", tmp_path / "file" / "out.mcap", "--duration", "2"),
        ("evaluate", walk, "--estimator", "truth", "--json", tmp_path / "file" / "out.json"),
        ("evaluate", walk, "--estimator", "truth", "--poses", tmp_path / "file"),
    ):
        result = agora_here(*arguments)
        assert result.returncode == 2
        is_one_sentence(result.stderr, "file", "written")


def test_what_is_said_is_said_as_it_is(tmp_path: Path) -> None:
    """Two letters between colons are no picture: certificates have them in their fingerprints, files in their names."""
    is_one_sentence(agora_here("replay", tmp_path / "F7:AB:86.mcap").stderr, "F7:AB:86.mcap")
    for said_by in (cli, calibrating, doctor, live_commands, serve_command):
        assert said_by.out.render_str("F7:AB:86").plain == "F7:AB:86"


def test_no_command_waits_for_what_only_others_need() -> None:
    heavy = ("av", "fastapi", "matplotlib", "rosbags", "scipy", "trimesh", "viser")
    asked = f"import sys, server.cli; print([name for name in {heavy} if name in sys.modules])"
    done = subprocess.run([sys.executable, "-c", asked], capture_output=True, text=True, timeout=60, check=True)
    assert done.stdout.strip() == "[]"


# -- what it is for ---------------------------------------------------------------------------------------------------


def test_the_rules_are_81_and_only_a_low_innovation_keeps_a_model() -> None:
    rules = json.loads(agora("rules", "--json").stdout)
    assert len(rules) == 81
    assert all((rules[key] == key[-4:]) == key.startswith("Low,Low") for key in rules)


def test_evaluate_writes_figures_and_poses(walk: Path, tmp_path: Path) -> None:
    result = agora("evaluate", walk, "--json", tmp_path / "x.json", "--poses", tmp_path / "poses")
    assert result.returncode == 0
    assert "small cannot run camera-gps-imu/famm: it has no camera" in result.stdout
    written = json.loads((tmp_path / "x.json").read_text())
    models = ("cmm", "famm", "dfa", "imm", "reduced", "precise")
    assert [run["estimator"] for run in written["runs"]] == [*(f"gps-imu/{model}" for model in models), "truth"]
    assert {run["log"] for run in written["runs"]} == {"small"}
    assert written["runs"][-1]["truth"]["ate_rmse_m"] < 1e-3
    names = sorted(path.name for path in (tmp_path / "poses").iterdir())
    assert names == [*(f"small.gps-imu-{model}.tum" for model in sorted(models)), "small.truth.tum"]
    assert all(len(line.split()) == 8 for line in (tmp_path / "poses" / names[0]).read_text().splitlines())


def test_a_log_that_breaks_off_is_evaluated_to_there_and_said_so(walk: Path, tmp_path: Path) -> None:
    cut = tmp_path / "cut.mcap"
    data = walk.read_bytes()
    cut.write_bytes(data[: len(data) * 2 // 3])
    result = agora("evaluate", cut, "--json", tmp_path / "x.json")
    assert result.returncode == 0
    assert "cut is cut off" in result.stdout
    run = json.loads((tmp_path / "x.json").read_text())["runs"][0]
    assert 10.0 < run["duration_s"] < 29.0


def test_simulate_writes_the_same_bytes_for_the_same_seed(tmp_path: Path) -> None:
    paths = [tmp_path / name for name in ("a.mcap", "b.mcap", "c.mcap")]
    for path, seed in zip(paths, "556", strict=True):
        assert agora("simulate", path, "--seed", seed, "--duration", "3").returncode == 0
    a, b, c = (path.read_bytes() for path in paths)
    assert a == b
    assert a != c


# -- showing ----------------------------------------------------------------------------------------------------------


@contextmanager
def running(*arguments: str | Path) -> Iterator[tuple["subprocess.Popen[str]", str]]:
    """Run a command that serves; yield it and its address."""
    command = (*AGORA, *map(str, arguments), "--no-browser", "--port", "0")
    with subprocess.Popen(
        command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=ENVIRONMENT
    ) as process:
        try:
            line = process.stdout.readline().strip() if process.stdout else ""
            assert line.startswith("Agora is at http://127.0.0.1:"), line
            yield process, line.removeprefix("Agora is at ")
        finally:
            if process.poll() is None:
                process.kill()


def test_a_replay_prints_its_address_serves_and_ends_clean(tmp_path: Path) -> None:
    log = write_walk(tmp_path / "wall.mcap", 4.0, pictures=True)
    with running("replay", log, "--loop") as (process, url):
        until(lambda: httpx.get(f"{url}health").status_code == 200)
        session = httpx.get(f"{url}api/sessions").json()["sessions"][0]
        assert (session["name"], session["kind"]) == ("wall", "replay")
        assert httpx.get(f"{url}replay/wall").status_code == 200
        process.send_signal(signal.SIGINT)
        _, errors = process.communicate(timeout=20)
    assert (process.returncode, errors) == (0, "")
    with pytest.raises(httpx.ConnectError):
        httpx.get(f"{url}health")
