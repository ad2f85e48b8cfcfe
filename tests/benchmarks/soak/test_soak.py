"""The soak itself, a few seconds of each part: that it measures what it says. How fast this machine is, is not asked here."""

import json
from dataclasses import replace
from itertools import islice
from pathlib import Path

import numpy as np
import pytest

from assets.site import load_site
from server.options import SITE, require_built
from tests.benchmarks.soak import hours, live, viewers
from tests.benchmarks.soak.__main__ import main
from tests.benchmarks.soak.journal import Interrupted, Journal, Session, interrupted
from tests.benchmarks.soak.live import Sample
from tests.benchmarks.soak.rows import Row, append, section
from tests.benchmarks.soak.to_and_fro import (
    CAMERA_HZ,
    DRAWN_HZ,
    ToAndFro,
    demo_walk,
    endless_sensors,
    frames,
    write_log,
)
from tests.walks import write_walk
from tracker.log import Log
from tracker.measurements import Frame, ImuSample
from tracker.pictures import EncodedPicture, encode_jpeg
from tracker.simulate import START_NS

SECONDS = 4.0


def pictures(number: int) -> list[EncodedPicture]:
    """Return pictures of a wall that slides by."""
    blocks = np.random.default_rng(0).integers(0, 255, (60, 160, 3), np.uint8)
    wall = np.kron(blocks, np.ones((8, 8, 1), np.uint8))
    return [EncodedPicture(encode_jpeg(np.ascontiguousarray(wall[:, i * 4 : i * 4 + 640]))) for i in range(number)]


def test_the_way_back_is_a_walk_too() -> None:
    """At the turn too, velocity is the slope of the place, acceleration that of the velocity, and rates turn the body."""
    there = demo_walk()
    length_s = (len(there.stamps(DRAWN_HZ)) - 1) / DRAWN_HZ
    walk = ToAndFro(there, length_s, faster=1.25, seconds=200.0, seed=1, noise=there.settings.noise)
    step_s = 1e-3
    for t_s in (30.0, 69.0, length_s / 1.25, 85.0, 110.0):
        t_ns = START_NS + round(t_s * 1e9) + np.array([-1, 0, 1]) * round(step_s * 1e9)
        motion = walk.at(t_ns)
        np.testing.assert_allclose((motion.p_m[2] - motion.p_m[0]) / (2 * step_s), motion.v_m_s[1], atol=0.02)
        np.testing.assert_allclose((motion.v_m_s[2] - motion.v_m_s[0]) / (2 * step_s), motion.a_m_s2[1], atol=0.2)
        turned = motion.R_site_body[0].T @ motion.R_site_body[2] / (2 * step_s)
        rate = 0.5 * np.array([turned[2, 1] - turned[1, 2], turned[0, 2] - turned[2, 0], turned[1, 0] - turned[0, 1]])
        np.testing.assert_allclose(rate, motion.omega_body_rad_s[1], atol=0.02)


