"""What the comparison of features with drawn pictures measures, on motions whose errors are known."""

import json
from dataclasses import replace
from heapq import merge
from io import StringIO
from pathlib import Path

import numpy as np
import pytest
from rich.console import Console

from assets.site import load_site
from server.feature_measure import compare, filter_figures, keep, print_table, vision_figures
from server.motions import poses_of
from tests.assets.conftest import SITE
from tracker.errors import InputError
from tracker.evaluate import figures, run
from tracker.geometry import exp as wxyz_of
from tracker.geometry import matrix_from_wxyz
from tracker.log import Log
from tracker.log_writer import LogWriter
from tracker.measurements import Frame, VisualMotion
from tracker.pictures import ArrayPicture
from tracker.simulate import START_NS, Walk, WalkSettings, default_rig, simulate

WALK = Walk(WalkSettings(duration_s=26.0, still_s=2.0, dataset=2), default_rig())


def _motions(turn_deg: float = 0.0, off_deg: float = 0.0, every: int = 4) -> list[VisualMotion]:
    """Exact motions, but for errors of these sizes; a new keyframe with every fourth picture."""
    poses, wrong, found = poses_of(WALK), matrix_from_wxyz(wxyz_of((0.0, np.radians(turn_deg), 0.0))), []
    times = WALK.frame_times()
    for number, (t_ns, t_recv_ns) in enumerate(times[1:], 1):
        t_key_ns = times[(number - 1) // every * every][0]
        T = np.linalg.inv(poses[t_key_ns]) @ poses[t_ns]
        length_m = float(np.linalg.norm(T[:3, 3]))
        direction = T[:3, 3] / max(length_m, 1e-9)
        helper = np.cross(direction, (0.0, 1.0, 0.0))
        if length_m > 0.05:
            direction = np.cos(np.radians(off_deg)) * direction + np.sin(np.radians(off_deg)) * helper / np.linalg.norm(
                helper
            )
        x, y, z = direction.tolist() if length_m > 0.05 else (0.0, 0.0, 0.0)
        R = T[:3, :3] @ wrong
        found.append(VisualMotion(t_ns, t_recv_ns, number, t_key_ns, R, (x, y, z), 100, 5.0, number % every == 0))
    return found


def test_errors_are_those_put_in() -> None:
    motions = _motions(turn_deg=0.3, off_deg=7.0)
    told = vision_figures(WALK, motions)
    assert told["rotation error, median deg"] == pytest.approx(0.3, rel=1e-6)
    assert told["direction error, median deg"] == pytest.approx(7.0, rel=1e-6)
    assert told["motions a second"] == pytest.approx(12.0, rel=0.01)
    assert told["keyframes a second"] == pytest.approx(3.0, rel=0.03)
    assert told["between keyframes, median s"] == pytest.approx(1.0 / 3.0, rel=1e-3)
    assert told["features followed, mean"] == 100.0
    assert told["share with a direction"] == np.mean([any(motion.direction_key) for motion in motions])
    assert 0.2 < told["share with a direction"] < 1.0


def test_a_walk_without_motions_has_none() -> None:
    told = vision_figures(WALK, [])
    assert told["motions a second"] == 0.0
    assert np.isnan(told["rotation error, median deg"])


@pytest.fixture(scope="module")
def log(tmp_path_factory: pytest.TempPathFactory) -> Log:
    """The walk with grey pictures, which show nothing."""
    path = tmp_path_factory.mktemp("walk") / "walk.mcap"
    grey = ArrayPicture(np.full((480, 640, 3), 90, np.uint8))
    frames = (Frame(t_ns, t_recv_ns, i, grey) for i, (t_ns, t_recv_ns) in enumerate(WALK.frame_times()))
    origin = WALK.settings.origin
    with LogWriter(path, WALK.rig, origin, t_start_ns=START_NS, video="jpeg", rate_hz=12.0) as writer:
        for measurement in merge(simulate(WALK), frames, key=lambda m: m.t_recv_ns):
            writer.write(measurement)
    return Log.open(path)


def test_the_filter_gets_the_motions_in_place_of_the_pictures(log: Log) -> None:
    """Without a camera the figures are those of `evaluate`; with exact motions the error against truth is another."""
    told = figures(run(log, "gps-imu/cmm"))
    assert told["truth"] is not None
    assert filter_figures(log, "gps-imu/cmm", _motions()) == {
        "gps-imu/cmm: ATE m": told["truth"]["ate_rmse_m"],
        "gps-imu/cmm: filter error m": told["filter_error_m"]["mean"],
        "gps-imu/cmm: filter error rad": told["filter_error_rad"]["mean"],
    }
    name = "camera-gps-imu/cmm"
    assert filter_figures(log, name, _motions())[f"{name}: ATE m"] != filter_figures(log, name, [])[f"{name}: ATE m"]


def test_a_log_of_another_walk_is_told(log: Log, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(
        "server.feature_measure.rendered_motions", lambda _: [replace(_motions()[0], t_ns=START_NS + 1)]
    )
    with pytest.raises(InputError, match="not dataset 2, seed 5"):
        compare(load_site(SITE), log, 2, 5)


def test_the_table_has_both_and_their_ratio() -> None:
    console = Console(file=StringIO(), width=100)
    print_table({"a": 2.0, "b": 0.0}, {"a": 2.2, "b": 1.0}, console)
    text = console.file.getvalue() if isinstance(console.file, StringIO) else ""
    assert "1.100" in text
    assert "nan" in text


def test_figures_are_kept_walk_by_walk(tmp_path: Path) -> None:
    """A walk measured again takes its own place, and others stay."""
    path = tmp_path / "feature.json"
    keep(path, 4, 1, {"a": 1.0}, {"a": 2.0})
    keep(path, 3, 1, {"a": 3.0}, {"a": 4.0})
    keep(path, 4, 1, {"a": 5.0}, {"a": 6.0})
    walks = json.loads(path.read_text(encoding="utf-8"))["walks"]
    assert [(walk["dataset"], walk["drawn"]["a"], walk["features"]["a"]) for walk in walks] == [
        (3, 3.0, 4.0),
        (4, 5.0, 6.0),
    ]
