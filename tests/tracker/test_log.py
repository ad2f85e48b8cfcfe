"""Logs: what is written is read back, by other libraries too, and damage costs only what it touched."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory
from rosbags.highlevel import AnyReader
from rosbags.typesys import Stores, get_typestore

from tracker.errors import InputError, MalformedInput
from tracker.estimator import Origin
from tracker.log import Log
from tracker.log_writer import LogWriter
from tracker.measurements import (
    CompassHeading,
    Frame,
    GpsFix,
    GpsVelocity,
    ImuSample,
    MagSample,
    Measurement,
    TruePose,
)
from tracker.pictures import ArrayPicture
from tracker.rig import CameraModel, Rig

ORIGIN = Origin(37.9366, 27.3447, 88.4)
CAMERA = CameraModel(64, 48, 60.0, 61.0, 31.5, 23.5, "plumb_bob", (-0.1, 0.01, 0.0, 0.0, 0.0))
COV = (4.0, 0.0, 0.0, 0.0, 4.0, 0.0, 0.0, 0.0, 9.0)
MS = 1_000_000
KNOWN = (True, True, True, True, 0.0)
START_NS = 1_000_000_000_000


def _rig() -> Rig:
    T_body_imu = np.eye(4)
    T_body_imu[:3, :3] = np.diag([-1.0, -1.0, 1.0])
    return Rig(T_body_imu=T_body_imu, camera=CAMERA)


def _picture(number: int) -> ArrayPicture:
    rows, columns = np.mgrid[0:48, 0:64]
    pixels = np.stack([rows * 4 + number, columns * 3, rows + columns], axis=2) % 256
    return ArrayPicture(pixels.astype(np.uint8))


def _walk(seconds: int = 3) -> list[Measurement]:
    """Every kind of measurement, in order of arrival."""
    found: list[Measurement] = []
    for index in range(seconds * 100):
        t = START_NS + index * 10 * MS
        late = t + 2 * MS
        found.append(ImuSample(t, late, (0.1, 0.2, index * 1e-3), (0.0, 0.1, 9.81)))
        found.append(TruePose(t, late, (index * 0.01, 1.0, 2.0), (1.0, 0.0, 0.0, 0.0), (1.0, 0.0, 0.0), *KNOWN))
        if index % 10 == 0:
            found.append(MagSample(t, late, (2e-5, 0.0, -4e-5)))
            found.append(CompassHeading(t, late, 1.0))
            found.append(Frame(t, t + 3 * MS, index // 10, _picture(index // 10)))
        if index % 100 == 0:
            found.append(GpsFix(t, t + 4 * MS, 37.9366, 27.3447, 90.0, COV))
            found.append(GpsVelocity(t, t + 4 * MS, (1.0, 0.5, 0.0)))
    return found


def _write(path: Path, measurements: list[Measurement], video: Any = "jpeg") -> Path:
    with LogWriter(path, _rig(), ORIGIN, t_start_ns=START_NS, video=video, rate_hz=10.0) as writer:
        for measurement in measurements:
            writer.write(measurement)
    return path


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A log with every sensor."""
    return _write(tmp_path_factory.mktemp("log") / "walk.mcap", _walk())


def test_reads_back_what_was_written(whole: Path) -> None:
    """Numbers are kept to the last bit, pictures apart; the IMU's axes are turned to the sensor and back."""
    log = Log.open(whole)
    rounded = (Frame, CompassHeading)
    got = list(log.messages())
    exact = sorted((m for m in _walk() if not isinstance(m, rounded)), key=lambda m: m.t_recv_ns)
    assert [m for m in got if not isinstance(m, rounded)] == exact
    assert [m.yaw_rad for m in got if isinstance(m, CompassHeading)] == pytest.approx([1.0] * 30)
    assert not log.skipped
    assert log.info.counts == {
        "imu": 300, "mag": 30, "compass": 30, "gps": 3, "gps_velocity": 3, "frames": 30, "motions": 0, "said": 0, "truth": 300
    }  # fmt: skip
    assert log.info.truth_origin == ORIGIN
    assert log.rig.camera == CAMERA
    np.testing.assert_allclose(log.rig.T_body_imu, _rig().T_body_imu, atol=1e-12)


