"""The rig file: exact there and back, strict about what people type, and what it does to measurements."""

import datetime
import tempfile
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tracker.errors import InputError
from tracker.geometry import exp, matrix_from_wxyz, transform
from tracker.measurements import Frame, GpsFix, ImuSample, MagSample
from tracker.pictures import EncodedPicture
from tracker.rig import CameraModel, Rig
from tracker.rig_file import RigFile, find_rig_file, read_rig_file, write_rig_file
from tracker.rig_sheets import CameraMountSheet, CameraSheet, GpsMountSheet, ImuMountSheet, ImuSheet, MagSheet
from tracker.sheet import Rows

DAY = datetime.date(2026, 5, 17)
CAMERA = CameraModel(1280, 720, 905.125, 904.0, 640.7, 355.2, "plumb_bob", (-0.31, 0.1, 1e-4, -2e-4, 0.0))


def rows(matrix: np.ndarray) -> Rows:
    return tuple(tuple(row) for row in matrix.tolist())


T = rows(transform(exp((0.1, -0.7, 2.0)), (0.1, 0.2, -0.3)))
FULL = RigFile(
    camera=CameraSheet.of(
        CAMERA,
        date=DAY,
        device='C920 "HD"\\',
        serial="αβγ\n#",
        method="board",
        rms_px=0.21,
        focal_sigma_px=0.4,
        views=31,
        coverage=0.83,
    ),
    camera_mount=CameraMountSheet(
        date=DAY, T_body_cam=T, time_offset_s=-0.0213, rotation_sigma_rad=1e-3, time_sigma_s=4e-4, residual_px=0.3
    ),
    imu_mount=ImuMountSheet(T_body_imu=T),
    gps_mount=GpsMountSheet(T_body_gps=T),
    imu=ImuSheet(
        date=DAY,
        gyro_bias_rad_s=(0.01, -0.02, 1 / 3),
        accel_bias_m_s2=(0.1, 0.0, -0.2),
        accel_scale=(1.01, 0.99, 1.0),
        gyro_noise_rad_s_sqrt_hz=(1e-4,) * 3,
        accel_noise_m_s2_sqrt_hz=(1e-3,) * 3,
        gyro_bias_sigma_rad_s=(1e-5,) * 3,
        duration_s=30.0,
        attitudes=6,
    ),
    mag=MagSheet(
        date=DAY,
        hard_iron_t=(1e-5, -2e-5, 3e-6),
        soft_iron=((1.1, 0.02, 0.0), (0.02, 0.95, 0.01), (0.0, 0.01, 1.0)),
        strength_t=46.3e-6,
        residual=0.012,
        coverage=0.9,
        place="37.9366 N, 27.3447 E",
    ),
)


@pytest.mark.parametrize("rig_file", [RigFile(), RigFile(mag=FULL.mag), FULL], ids=["empty", "one", "all"])
def test_what_is_written_is_read_again_to_the_last_bit(rig_file: RigFile, tmp_path: Path) -> None:
    path = tmp_path / "new" / "rig.toml"
    write_rig_file(path, rig_file)
    assert read_rig_file(path) == rig_file
    assert [file.name for file in path.parent.iterdir()] == ["rig.toml"]


def test_one_calibration_keeps_what_the_others_wrote(tmp_path: Path) -> None:
    path = tmp_path / "rig.toml"
    write_rig_file(path, FULL)
    write_rig_file(path, replace(read_rig_file(path), camera=None))
    assert read_rig_file(path) == replace(FULL, camera=None)


@given(st.text(st.characters(codec="utf-8"), max_size=30), st.floats(1.0, 1e6), st.floats(0.0, 1.0))
def test_any_name_and_number_survives(name: str, focal_px: float, coverage: float) -> None:
    assert FULL.camera is not None
    sheet = replace(FULL.camera, device=name, serial=name[::-1], fx_px=focal_px, coverage=coverage)

    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "rig.toml"
        write_rig_file(path, RigFile(camera=sheet))
        assert read_rig_file(path).camera == sheet


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("fx_px = 905.125", "fx_px = -3.0", ("[camera] fx_px", "-3", "agora calibrate camera")),
        ("fx_px = 905.125", "fx_px = nan", ("fx_px", "nan")),
        ("fx_px = 905.125", "fx_px = true", ("fx_px", "expected a number")),
        ("fx_px = 905.125", "", ("lacks fx_px", "focal length across")),
        ("fx_px = 905.125", "fx_px = 905.125\nfocal = 3", ("unknown key 'focal'",)),
        ("views = 31", "views = 31.5", ("views", "a whole number")),
        ("views = 31", "views = -1", ("views", "0 to")),
        ("2026-05-17", '"soon"', ("date", "a date such as")),
        ("2026-05-17", "2026-05-17T01:02:03", ("date", "a date such as")),
        ('"plumb_bob"', '"fisheye"', ("distortion_model", "equidistant")),
        ('"board"', "3", ("method", "a text")),
        ("hard_iron_t = [1e-05, -2e-05, 3e-06]", "hard_iron_t = [1e-05]", ("[mag] hard_iron_t", "3 numbers")),
        ("hard_iron_t = [1e-05, -2e-05, 3e-06]", "hard_iron_t = [10.0, 1.0, 2.0]", ("hard_iron_t", "calibrate mag")),
        ("[1.1, 0.02, 0.0]", "[0.02, 0.95, 0.01]", ("soft_iron", "inside out or flat")),
        ("    [0.0, 0.0, 0.0, 1.0],", "    [0.0, 0.0, 0.0, 2.0],", ("T_body_cam", "no rotation")),
        ("[camera]", "[kamera]", ("unknown table 'kamera'",)),
        ("[gps_mount]", "gps_mount = 3\n[[x]]", ("x",)),
        ("[camera]", "[camera", ("no TOML",)),
    ],
)
def test_a_mistyped_file_is_refused_with_key_and_remedy(
    old: str, new: str, words: tuple[str, ...], tmp_path: Path
) -> None:
    path = tmp_path / "rig.toml"
    write_rig_file(path, FULL)
    text = path.read_text(encoding="utf-8")
    assert old in text
    path.write_text(text.replace(old, new, 1), encoding="utf-8")
    with pytest.raises(InputError) as caught:
        read_rig_file(path)
    message = str(caught.value)
    assert all(word in message for word in (*words, str(path))), message


