"""A rig whose server goes away: it tracks on, finds it again, and has nothing old to tell."""

import json
import socket
import subprocess
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from time import monotonic, monotonic_ns, sleep

import httpx
import numpy as np
import pytest
from websockets.exceptions import WebSocketException
from websockets.sync.client import connect

from server import push
from server.live_rig import LiveRig
from server.placing import Placing
from server.wire import decode_frame, is_frame
from tests.server.serving import serving, token, until
from tests.walks import write_walk
from tracker.log import Log
from tracker.measurements import ImuSample
from tracker.simulate import AGORA_ORIGIN
from tracker.sources.played import Played

S = 1_000_000_000

_SERVE = """
import sys
from pathlib import Path
from server.access import Access
from server.app import create_app
from server.grants import LOCAL
from server.web_server import WebServer
from threading import Event
folder = Path(sys.argv[1])
app = create_app(web_folder=folder, models_folder=folder, site={}, access=Access.with_secret(bytes(32), LOCAL))
with WebServer(app, port=int(sys.argv[2])) as server:
    print(server.port, flush=True)
    Event().wait()
"""


@contextmanager
def server_process(folder: Path, port: int = 0) -> Iterator[tuple[subprocess.Popen[str], int]]:
    """Run a real server in a process of its own; leaving kills it without a word."""
    command = [sys.executable, "-c", _SERVE, str(folder), str(port)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        try:
            yield process, int(process.stdout.readline())
        finally:
            process.kill()


@pytest.fixture(scope="module")
def log(tmp_path_factory: pytest.TempPathFactory) -> Log:
    """Twenty seconds with pictures."""
    return Log.open(write_walk(tmp_path_factory.mktemp("logs") / "wall.mcap", 20.0, pictures=True))


def live_rig(log: Log, record: Path | None = None) -> LiveRig:
    played = Played(log, looping=True)
    placing = Placing(AGORA_ORIGIN, lambda e, n: 0.0, lambda e, n: 1.65, 1.65)
    return LiveRig([played.source(name) for name in ("gps", "imu", "camera")], log.rig, placing, record=record)


def test_the_rig_tracks_on_while_its_server_is_killed_and_sends_the_newest_first(log: Log, tmp_path: Path) -> None:
    """Whole state and newest picture come at once with the new server; none of those taken meanwhile.

    However long it was away: attempts are a second apart at most, and one picture, one pose and the state are all that is kept.
    """
    rig = live_rig(log)
    with server_process(tmp_path) as (_, port):
        rig.start(f"ws://127.0.0.1:{port}/ws/rig/walk", token("rig", "walk"))
        until(lambda: rig.link is not None and rig.link.connected and rig.state.pose is not None)
    until(lambda: rig.link is not None and not rig.link.connected)
    t_away_ns, before = monotonic_ns(), rig.state.sensors["imu"].count
    until(lambda: rig.state.sensors["imu"].count > before + 400)  # the sensors are heard while the server is away
    until(lambda: (pose := rig.state.pose) is not None and pose.t_ns > max(t_away_ns + S, monotonic_ns() - S // 2))
    assert rig.link is not None
    assert not rig.link.connected
    t_back_ns = monotonic_ns()
    with server_process(tmp_path, port):
        until(
            lambda: any(s["estimator"] for s in httpx.get(f"http://127.0.0.1:{port}/api/sessions").json()["sessions"])
        )
        with connect(f"ws://127.0.0.1:{port}/ws/view/walk", compression=None, proxy=None) as viewer:
            hello = json.loads(viewer.recv(5.0))
            messages = [viewer.recv(5.0) for _ in range(40)]
        metas = [decode_frame(m)[0] for m in messages if isinstance(m, bytes) and is_frame(m)]
        session = hello["session"]
        assert (session["kind"], session["estimator"]) == ("live", "camera-gps-imu/precise")
        assert metas
        assert metas[0].t_capture_ns > t_back_ns - S, "nothing old was kept for it"
        assert all(meta.pose_valid for meta in metas)
        rig.close()


class Watcher(threading.Thread):
    """Watches as a page does: comes back for as long as it takes (`web/src/socket.ts`)."""

    def __init__(self, port: int) -> None:
        super().__init__(daemon=True)
        self.connections = 0
        """Those that brought pictures."""
        self._port, self.stop = port, threading.Event()

    def run(self) -> None:
        """Watch until it is told to stop."""
        while not self.stop.is_set():
            with suppress(OSError, WebSocketException):
                self._watch()
            self.stop.wait(0.3)

    def _watch(self) -> None:
        with connect(f"ws://127.0.0.1:{self._port}/ws/view/walk", compression=None, proxy=None) as connection:
            seen = False
            while not self.stop.is_set():
                with suppress(TimeoutError):
                    message = connection.recv(0.1)
                    if isinstance(message, bytes) and is_frame(message):
                        self.connections += not seen
                        seen = True
                        frame_id = decode_frame(message)[0].frame_id
                        connection.send(f'{{"type": "ack", "frame_id": {frame_id}}}')


def test_a_server_killed_in_a_walk_costs_no_sample_of_the_recording_and_rig_and_viewers_come_back(
    log: Log, tmp_path: Path
) -> None:
    """How long that takes is measured by `tests/benchmarks/failover.py`."""
    path = tmp_path / "walk.mcap"
    rig = live_rig(log, path)
    watcher = None
    try:
        with server_process(tmp_path) as (_, port):
            rig.start(f"ws://127.0.0.1:{port}/ws/rig/walk", token("rig", "walk"))
            watcher = Watcher(port)
            watcher.start()
            until(lambda: watcher.connections == 1)
        until(lambda: rig.link is not None and not rig.link.connected)
        with server_process(tmp_path, port):
            until(lambda: watcher.connections == 2)
            state = rig.state
            assert state.recorder is not None
            assert state.recorder.lost == 0
    finally:
        if watcher is not None:
            watcher.stop.set()
            watcher.join()
        rig.close()
    played = [sample.t_ns for sample in log.messages() if isinstance(sample, ImuSample)]
    recorded = [sample.t_ns for sample in Log.open(path).messages() if isinstance(sample, ImuSample)]
    assert len(recorded) > 200
    steps = np.diff(recorded)
    assert steps.min() > 0
    assert steps.max() <= np.diff(played).max() + 60_000_000, "not even where the walk begins anew"


class Tunnel:
    """A network between a rig and its server whose first connection swallows everything after a while."""

    def __init__(self, port: int) -> None:
        self._to = port
        self._listener = socket.create_server(("127.0.0.1", 0))
        self.port: int = self._listener.getsockname()[1]
        self.connections = 0
        self.swallow = threading.Event()
        self._sockets: list[socket.socket] = []
        threading.Thread(target=self._accept, daemon=True).start()

    def _accept(self) -> None:
        with suppress(OSError):
            while True:
                near, _ = self._listener.accept()
                near.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
                far = socket.create_connection(("127.0.0.1", self._to))
                self._sockets += [near, far]
                self.connections += 1
                is_first = self.connections == 1
                for one, other in ((near, far), (far, near)):
                    threading.Thread(target=self._pump, args=(one, other, is_first), daemon=True).start()

    def _pump(self, one: socket.socket, other: socket.socket, is_first: bool) -> None:
        with suppress(OSError):
            while data := one.recv(4096):
                if is_first and self.swallow.is_set():
                    return  # nobody reads any more, and nobody says so
                other.sendall(data)
            other.shutdown(socket.SHUT_WR)

    def close(self) -> None:
        """End it."""
        for one in (self._listener, *self._sockets):
            one.close()


def test_a_network_that_swallows_everything_is_noticed_and_left(
    log: Log, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Nothing is refused and nothing is closed: only that nothing more can be sent tells it."""
    monkeypatch.setattr(push, "_STUCK_S", 1)
    with serving(tmp_path) as server:
        tunnel = Tunnel(server.port)
        rig = live_rig(log)
        rig.start(f"ws://127.0.0.1:{tunnel.port}/ws/rig/walk", token("rig", "walk"))
        until(lambda: rig.link is not None and rig.link.connected and rig.state.pose is not None)
        tunnel.swallow.set()
        deadline = monotonic() + 15.0
        while tunnel.connections < 2 and monotonic() < deadline:
            sleep(0.05)
        assert tunnel.connections >= 2
        until(lambda: rig.link is not None and rig.link.connected)
        rig.close()
        tunnel.close()
