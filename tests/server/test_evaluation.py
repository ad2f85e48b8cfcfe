"""`agora evaluate` on small logs: table, JSON, poses for other tools, and one sentence for what cannot be done."""

import json
from io import StringIO
from pathlib import Path

import numpy as np
import pytest
from evo.tools import file_interface
from rich.console import Console
from typer.testing import CliRunner

from assets.site import load_site
from server.cli import SITE, app
from server.evaluation import Evaluation, evaluate, print_table, write_json
from tests.walks import write_walk
from tracker.errors import InputError, MalformedInput, MissingSensor, UnknownEstimator
from tracker.estimator import Origin
from tracker.log_writer import LogWriter
from tracker.measurements import ImuSample
from tracker.simulate import AGORA_ORIGIN, START_NS, Walk, WalkSettings, default_rig, simulate

RIG = default_rig()


@pytest.fixture(scope="module")
def walk(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Half a minute without a camera."""
    path = tmp_path_factory.mktemp("evaluation") / "walk.mcap"
    settings = WalkSettings(seed=5, duration_s=32.0, still_s=4.0, imu_hz=100.0, truth_hz=50.0)
    with LogWriter(path, RIG, AGORA_ORIGIN, t_start_ns=START_NS) as writer:
        for measurement in simulate(Walk(settings, RIG)):
            writer.write(measurement)
    return path


def _nothing(label: str, done: float) -> None:
    pass


def _printed(evaluation: Evaluation) -> str:
    console = Console(file=StringIO(), width=200, highlight=False)
    print_table(evaluation, console)
    assert isinstance(console.file, StringIO)
    return console.file.getvalue()


def test_all_that_the_sensors_allow(walk: Path, tmp_path: Path) -> None:
    """All without a camera run; those with one say what is missing; the files are what other programs read."""
    evaluation = evaluate([walk], (), tmp_path / "poses", _nothing)
    models = ("cmm", "famm", "dfa", "imm", "reduced", "precise")
    assert [row["estimator"] for row in evaluation.runs] == [*(f"gps-imu/{model}" for model in models), "truth"]
    write_json(evaluation, tmp_path / "figures.json")
    found = json.loads((tmp_path / "figures.json").read_text())
    assert [(m["estimator"], m["missing"]) for m in found["missing"]] == [
        (f"camera-gps-imu/{model}", "no camera") for model in models
    ]
    assert found["runs"] == evaluation.runs
    table = _printed(evaluation)
    assert "walk cannot run camera-gps-imu/cmm: it has no camera." in table
    assert "cut off" not in table
    assert "gps-imu/precise has no filter error" in table
    trajectory = file_interface.read_tum_trajectory_file(tmp_path / "poses" / "walk.gps-imu-famm.tum")
    assert np.median(np.diff(trajectory.timestamps)) == pytest.approx(0.02, abs=1e-5)
    assert trajectory.num_poses > 1500


def test_centimetres_in_the_table_metres_in_the_json(walk: Path) -> None:
    """The one column whose unit is not the figure's."""
    evaluation = evaluate([walk], ("gps-imu/cmm",), None, _nothing)
    jitter_m = evaluation.runs[0]["truth"]["jitter_rms_m"]
    assert 0.0 < jitter_m < 1.0
    assert f" {100.0 * jitter_m:.1f} " in _printed(evaluation)


def test_on_the_ground_of_the_site_heights_are_known_to_centimetres(walk: Path, tmp_path: Path) -> None:
    """The simulated walk is on level paving; another visitor's eyes are higher; a walk from elsewhere knows no such ground."""
    command = ["evaluate", str(walk), "--estimator", "gps-imu/precise", "--json", str(tmp_path / "x.json")]

    def height_m(*arguments: str) -> float:
        assert CliRunner().invoke(app, [*command, *arguments]).exit_code == 0
        found = json.loads((tmp_path / "x.json").read_text(encoding="utf-8"))
        assert found["settings"] == ({"ground": "state_agora"} if arguments else {})
        return float(found["runs"][0]["truth"]["height_rmse_m"])

    on_ground_m = height_m("--ground")
    assert on_ground_m < 0.05
    assert height_m() > 6.0 * on_ground_m
    assert height_m("--ground", "--eye-height", "1.85") == pytest.approx(0.2, abs=0.05)
    far = write_walk(tmp_path / "far.mcap", 3.0, origin=Origin(-43.5, 172.6, 20.0))
    with pytest.raises(InputError, match=r"far was recorded 17,\d{3} km from .*: evaluate it without --ground"):
        evaluate([far], ("gps-imu/precise",), None, _nothing, ground=load_site(SITE))


def test_a_changed_setting_changes_the_figures_and_is_written_down(walk: Path, tmp_path: Path) -> None:
    command = ["evaluate", str(walk), "--estimator", "gps-imu/cmm", "--json", str(tmp_path / "x.json")]
    usual = evaluate([walk], ("gps-imu/cmm",), None, _nothing)
    result = CliRunner().invoke(app, [*command, "--set", "accel_noise_m_s2=0.1"])
    assert result.exit_code == 0
    assert "accel_noise_m_s2 = 0.1" in result.stdout
    written = json.loads((tmp_path / "x.json").read_text(encoding="utf-8"))
    assert written["settings"] == {"paper.fusion.accel_noise_m_s2": 0.1}
    assert written["runs"][0]["filter_error_m"] != usual.runs[0]["filter_error_m"]


def test_a_cut_log_is_played_to_where_it_breaks(walk: Path, tmp_path: Path) -> None:
    """Once for the log, not once for each estimator; it counts as done."""
    cut = tmp_path / "cut.mcap"
    cut.write_bytes(walk.read_bytes()[: walk.stat().st_size * 9 // 10])
    result = CliRunner().invoke(app, ["evaluate", str(cut), "--json", str(tmp_path / "cut.json")])
    assert result.exit_code == 0
    assert result.output.count("cut is cut off: it was played to where it breaks.") == 1
    rows = json.loads((tmp_path / "cut.json").read_text())["runs"]
    assert all(row["counts"]["skipped"]["truncated"] == 1 for row in rows)


def test_what_cannot_be_done_is_one_sentence(walk: Path, tmp_path: Path) -> None:
    """A log that is not there, one that is no log, a name that is none, and nothing left to run."""
    text = tmp_path / "text.mcap"
    text.write_text("no log")
    imu_only = tmp_path / "imu-only.mcap"
    with LogWriter(imu_only, RIG, None, t_start_ns=0) as writer:
        writer.write(ImuSample(1, 1, (0.0, 0.0, 0.0), (0.0, 0.0, 9.81)))
    for paths, names, kind, words in (
        ([tmp_path / "none.mcap"], (), MalformedInput, "There is no file"),
        ([walk, text], (), MalformedInput, "is not an MCAP file"),
        ([walk], ("kalman",), UnknownEstimator, "There is no estimator 'kalman'"),
        ([imu_only], ("gps-imu/cmm",), MissingSensor, "imu-only has no GPS for gps-imu/cmm"),
    ):
        with pytest.raises(kind, match=words) as error:
            evaluate(paths, names, None, _nothing)
        assert str(error.value).endswith(".")
        assert "\n" not in str(error.value)
    with pytest.raises(InputError, match="cannot be written"):
        write_json(Evaluation(), tmp_path / "no folder" / "figures.json")
    with pytest.raises(InputError, match="cannot be written to"):
        evaluate([walk], ("truth",), text, _nothing)