@pytest.mark.parametrize("video", ["jpeg", "h264"])
def test_pictures_survive(tmp_path: Path, video: str) -> None:
    """Each picture comes back under its own number, from the start and from the middle."""
    log = Log.open(_write(tmp_path / "walk.mcap", _walk(), video))
    for start_ns in (None, START_NS + 1_555 * MS):
        frames = [m for m in log.messages(start_ns=start_ns) if isinstance(m, Frame)]
        assert [f.frame_id for f in frames] == list(range(0 if start_ns is None else 16, 30))
        for frame in frames:
            difference = frame.picture.gray().astype(int) - _picture(frame.frame_id).gray()
            assert np.abs(difference).mean() < 4.0
            assert frame.picture.jpeg().startswith(b"\xff\xd8")
    assert not log.skipped


@pytest.mark.parametrize("video", ["jpeg", "h264"])
def test_pictures_alone_begin_with_the_newest(tmp_path: Path, video: str) -> None:
    log = Log.open(_write(tmp_path / "walk.mcap", _walk(), video))
    whole = [m for m in log.messages() if isinstance(m, Frame)]
    assert list(log.picture_times_ns) == [frame.t_recv_ns for frame in whole]
    for at_ns, first in ((0, 0), (START_NS + 1_555 * MS, 15), (whole[7].t_recv_ns, 7), (whole[-1].t_recv_ns + MS, 29)):
        found = list(log.pictures(at_ns))
        assert [f.frame_id for f in found] == list(range(first, 30))
        np.testing.assert_array_equal(found[0].picture.gray(), whole[first].picture.gray())


def test_reading_from_the_middle_is_the_end_of_reading_all(whole: Path) -> None:
    """A seek must not see other numbers."""
    log = Log.open(whole)
    start_ns = START_NS + 1_234 * MS
    late = [m for m in log.messages() if m.t_recv_ns >= start_ns and not isinstance(m, Frame)]
    assert [m for m in log.messages(start_ns=start_ns) if not isinstance(m, Frame)] == late


def _numbers(value: Any) -> list[object]:
    """Return every number, text and byte in a decoded message of either library, in the order of its definition."""
    if isinstance(value, int | float | str):
        return [value]
    if isinstance(value, bytes | bytearray | memoryview):
        return [bytes(value)]
    if isinstance(value, np.ndarray):
        return [value.tobytes()] if value.dtype == np.uint8 else [float(number) for number in value]
    if isinstance(value, list | tuple):
        return [number for item in value for number in _numbers(item)]
    names = getattr(value, "__slots__", None) or list(vars(value))
    fields = (name for name in names if not name.startswith("_") and not name.isupper())  # capitals are constants
    return [number for name in fields for number in _numbers(getattr(value, name))]


def _by_mcap_ros2_support(path: Path) -> dict[str, list[list[object]]]:
    found: dict[str, list[list[object]]] = {}
    with path.open("rb") as file:
        reader = make_reader(file, decoder_factories=[DecoderFactory()])
        for _, channel, stored, message in reader.iter_decoded_messages():
            found.setdefault(channel.topic, []).append([stored.log_time, *_numbers(message)])
    return found


def _by_rosbags(path: Path) -> dict[str, list[list[object]]]:
    found: dict[str, list[list[object]]] = {}
    with AnyReader([path], default_typestore=get_typestore(Stores.ROS2_HUMBLE)) as reader:
        for connection, t_ns, data in reader.messages():
            message = reader.deserialize(data, connection.msgtype)
            found.setdefault(connection.topic, []).append([t_ns, *_numbers(message)])
    return found


@pytest.mark.parametrize("video", ["jpeg", "h264"])
def test_two_other_libraries_read_the_same_numbers(tmp_path: Path, video: str) -> None:
    """Every message of every topic, by mcap-ros2-support and by rosbags, and as many as were written."""
    path = _write(tmp_path / "walk.mcap", _walk(1), video)
    one, other = _by_mcap_ros2_support(path), _by_rosbags(path)
    camera = "/camera/video" if video == "h264" else "/camera/image/compressed"
    assert {topic: len(messages) for topic, messages in one.items()} == {
        "/imu/data_raw": 100, "/ground_truth/odom": 100, "/imu/mag": 10, "/compass/heading": 10, camera: 10,
        "/gps/fix": 1, "/gps/vel": 1, "/camera/camera_info": 1, "/tf_static": 1, "/ground_truth/origin": 1,
    }  # fmt: skip
    assert one.keys() == other.keys()
    for topic, messages in one.items():
        assert messages == other[topic], topic
    (fix,) = one["/gps/fix"]
    assert {37.9366, 27.3447, 90.0, 4.0, 9.0} <= set(fix)
    imu = one["/imu/data_raw"]
    assert [row[0] for row in imu] == [m.t_recv_ns for m in _walk(1) if isinstance(m, ImuSample)]


