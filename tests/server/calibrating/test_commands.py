"""`agora calibrate` from recordings: what it finds, keeps, says and refuses."""

import json
from datetime import date
from heapq import merge
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest
from typer.testing import CliRunner, Result

from server.cli import app
from tests.tracker.calibrate.board_video import BoardVideo, shown_around
from tests.tracker.calibrate.board_walk import CAMERA, BoardWalk
from tests.tracker.calibrate.pan_video import PanVideo
from tests.tracker.calibrate.rig_motion import RigMotion
from tests.tracker.calibrate.test_magnetometer import planted, readings, tumbled
from tests.tracker.calibrate.test_rest import at_rest, held_by_a_hand
from tests.walks import write_walk
from tracker import rotations
from tracker.errors import InputError
from tracker.geometry import wxyz_from_matrix
from tracker.log_writer import LogWriter
from tracker.measurements import GpsFix, Measurement
from tracker.rig import R_BODY_CAM_FORWARD, CameraModel, Rig
from tracker.rig_file import RigFile, read_rig_file, write_rig_file
from tracker.rig_sheets import CameraSheet, GpsMountSheet

T_ZERO_NS = 1_790_000_000_000_000_000


def run(*arguments: object) -> Result:
    return CliRunner().invoke(app, ["calibrate", *map(str, arguments)])


def told(result: Result) -> dict[str, Any]:
    assert result.exit_code == 0, result.output
    return dict(json.loads(result.stdout))


def write(path: Path, *streams: list[Any], rig: Rig | None = None) -> Path:
    with LogWriter(path, rig or Rig(), t_start_ns=0) as writer:
        for measurement in merge(*streams, key=lambda m: m.t_recv_ns):
            writer.write(measurement)
    return path


def shifted(samples: list[Any]) -> list[Measurement]:
    """Return measurements at a time of the day."""
    from dataclasses import replace

    return [replace(s, t_ns=s.t_ns + T_ZERO_NS, t_recv_ns=s.t_recv_ns + T_ZERO_NS) for s in samples]