def test_a_picture_is_of_the_place_where_the_walker_is() -> None:
    """The pictures run to and fro with the walk: picture k of the demo is taken where the demo took it."""
    there = demo_walk()
    drawn = there.stamps(DRAWN_HZ)
    walk = ToAndFro(there, (len(drawn) - 1) / DRAWN_HZ, faster=CAMERA_HZ / DRAWN_HZ, seconds=200.0, seed=1,
                    noise=there.settings.noise)  # fmt: skip
    names = [EncodedPicture(b"%d" % index) for index in range(len(drawn))]
    taken = list(frames(names, 200.0))
    for frame in taken[:: len(taken) // 20]:
        assert isinstance(frame.picture, EncodedPicture)
        there_m = there.at(drawn[int(frame.picture.data) : int(frame.picture.data) + 1]).p_m
        np.testing.assert_allclose(walk.at(np.array([frame.t_ns])).p_m, there_m, atol=1e-3)


def test_the_endless_walk_goes_on_at_its_end() -> None:
    stamps = [m.t_ns for m in islice(endless_sensors(), 60_000) if isinstance(m, ImuSample)]
    assert np.diff(stamps).max() <= 8_000_000
    assert stamps[-1] - stamps[0] > 200e9


def watched(t_s: float, mb: float, viewing: float = 18.0) -> viewers.Sample:
    """Return a sample of a server with viewers."""
    return viewers.Sample(t_s, mb, 100.0, viewing, 10.0 + 3.0 * viewing, 12.0 + viewing, 90)


def test_a_server_is_judged_by_what_stays_when_all_have_gone() -> None:
    nobody = watched(0.0, 100.0, viewing=0.0)
    steady = [watched(float(t), 150.0 + 0.01 * t) for t in range(1, 601)]
    met = {row.name: row.is_met for row in viewers.rows([nobody, *steady, replace(nobody, t_s=601.0)])}
    assert met["the server's memory, last tenth over first"] is True
    assert met["tasks left when all had gone"] is True
    growing = [watched(float(t), 150.0 + 0.1 * t) for t in range(1, 601)]
    left = replace(nobody, t_s=601.0, tasks=11.0, files=13.0)
    broken = [row.name for row in viewers.rows([nobody, *growing, left]) if row.is_met is False]
    assert broken == [
        "the server's memory, last tenth over first",
        "tasks left when all had gone",
        "files left open when all had gone",
    ]


@pytest.mark.slow
def test_viewers_come_and_go_and_leave_nothing(tmp_path: Path) -> None:
    require_built(load_site(SITE))
    log = write_walk(tmp_path / "walk.mcap", 8.0, pictures=True)
    samples = list(viewers.walk(log, tmp_path / "data", 4.0))
    rows = {row.name: row.value for row in viewers.rows(samples)}
    assert rows["viewers that came and went"] >= viewers.PLACES / 2
    assert max(sample.viewers for sample in samples) > 5
    assert rows["tasks left when all had gone"] == 0
    assert rows["files left open when all had gone"] == 0
    assert samples[-1].replay_mb > 50.0


@pytest.mark.slow
def test_a_live_walk_is_watched_to_its_end(tmp_path: Path) -> None:
    require_built(load_site(SITE))
    log, recording = tmp_path / "log.mcap", tmp_path / "recorded" / "walk.mcap"
    recording.parent.mkdir()
    write_log(log, SECONDS, pictures(30))
    samples = list(live.walk(log, recording, SECONDS))
    kept = Log.open(recording)
    rows = {row.name: row for row in live.rows(samples, SECONDS, kept.info.counts)}
    assert all(row.is_met for row in rows.values() if row.name.startswith("inertial samples played")), rows
    assert samples[-1].played["imu"] > 250
    assert samples[-1].rss_mb > 50.0
    assert any(isinstance(m, Frame) for m in kept.messages(truth=False))


def test_what_a_core_keeps_is_measured_while_it_is_fed() -> None:
    marks = list(hours.replay(6.0, 2.0))
    assert [mark.replayed_s for mark in marks] == [2.0, 4.0, 6.0]
    assert marks[-1].samples == pytest.approx(6 * 277, abs=30)
    rows = {row.name: row for row in hours.rows(marks)}
    assert rows["memory at the end"].value > 50.0


def sample(t_s: float, rss_mb: float) -> Sample:
    """Return a walk that is well."""
    return Sample(t_s, 250.0, 15.0, 0.3, 2.0, 9.0, {}, {"imu": 0}, {"imu": 0}, rss_mb, 0.3 * t_s, 1.3 * t_s)


def test_growth_is_that_after_the_first_minute() -> None:
    samples = [sample(float(t), 200.0 + min(t, 60) + 0.5 * max(0, t - 60) / 60) for t in range(600)]
    assert live.growth_mb_min(samples) == pytest.approx(0.5)
    rows = {row.name: row for row in live.rows(samples, 600.0, {"imu": 0, "mag": 0, "motions": 9000})}
    assert rows["memory's growth after the first minute"].is_met
    assert rows["cores that others' work took"].value == pytest.approx(1.0)
    slow = [replace(each, poses_hz=50.0 if each.t_s == 300.0 else 250.0) for each in samples]
    rows = {row.name: row for row in live.rows(slow, 600.0, {"imu": 1, "mag": 0, "motions": 900})}
    assert rows["poses a second, least of any two seconds"].is_met is False
    assert rows["vision's estimates a second, as recorded"].is_met is False


def test_a_leak_is_seen() -> None:
    marks = [hours.Mark(1800.0 * n, 60.0 * n, 200.0 + n, n, True) for n in range(1, 17)]
    rows = {row.name: row for row in hours.rows(marks)}
    assert rows["memory at the end over that after the first half hour"].is_met is False


def test_the_page_tells_limits_and_verdicts(tmp_path: Path) -> None:
    page = tmp_path / "docs" / "soak.md"
    page.parent.mkdir()
    rows = [Row("p99", 6.25, "ms", most=5.0), Row("poses", 250.0, "", least=60.0), Row("cores", 0.3, "")]
    append(page, section("first", ["One.", "Two."], rows))
    append(page, section("second", ["Three."], []))
    text = page.read_text(encoding="utf-8")
    assert "| p99 | 6.25 ms | at most 5 ms | **no** |" in text
    assert "| poses | 250 | at least 60 | yes |" in text
    assert "| cores | 0.30 |  |  |" in text
    assert text.index("# Soak") < text.index("## first") < text.index("One. Two.") < text.index("## second")


def test_a_run_that_was_interrupted_is_told_once(tmp_path: Path) -> None:
    whole, cut = Journal(tmp_path, "hours", {"title": "whole"}), Journal(tmp_path, "live", {"title": "cut"})
    whole.add({"rss_mb": 1})
    whole.end()
    cut.add({"rss_mb": 1})
    assert not interrupted_now(tmp_path)  # it goes on
    cut.close()
    with next(tmp_path.glob("live-*.jsonl")).open("a", encoding="utf-8") as file:
        file.write('{"rss_mb"')  # a power cut in the middle of a line
    (run,) = interrupted_now(tmp_path)
    assert (run.about["title"], run.lines) == ("cut", 1)
    assert not interrupted_now(tmp_path)


def interrupted_now(folder: Path) -> list[Interrupted]:
    return list(interrupted(folder))


def test_what_was_interrupted_goes_on_with_the_part_that_was(tmp_path: Path) -> None:
    parts = ("live", "hours")
    Session(tmp_path, parts, "abc").finish("live")
    assert Session(tmp_path, parts, "abc").left == ("hours",)
    assert Session(tmp_path, parts, "def").left == parts
    Session(tmp_path, parts, "abc").finish("hours")
    assert Session(tmp_path, parts, "abc").left == parts


def test_the_command_appends_to_the_page_and_its_code_is_the_verdict(tmp_path: Path) -> None:
    cut = {"when": "2026-11-28 20:00 UTC", "title": "10 minutes, live", "commit": "abc"}
    Journal(tmp_path / "soak", "live", cut).close()
    page = tmp_path / "soak.md"
    asked = ["--only", "hours", "--hours", "0.002", "--folder", str(tmp_path / "soak"), "--document", str(page)]
    code = main([*asked, "--note", "Beside the tests."])
    text = page.read_text(encoding="utf-8")
    assert "10 minutes, live, interrupted" in text
    assert "0.002 hours, as fast as possible" in text
    assert "Beside the tests." in text
    assert code == int("**no**" in text)
    journal = next((tmp_path / "soak").glob("hours-*.jsonl")).read_text(encoding="utf-8").splitlines()
    assert json.loads(journal[-1]) == {"end": True}