@given(st.binary(max_size=200))
def test_bytes_are_a_rig_file_or_one_sentence(data: bytes) -> None:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "rig.toml"
        path.write_bytes(b"[camera]\n\xff" + data)
        with pytest.raises(InputError, match=r"rig\.toml"):
            read_rig_file(path)


def test_a_rotation_typed_with_four_digits_becomes_one_and_stays(tmp_path: Path) -> None:
    path = tmp_path / "rig.toml"
    rough = rows(np.round(np.array(T), 4))
    write_rig_file(path, RigFile(imu_mount=ImuMountSheet(T_body_imu=rough)))
    read = read_rig_file(path)
    R = read.rig().T_body_imu[:3, :3]
    np.testing.assert_allclose(R @ R.T, np.eye(3), atol=1e-12)
    np.testing.assert_allclose(R, np.array(T)[:3, :3], atol=2e-4)
    write_rig_file(path, read)
    assert read_rig_file(path) == read


def test_a_file_that_was_asked_for_must_be_there(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(InputError, match="cannot be read"):
        find_rig_file(tmp_path / "none.toml")
    monkeypatch.setenv("HOME", str(tmp_path))
    assert find_rig_file(None) == RigFile()
    write_rig_file(tmp_path / ".config" / "agora" / "rig.toml", FULL)
    assert find_rig_file(None) == FULL


def test_a_place_that_cannot_be_written_to_is_told(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("", encoding="utf-8")
    with pytest.raises(InputError, match="cannot be written"):
        write_rig_file(tmp_path / "file" / "rig.toml", FULL)


def test_the_rig_of_a_file() -> None:
    rig = FULL.rig()
    assert rig.camera == CAMERA
    for matrix in (rig.T_body_imu, rig.T_body_gps, rig.T_body_cam):
        np.testing.assert_array_equal(matrix, np.array(T))
    np.testing.assert_array_equal(RigFile().rig().T_body_cam, Rig().T_body_cam)
    assert RigFile().rig().camera is None


def test_samples_are_corrected_in_the_sensors_own_axes() -> None:
    """What a perfect sensor would say comes back, whatever the mount: planted errors are taken off again."""
    R_body_imu = matrix_from_wxyz(exp((0.1, -0.7, 2.0)))
    assert FULL.imu is not None
    assert FULL.mag is not None
    gyro, accel, field = np.array([0.3, -0.1, 0.2]), np.array([1.0, -2.0, 9.5]), np.array([2e-5, 1e-5, -4e-5])
    raw_gyro = gyro + FULL.imu.gyro_bias_rad_s
    raw_accel = accel / FULL.imu.accel_scale + FULL.imu.accel_bias_m_s2
    raw_field = np.linalg.inv(np.array(FULL.mag.soft_iron)) @ field + FULL.mag.hard_iron_t
    imu = FULL.correct(ImuSample(5, 6, tuple(R_body_imu @ raw_gyro), tuple(R_body_imu @ raw_accel)))
    mag = FULL.correct(MagSample(5, 6, tuple(R_body_imu @ raw_field)))
    assert isinstance(imu, ImuSample)
    assert isinstance(mag, MagSample)
    assert (imu.t_ns, imu.t_recv_ns, mag.t_ns, mag.t_recv_ns) == (5, 6, 5, 6)
    np.testing.assert_allclose(imu.gyro_rad_s, R_body_imu @ gyro, atol=1e-15)
    np.testing.assert_allclose(imu.accel_m_s2, R_body_imu @ accel, atol=1e-14)
    np.testing.assert_allclose(mag.field_body_t, R_body_imu @ field, atol=1e-19)


def test_a_picture_goes_over_to_the_inertial_units_clock_but_never_past_its_arrival() -> None:
    def shifted(offset_s: float) -> int:
        assert FULL.camera_mount is not None
        rig_file = RigFile(camera_mount=replace(FULL.camera_mount, time_offset_s=offset_s))
        frame = rig_file.correct(Frame(1_000_000_000, 1_010_000_000, 3, EncodedPicture(b"")))
        assert isinstance(frame, Frame)
        assert (frame.frame_id, frame.t_recv_ns) == (3, 1_010_000_000)
        return frame.t_ns

    assert [shifted(s) for s in (-0.02, 0.004, 0.5)] == [980_000_000, 1_004_000_000, 1_010_000_000]


def test_what_there_is_nothing_to_correct_of_is_the_very_same() -> None:
    fix = GpsFix(1, 2, 37.9, 27.3, 88.0, (1.0,) * 9)
    sample = ImuSample(1, 2, (0.0,) * 3, (0.0, 0.0, 9.81))
    assert FULL.correct(fix) is fix
    assert RigFile().correct(sample) is sample