def test_a_cut_log_plays_to_where_it_breaks(whole: Path, tmp_path: Path) -> None:
    """The summary, the index and the last chunk are gone."""
    cut = tmp_path / "cut.mcap"
    data = _write(tmp_path / "long.mcap", _walk(20)).read_bytes()
    cut.write_bytes(data[: len(data) * 2 // 3])
    log = Log.open(cut)
    assert log.info.truncated
    imu = [m for m in log.messages() if isinstance(m, ImuSample)]
    assert 100 < len(imu) < 2000
    assert log.skipped["truncated"] == 1


def test_bad_values_are_left_out_and_counted(tmp_path: Path) -> None:
    """NaN, a stamp twice, a stamp that went back, a stamp from the future, bytes that are no picture."""
    nan = float("nan")
    good = [ImuSample(START_NS + i * 10 * MS, START_NS + i * 10 * MS, (0.0,) * 3, (0.0, 0.0, 9.8)) for i in range(5)]
    t_recv = good[-1].t_ns + MS
    bad: list[Measurement] = [
        ImuSample(t_recv, t_recv, (nan, 0.0, 0.0), (0.0, 0.0, 9.8)),
        ImuSample(good[-1].t_ns, t_recv, (0.0,) * 3, (0.0, 0.0, 9.8)),
        ImuSample(good[2].t_ns, t_recv, (0.0,) * 3, (0.0, 0.0, 9.8)),
        ImuSample(t_recv + 10**12, t_recv, (0.0,) * 3, (0.0, 0.0, 9.8)),
    ]
    last = ImuSample(t_recv + MS, t_recv + MS, (0.0,) * 3, (0.0, 0.0, 9.8))
    log = Log.open(_write(tmp_path / "walk.mcap", [*good, *bad, last]))
    assert list(log.messages()) == [*good, last]
    assert log.skipped == {"not_finite": 1, "duplicate_stamp": 1, "stamp_went_back": 1, "stamp_after_arrival": 1}


@pytest.mark.parametrize(
    ("data", "words"),
    [(None, "no file"), (b"", "not an MCAP"), (b"\x00" * 400, "not an MCAP"), (b"no mcap", "not an MCAP")],
)
def test_one_sentence_for_what_is_no_log(tmp_path: Path, data: bytes | None, words: str) -> None:
    """The sentence names the file."""
    path = tmp_path / "walk.mcap"
    if data is not None:
        path.write_bytes(data)
    with pytest.raises(MalformedInput, match=words) as error:
        Log.open(path)
    assert str(path) in str(error.value)


def test_a_log_without_imu_and_gps_is_refused(tmp_path: Path) -> None:
    """It says what is missing."""
    mag = [MagSample(START_NS, START_NS, (1e-5, 0.0, 0.0))]
    with pytest.raises(MalformedInput, match="no IMU and no GPS"):
        Log.open(_write(tmp_path / "walk.mcap", list(mag)))


@settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(cut=st.floats(0.0, 1.0), flips=st.lists(st.tuples(st.floats(0.0, 0.9999), st.integers(0, 255)), max_size=12))
def test_damage_never_escapes(whole: Path, tmp_path: Path, cut: float, flips: list[tuple[float, int]]) -> None:
    """Any cut and any changed bytes: either a clear refusal or a reading to the end."""
    data = bytearray(whole.read_bytes())
    for place, value in flips:
        data[int(place * len(data))] = value
    path = tmp_path / "damaged.mcap"
    path.write_bytes(data[: round(cut * len(data))])
    try:
        log = Log.open(path)
        for measurement in log.messages():
            if isinstance(measurement, Frame):
                measurement.picture.gray()
    except InputError:
        pass


def test_every_real_log_is_read_whole(shared: Path) -> None:
    """Each message of every recording becomes a measurement or a counted reason."""
    for path in sorted((shared / "data").glob("*.mcap")):
        log = Log.open(path)
        end_ns = log.info.t_start_ns + 20_000_000_000
        last_ns = 0
        for measurement in log.messages():
            assert measurement.t_recv_ns >= last_ns
            last_ns = measurement.t_recv_ns
            if last_ns > end_ns:
                break
        assert sum(log.skipped.values()) <= 3, (path, log.skipped)