@pytest.fixture(scope="module")
def board_video(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A compressed video of a board shown around."""
    path, video = tmp_path_factory.mktemp("board") / "board.avi", BoardVideo(CAMERA, seed=9)
    writer = cv2.VideoWriter(str(path), cv2.VideoWriter.fourcc(*"MJPG"), 2.0, (640, 480))
    for i, (R, p) in enumerate(shown_around(video, 60)):
        writer.write(cv2.cvtColor(video.picture(R, p, i), cv2.COLOR_GRAY2BGR))
    writer.release()
    return path


@pytest.fixture(scope="module")
def board_log(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A rig that turns before the board."""
    walk = BoardWalk(4)
    return write(
        tmp_path_factory.mktemp("walk") / "walk.mcap",
        list(walk.motion.samples(T_ZERO_NS)),
        list(walk.frames(T_ZERO_NS)),
    )


def test_camera_then_rig_from_a_board_and_each_keeps_what_was_there(
    board_video: Path, board_log: Path, tmp_path: Path
) -> None:
    """K within 0.5 %, rotation within 0.2 degrees, time offset within 3 ms; the antenna's place, typed by hand, stays."""
    rig = tmp_path / "rig.toml"
    antenna = GpsMountSheet(
        T_body_gps=((1.0, 0.0, 0.0, 0.1), (0.0, 1.0, 0.0, 0.0), (0.0, 0.0, 1.0, 0.3), (0.0, 0.0, 0.0, 1.0))
    )
    write_rig_file(rig, RigFile(gps_mount=antenna))
    lens = told(run("camera", "--log", board_video, "--rig", rig, "--json", "--report", tmp_path / "report"))
    assert lens["verdict"] == "excellent"
    mount = told(run("rig", "--log", board_log, "--rig", rig, "--json", "--report", tmp_path / "turns"))
    assert mount["by"] == "board"
    kept = read_rig_file(rig)
    assert kept.gps_mount == antenna
    assert kept.camera is not None
    assert kept.camera_mount is not None
    assert kept.camera.method == "board"
    assert kept.camera.device == "seen in board.avi"
    assert kept.camera.fx_px == pytest.approx(CAMERA.fx_px, rel=0.005)
    assert kept.camera.fy_px == pytest.approx(CAMERA.fy_px, rel=0.005)
    assert (kept.camera.cx_px, kept.camera.cy_px) == pytest.approx((CAMERA.cx_px, CAMERA.cy_px), abs=3.0)
    walk = BoardWalk(4)
    R = walk.R_body_cam.T @ kept.rig().T_body_cam[:3, :3]
    assert np.degrees(np.linalg.norm(rotations.log(np.array([wxyz_from_matrix(R)])))) < 0.2
    assert kept.camera_mount.time_offset_s == pytest.approx(walk.offset_s, abs=0.003)
    page = (tmp_path / "report" / "index.html").read_text(encoding="utf-8")
    assert "A corner seen again is off by" in page
    assert page.count("<img") == 2
    assert (tmp_path / "turns" / "turning.svg").is_file()


def test_one_lively_recording_before_the_board_tells_lens_and_mount(tmp_path: Path) -> None:
    walk = BoardWalk(6, 10.0, lively=True)
    log = write(tmp_path / "walk.mcap", list(walk.motion.samples(T_ZERO_NS)), list(walk.frames(T_ZERO_NS)))
    found = told(run("rig", "--log", log, "--rig", tmp_path / "rig.toml", "--json"))
    assert found["kept"] == ["camera", "camera_mount"]
    assert found["lens"]["fx_px"] == pytest.approx(CAMERA.fx_px, rel=0.005)
    assert found["time_offset_s"] == pytest.approx(walk.offset_s, abs=0.003)
    R = walk.R_body_cam.T @ np.array(found["R_body_cam"])
    assert np.degrees(np.linalg.norm(rotations.log(np.array([wxyz_from_matrix(R)])))) < 0.2


def test_recordings_of_different_pictures_or_without_a_gyroscope_are_named(board_log: Path, tmp_path: Path) -> None:
    motion = RigMotion(3, 0.5)
    video = PanVideo(CameraModel(320, 240, 300.0, 300.0, 159.5, 119.5), motion, R_BODY_CAM_FORWARD, 0.0)
    small = write(tmp_path / "small.mcap", list(motion.samples(T_ZERO_NS)), list(video.frames(T_ZERO_NS)))
    sizes = run("rig", "--log", board_log, "--log", small, "--rig", tmp_path / "rig.toml").exception
    assert isinstance(sizes, InputError)
    assert "walk.mcap has pictures of 640 x 480 px, but small.mcap of 320 x 240" in str(sizes)
    blind = write(tmp_path / "blind.mcap", list(motion.samples(T_ZERO_NS)))
    pictures = run("rig", "--log", small, "--log", blind, "--rig", tmp_path / "rig.toml").exception
    assert isinstance(pictures, InputError)
    assert str(pictures).startswith("blind.mcap: There are no pictures in this")


def test_two_recordings_before_the_board_are_one_calibration(board_log: Path, tmp_path: Path) -> None:
    rig, report = tmp_path / "rig.toml", tmp_path / "report"
    known = CameraSheet.of(
        CAMERA, date=date(2026, 1, 1), method="board", rms_px=0.1, focal_sigma_px=0.1, views=40, coverage=0.9
    )
    write_rig_file(rig, RigFile(camera=known))
    found = told(run("rig", "--log", board_log, "--log", board_log, "--rig", rig, "--json", "--report", report))
    assert (found["by"], found["kept"]) == ("board", ["camera_mount"])
    assert [one["name"] for one in found["recordings"]] == ["walk.mcap"] * 2
    for one in found["recordings"]:
        assert one["time_offset_s"] == pytest.approx(BoardWalk(4).offset_s, abs=0.003)
    assert found["time_offset_s"] == pytest.approx(found["recordings"][0]["time_offset_s"], abs=1e-6)
    assert found["rotation_apart_deg"] == 0.0
    assert {file.name for file in report.glob("*.svg")} == {"turning.svg", "turning-2.svg"}


def test_photographs_in_a_folder_do_as_well(tmp_path: Path) -> None:
    video = BoardVideo(CAMERA, seed=3)
    for i, (R, p) in enumerate(shown_around(video, 40)):
        cv2.imwrite(str(tmp_path / f"{i:03d}.png"), video.picture(R, p, i))
    found = told(run("camera", "--log", tmp_path, "--rig", tmp_path / "rig.toml", "--json", "--dry-run"))
    assert found["fx_px"] == pytest.approx(CAMERA.fx_px, rel=0.005)
    assert not (tmp_path / "rig.toml").exists()


def test_rig_refuses_pictures_of_another_shape_than_the_lens_was_calibrated_at(board_log: Path, tmp_path: Path) -> None:
    from server.calibrating.lens_run import result_of
    from tracker.calibrate.camera_lens import LensFit

    wide = CameraModel(1280, 720, 900.0, 900.0, 640.0, 360.0)
    result_of(LensFit(wide, 0.1, True, 0.1, (), (), np.zeros(0)), ("", "")).keep(tmp_path / "rig.toml")
    result = run("rig", "--log", board_log, "--rig", tmp_path / "rig.toml")
    assert isinstance(result.exception, InputError)
    assert "calibrated at 1280 x 720" in str(result.exception)


def test_a_walk_without_a_board_is_no_calibration_of_a_lens(tmp_path: Path) -> None:
    log = write_walk(tmp_path / "walk.mcap", 3.0, pictures=True)
    result = run("camera", "--log", log, "--rig", tmp_path / "rig.toml")
    assert isinstance(result.exception, InputError)
    assert "The board is in none of the" in str(result.exception)
    assert not (tmp_path / "rig.toml").exists()


def test_imu_at_rest_is_kept_and_a_rig_in_a_hand_is_refused(tmp_path: Path) -> None:
    rig, bias = tmp_path / "rig.toml", np.array([0.01, -0.004, 0.002])
    fix = [GpsFix(T_ZERO_NS, T_ZERO_NS, 37.94, 27.34, 88.0, (1.0,) * 9)]
    log = write(tmp_path / "rest.mcap", shifted(at_rest(12.0, bias=bias, accel=np.array([0.0, 0.0, 9.90]))), fix)
    found = told(run("imu", "--log", log, "--rig", rig, "--json", "--report", tmp_path / "report"))
    np.testing.assert_allclose(found["gyro_bias_rad_s"], bias, atol=1e-4)
    assert found["accel_scale"] == pytest.approx([9.799 / 9.90] * 3, rel=2e-4)
    kept = read_rig_file(rig).imu
    assert kept is not None
    assert kept.device == "recorded in rest.mcap"
    assert (tmp_path / "report" / "rest.svg").is_file()
    moving = write(tmp_path / "hand.mcap", shifted(at_rest(12.0, motion=held_by_a_hand)))
    result = run("imu", "--log", moving, "--rig", rig)
    assert isinstance(result.exception, InputError)
    assert "The rig moved" in str(result.exception)
    assert read_rig_file(rig).imu == kept


def test_mag_is_judged_by_the_model_of_the_place(tmp_path: Path) -> None:
    soft, hard = planted(11)
    samples, inertial = readings(tumbled(11), soft, hard)
    fix = [GpsFix(T_ZERO_NS, T_ZERO_NS, 37.94, 27.34, 88.0, (1.0,) * 9)]
    log = write(tmp_path / "tumble.mcap", shifted(samples), shifted(inertial), fix)
    found = told(run("mag", "--log", log, "--rig", tmp_path / "rig.toml", "--json", "--report", tmp_path / "report"))
    assert found["expected"]["declination_deg"] == pytest.approx(5.5, abs=0.2)
    assert found["dip_deg"] == pytest.approx(found["expected"]["dip_deg"], abs=1.0)
    np.testing.assert_allclose(found["hard_iron_t"], hard, atol=0.5e-6)
    kept = read_rig_file(tmp_path / "rig.toml").mag
    assert kept is not None
    assert kept.place == "37.94 N, 27.34 E"
    assert {file.name for file in (tmp_path / "report").iterdir()} == {"index.html", "field.svg", "directions.svg"}


def test_a_field_that_dips_as_nowhere_near_is_not_kept_and_ends_with_one(tmp_path: Path) -> None:
    samples, inertial = readings(tumbled(12), *planted(12))
    log = write(tmp_path / "tumble.mcap", shifted(samples), shifted(inertial))
    result = run("mag", "--log", log, "--rig", tmp_path / "rig.toml", "--place", "1.0,103.8")
    assert result.exit_code == 1
    assert "nothing was kept" in result.output.replace("\n", " ")
    assert not (tmp_path / "rig.toml").exists()


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("imu", "--log", "nowhere.mcap"), "There is no nowhere.mcap"),
        (("mag", "--log", "nowhere.mcap", "--place", "north"), "give it as 37.94,27.34"),
        (("mag", "--log", "nowhere.mcap", "--place", "100,0"), "not on the Earth"),
        (("camera", "--log", "nowhere.mcap", "--squares", "many"), "give it as 9x6"),
        (("camera", "--log", ".", "--squares", "2x2"), "is none"),
        (("rig", "--log", "nowhere.mcap", "--rig", "pyproject.toml"), "unknown table"),
        (("imu", "--imu", "compass"), "names nothing"),
    ],
)
def test_what_makes_no_sense_is_one_sentence(arguments: tuple[str, ...], words: str) -> None:
    error = run(*arguments).exception
    assert isinstance(error, InputError)
    assert words in str(error)


