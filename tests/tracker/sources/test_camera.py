"""Live cameras: what is asked for and read back, capture time, newest first, and what is said when the camera goes."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from threading import Event, Thread

import cv2
import numpy as np
import pytest
from numpy.typing import NDArray

from tracker.errors import InputError, SourceLost
from tracker.measurements import Frame, Measurement
from tracker.pictures import encode_jpeg
from tracker.sources.camera import LiveCamera, camera_source, without_password
from tracker.sources.camera_file import VideoFile
from tracker.sources.camera_mode import CameraSettings

S = 1_000_000_000
MS = 1_000_000


def grey(value: int) -> NDArray[np.uint8]:
    return np.full((48, 64, 3), value, np.uint8)


def mjpg(value: int) -> NDArray[np.uint8]:
    """A picture as V4L2 gives it in MJPG with conversion off: one row of bytes, longer than the picture."""
    return np.frombuffer(encode_jpeg(grey(value)) + b"\0" * 500, np.uint8)[None, :]


@dataclass
class FakeCamera:
    """A `cv2.VideoCapture` with a script: each step is (time of reading, stamp in ms, picture), or a time at which it has none."""

    steps: list[tuple[int, float, NDArray[np.uint8] | None] | int]
    opened: bool = True
    supported: dict[int, float] = field(default_factory=dict)
    asked: dict[int, float] = field(default_factory=dict)
    now_ns: int = 0
    stamp_ms: float = 0.0
    picture: NDArray[np.uint8] | None = None
    released: int = 0
    stop: Event = field(default_factory=Event)

    def isOpened(self) -> bool:
        return self.opened

    def grab(self) -> bool:
        if not self.steps:
            self.stop.set()
            return False
        step = self.steps.pop(0)
        if isinstance(step, int):
            self.now_ns = step
            return False
        self.now_ns, self.stamp_ms, self.picture = step
        return True

    def retrieve(self) -> tuple[bool, NDArray[np.uint8] | None]:
        return self.picture is not None, self.picture

    def get(self, prop: int, /) -> float:
        return self.stamp_ms if prop == cv2.CAP_PROP_POS_MSEC else self.supported.get(prop, 0.0)

    def set(self, prop: int, value: float, /) -> bool:
        self.asked[prop] = value
        self.supported.setdefault(prop, value)
        return True

    def getBackendName(self) -> str:
        return "FAKE"

    def release(self) -> None:
        self.released += 1


def played(
    camera: FakeCamera, spec: str = "7", settings: CameraSettings | None = None
) -> tuple[LiveCamera, list[Frame]]:
    frames: list[Frame] = []

    def put(measurement: Measurement) -> None:
        assert isinstance(measurement, Frame)
        frames.append(measurement)

    source = LiveCamera(
        spec, settings or CameraSettings(), open_capture=lambda *_: camera, clock_ns=lambda: camera.now_ns
    )
    source.run(put, camera.stop)
    return source, frames


def test_the_drivers_own_stamp_is_the_time_of_capture() -> None:
    camera = FakeCamera([(10 * S + i * 33 * MS + 40 * MS, 10_000.0 + i * 33, grey(i)) for i in range(5)])
    source, frames = played(camera)
    assert [frame.t_ns for frame in frames] == [10 * S + i * 33 * MS for i in range(5)]
    assert [frame.t_recv_ns - frame.t_ns for frame in frames] == [40 * MS] * 5
    assert [frame.frame_id for frame in frames] == [0, 1, 2, 3, 4]
    assert source.status().counts == {"pictures": 5}
    assert camera.released == 1


@pytest.mark.parametrize("stamp", [0.0, -1.0, float("nan"), 5e9], ids=["none", "negative", "nan", "of the time of day"])
def test_without_a_stamp_the_latency_is_taken_off_the_time_of_reading(stamp: float) -> None:
    camera = FakeCamera([(10 * S + i * 33 * MS, stamp, grey(i)) for i in range(3)])
    _, frames = played(camera, settings=CameraSettings(latency_s=0.02))
    assert [frame.t_recv_ns - frame.t_ns for frame in frames] == [20 * MS] * 3


def test_a_streams_clock_is_mapped_and_its_jitter_taken_away() -> None:
    rng = np.random.default_rng(5)
    late_ns = rng.exponential(8 * MS, 200).astype(int)
    steps = [(100 * S + i * 40 * MS + int(late_ns[i]), 1.0 + i * 40.0, grey(1)) for i in range(200)]
    _, frames = played(FakeCamera(list(steps)), "rtsp://camera/1", CameraSettings(latency_s=0.0))
    error_ms = [(frame.t_ns - (100 * S + i * 40 * MS)) / MS for i, frame in enumerate(frames)]
    assert max(map(abs, error_ms[100:])) < 1.0
    assert all(frame.t_ns <= frame.t_recv_ns for frame in frames)


def test_what_lay_in_a_buffer_is_dropped_and_the_newest_handed_over() -> None:
    fresh = [(10 * S + i * 33 * MS + 30 * MS, 10_000.0 + i * 33, grey(1)) for i in range(3)]
    held = [(13 * S + i * MS, 10_100.0 + i * 33, grey(2)) for i in range(60)]  # the thread was away for three seconds
    source, frames = played(FakeCamera([*fresh, *held]))
    assert source.status().counts["late"] >= 40
    assert all(frame.t_recv_ns - frame.t_ns <= 0.5 * S for frame in frames)
    assert [frame.frame_id for frame in frames] == list(range(len(frames)))


def test_a_camera_is_asked_for_its_mode_and_tells_what_it_does() -> None:
    wanted = CameraSettings(width_px=1920, height_px=1080, rate_hz=60.0, exposure_s=0.008)
    camera = FakeCamera(
        [(S, 990.0, grey(0))], supported={cv2.CAP_PROP_FRAME_WIDTH: 1280.0, cv2.CAP_PROP_FRAME_HEIGHT: 720.0}
    )
    told: list[dict[str, object]] = []
    source = LiveCamera("3", wanted, open_capture=lambda *_: camera, clock_ns=lambda: camera.now_ns)
    source.run(lambda _: told.append(dict(source.status().facts)), camera.stop)
    assert camera.asked[cv2.CAP_PROP_FOURCC] == cv2.VideoWriter.fourcc(*"MJPG")
    assert camera.asked[cv2.CAP_PROP_FRAME_WIDTH] == 1920
    assert camera.asked[cv2.CAP_PROP_FPS] == 60
    assert camera.asked[cv2.CAP_PROP_EXPOSURE] == 80
    assert camera.asked[cv2.CAP_PROP_CONVERT_RGB] == 0
    assert told[0] | {"stamps": ""} == {
        "backend": "FAKE",
        "codec": "MJPG",
        "width_px": 1280,
        "height_px": 720,
        "rate_hz": 60.0,
        "exposure_s": 0.008,
        "stamps": "",
        "device": "/dev/video3",
        "serial": "",
    }


def test_a_camera_without_mjpg_converts_its_pictures_itself() -> None:
    camera = FakeCamera([(S, 990.0, grey(0))], supported={cv2.CAP_PROP_FOURCC: float(cv2.VideoWriter.fourcc(*"YUYV"))})
    played(camera)
    assert cv2.CAP_PROP_CONVERT_RGB not in camera.asked


def test_the_cameras_own_jpeg_bytes_go_through_untouched() -> None:
    broken = np.frombuffer(bytes(mjpg(1))[:60], np.uint8)[None, :]
    steps = [(S, 990.0, mjpg(200)), (S + 40 * MS, 1030.0, broken), (S + 80 * MS, 1070.0, mjpg(7))]
    source, frames = played(FakeCamera(list(steps)))
    assert [frame.picture.jpeg() for frame in frames] == [encode_jpeg(grey(200)), encode_jpeg(grey(7))]
    assert [frame.picture.gray()[0, 0] for frame in frames] == [200, 7]
    assert source.status().counts == {"pictures": 3, "broken": 1}


def test_a_camera_that_falls_silent_is_lost_and_one_that_stutters_is_not() -> None:
    stutter = FakeCamera([(S, 990.0, grey(0)), 2 * S, 3 * S, (3 * S + 9, 3000.0, grey(0)), 5 * S])
    assert len(played(stutter)[1]) == 2
    silent = FakeCamera([(S, 990.0, grey(0)), 2 * S, 5 * S])
    source = LiveCamera("7", CameraSettings(), open_capture=lambda *_: silent, clock_ns=lambda: silent.now_ns)
    with pytest.raises(SourceLost, match=r"/dev/video7 is gone: plug the camera in again"):
        source.run(lambda _: None, silent.stop)
    assert not source.status().attached
    assert "plug" in source.status().detail
    assert silent.released == 1


@pytest.mark.parametrize(
    ("spec", "words"),
    [
        ("97", "There is no /dev/video97: plug the camera in"),
        ("/dev/v4l/by-id/none", "There is no /dev/v4l/by-id/none"),
        ("rtsp://user:secret@127.0.0.1:1/x", r"rtsp://127\.0\.0\.1:1/x does not answer"),
    ],
)
def test_a_camera_that_is_not_there_is_lost_with_the_remedy(spec: str, words: str) -> None:
    """By OpenCV itself."""
    source = camera_source(spec, CameraSettings(silent_s=1.0))
    with pytest.raises(SourceLost, match=words):
        source.run(lambda _: None, Event())
    assert "secret" not in source.status().detail


def test_frame_numbers_go_on_when_the_camera_was_put_back() -> None:
    cameras = [FakeCamera([(S * k, S * k / MS - 10, grey(0))]) for k in (1, 2)]
    current = iter(cameras)
    frames: list[Measurement] = []
    source = LiveCamera("7", CameraSettings(), open_capture=lambda *_: next(current), clock_ns=lambda: S * 9)
    for camera in cameras:
        source.run(frames.append, camera.stop)
    assert [frame.frame_id for frame in frames if isinstance(frame, Frame)] == [0, 1]


def test_words_of_the_command_line(tmp_path: Path) -> None:
    video = tmp_path / "a.mp4"
    video.write_bytes(b"")
    assert isinstance(camera_source(str(video)), VideoFile)
    for spec in ("0", "/dev/video12", "rtsp://a/b", "http://a/b", "/dev/v4l/by-id/x"):
        assert isinstance(camera_source(spec), LiveCamera)
    for spec in ("nothing.mp4", "", "zero", "-1", "ftp://a/b"):
        with pytest.raises(InputError, match="There is no camera"):
            camera_source(spec)


def test_a_password_is_not_shown() -> None:
    assert without_password("rtsp://me:secret@host:554/a?b=c") == "rtsp://host:554/a?b=c"
    assert without_password("rtsp://host/a") == "rtsp://host/a"


class _Stream(BaseHTTPRequestHandler):
    """An IP camera: motion JPEG over HTTP, ten pictures, then silence."""

    def do_GET(self) -> None:
        self.send_response(200)
        self.send_header("Content-Type", "multipart/x-mixed-replace; boundary=b")
        self.end_headers()
        for i in range(10):
            data = encode_jpeg(grey(20 * i))
            self.wfile.write(
                b"--b\r\nContent-Type: image/jpeg\r\nContent-Length: %d\r\n\r\n" % len(data) + data + b"\r\n"
            )

    def log_message(self, format: str, *args: object) -> None:
        """Say nothing."""


@contextmanager
def served(handler: type[BaseHTTPRequestHandler]) -> Iterator[str]:
    server = ThreadingHTTPServer(("127.0.0.1", 0), handler)
    thread = Thread(target=server.serve_forever)
    thread.start()
    try:
        yield f"http://127.0.0.1:{server.server_port}/video"
    finally:
        server.shutdown()
        server.server_close()
        thread.join()


def test_a_network_camera_is_read_until_it_ends() -> None:
    """By OpenCV itself, over a real socket."""
    frames: list[Measurement] = []
    with (
        served(_Stream) as url,
        pytest.raises(SourceLost, match="has sent no picture for 1 s: check the camera and the network"),
    ):
        camera_source(url, CameraSettings(silent_s=1.0)).run(frames.append, Event())
    values = [int(frame.picture.gray().mean()) for frame in frames if isinstance(frame, Frame)]
    assert len(values) >= 8
    assert values == sorted(values)


def write_video(path: Path, codec: str, pictures: int, rate_hz: float) -> Path:
    writer = cv2.VideoWriter(str(path), cv2.VideoWriter.fourcc(*codec), rate_hz, (64, 48))
    for i in range(pictures):
        writer.write(grey(10 + 5 * i))
    writer.release()
    return path


@dataclass
class FakeTime:
    """Time that passes by waiting alone."""

    now_ns: int = 5 * S
    on_wait: Callable[[int], None] = lambda _: None

    def clock_ns(self) -> int:
        return self.now_ns

    def wait(self, stop: Event, seconds: float) -> bool:
        self.now_ns += round(seconds * 1e9)
        self.on_wait(self.now_ns)
        return stop.is_set()


@pytest.mark.parametrize("codec", ["mp4v", "MJPG"])
def test_a_file_plays_in_real_time_again_and_again(codec: str, tmp_path: Path) -> None:
    path = write_video(tmp_path / ("a.mp4" if codec == "mp4v" else "a.avi"), codec, 12, 25.0)
    time, stop, frames = FakeTime(), Event(), list[Frame]()

    def put(frame: Measurement) -> None:
        assert isinstance(frame, Frame)
        frames.append(frame)
        if len(frames) == 30:
            stop.set()

    VideoFile(path, CameraSettings(), clock_ns=time.clock_ns, wait=time.wait).run(put, stop)
    steps_ms = np.diff([frame.t_ns for frame in frames]) / MS
    np.testing.assert_allclose(steps_ms, 40.0, atol=0.1)
    assert [frame.frame_id for frame in frames] == list(range(30))
    assert all(frame.t_recv_ns - frame.t_ns == pytest.approx(30 * MS, abs=1000) for frame in frames)
    assert [round(float(frame.picture.gray().mean())) for frame in frames[:12]] == pytest.approx(
        [10 + 5 * i for i in range(12)], abs=3
    )


def test_a_file_passes_over_what_is_late(tmp_path: Path) -> None:
    path = write_video(tmp_path / "a.avi", "MJPG", 20, 25.0)
    time, frames = FakeTime(), list[Measurement]()

    def put(frame: Measurement) -> None:
        frames.append(frame)
        if len(frames) == 3:
            time.now_ns += S // 2  # somebody kept this thread

    source = VideoFile(path, CameraSettings(loop=False), clock_ns=time.clock_ns, wait=time.wait)
    with pytest.raises(SourceLost, match="has ended"):
        source.run(put, Event())
    assert source.status().counts == {"pictures": 20, "late": 8}
    assert len(frames) == 12


def test_a_file_that_is_no_video_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "a.mp4"
    path.write_bytes(b"not a video" * 100)
    with pytest.raises(InputError, match="no video that can be read"):
        camera_source(str(path)).run(lambda _: None, Event())