def test_the_board_is_printed(tmp_path: Path) -> None:
    result = run("board", tmp_path / "board.pdf")
    assert result.exit_code == 0
    assert (tmp_path / "board.pdf").read_bytes().startswith(b"%PDF-1.4")


def test_the_pan_of_a_phone_tells_the_focal_length_but_not_the_rotation_about_its_own_axis(
    shared: Path, tmp_path: Path
) -> None:
    """../shared/data/README.md, trap 4: 478 px were fitted to the gyroscope on three pans (468, 481, 482)."""
    log, rig = shared / "data" / "transformflow-1606.mcap", tmp_path / "rig.toml"
    found = told(run("rig", "--log", log, "--rig", rig, "--json"))
    assert found["kept"] == ["camera"]
    assert found["focal_px"] == pytest.approx(478.0, rel=0.03)
    least_px, most_px = found["focal_between_px"]
    assert least_px < 478.0 < most_px < 1.1 * found["focal_px"]
    assert found["readout_s"] == pytest.approx(0.024, abs=0.004)
    assert len(found["doubts"]) == 1
    assert "nod and tilt as well" in found["doubts"][0]
    camera = read_rig_file(rig).camera
    assert camera is not None
    assert (camera.method, camera.width_px, camera.height_px) == ("pan", 480, 360)
