"""`agora serve`: many rigs and many viewers on one server, and a stop that tells them why."""

import json
import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path
from time import monotonic_ns

import httpx
import pytest
from websockets.exceptions import ConnectionClosed

from server.sessions import ENDED, RESTART, Sessions
from server.wire import encode_frame
from tests.server.serving import HELD_S, bytes_of, rig, serving, text_of, until, viewer
from tests.server.wire_examples import TINY_JPEG, example_frame

AGORA = str(Path(sys.executable).with_name("agora"))


def frame(frame_id: int) -> bytes:
    return encode_frame(example_frame(frame_id), TINY_JPEG)


def test_each_session_has_its_own_rig_and_its_own_viewers(tmp_path: Path) -> None:
    with ExitStack() as stack:
        server = stack.enter_context(serving(tmp_path))
        a, b = (stack.enter_context(rig(server, name)) for name in "ab")
        of_a, too, of_b = (stack.enter_context(viewer(server, name)) for name in "aab")
        a.send(frame(1))
        b.send(frame(2))
        assert (bytes_of(of_a), bytes_of(too), bytes_of(of_b)) == (frame(1), frame(1), frame(2))


def test_a_server_takes_as_many_sessions_and_viewers_as_it_was_told(tmp_path: Path) -> None:
    with ExitStack() as stack:
        server = stack.enter_context(serving(tmp_path, sessions=Sessions(monotonic_ns, 1, 1)))
        first = stack.enter_context(rig(server, "a"))
        watching = stack.enter_context(viewer(server, "a"))
        assert text_of(watching, "hello")
        late = stack.enter_context(viewer(server, "a"))
        with pytest.raises(ConnectionClosed):
            late.recv(HELD_S)
        assert (late.close_code, (late.close_reason or "")[:9]) == (1013, "1 viewers")
        first.close()
        assert text_of(watching, "state")["session"]["connected"] is False
        stack.enter_context(rig(server, "b"))
        assert "has ended" in text_of(watching, "state")["session"]["notice"]
        with pytest.raises(ConnectionClosed):
            watching.recv(HELD_S)
        assert watching.close_code == ENDED


def test_a_server_that_stops_tells_viewers_and_rigs_why(tmp_path: Path) -> None:
    with serving(tmp_path) as server, rig(server) as pushing, viewer(server) as watching:
        assert text_of(watching, "hello")
        server.close()
        assert "being stopped" in text_of(watching, "state")["session"]["notice"]
        for connection in (pushing, watching):
            with pytest.raises(ConnectionClosed):
                connection.recv(HELD_S)
            assert connection.close_code == RESTART
            assert "being stopped" in (connection.close_reason or "")


@pytest.fixture
def served(tmp_path: Path) -> Iterator["subprocess.Popen[str]"]:
    (tmp_path / "web").mkdir()
    (tmp_path / "web" / "index.html").write_text("<title>index</title>")
    environment = os.environ | {
        "AGORA_PORT": "0",
        "AGORA_DATA": str(tmp_path / "data"),
        "AGORA_WEB": str(tmp_path / "web"),
    }
    command = [AGORA, "serve", "--log-format", "json"]
    process = subprocess.Popen(command, env=environment, text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    yield process
    process.kill()
    process.communicate()


def test_serve_answers_and_ends_by_sigterm_with_its_journal_in_json(served: "subprocess.Popen[str]") -> None:
    assert served.stdout is not None
    assert served.stderr is not None
    line = served.stdout.readline()
    assert line.startswith("Agora is at http://127.0.0.1:")
    url = line.split()[-1]
    code = served.stdout.readline().split("code=")[-1].strip()
    with httpx.Client(base_url=url, trust_env=False) as browser:
        until(lambda: browser.get("/api/sessions").status_code == 401)
        entered = browser.get("/enter", params={"code": code})
        assert (entered.status_code, entered.headers["location"]) == (303, "/")
        assert browser.get("/api/sessions").json() == {"sessions": []}
    served.send_signal(signal.SIGTERM)
    assert served.wait(20) == 0
    journal = served.stderr.read()
    assert code not in journal
    events = [json.loads(line) for line in journal.splitlines()]
    assert [event["event"] for event in events] == ["serving", "stopping", "stopped"], events
    assert events[0]["url"] == url


def test_serve_prints_its_configuration(tmp_path: Path) -> None:
    file = tmp_path / "server.toml"
    file.write_text('names = ["agora.example"]\n')
    command = [AGORA, "serve", "--config", str(file), "--port", "9000", "--print-config"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=60, check=True)
    assert 'names = ["agora.example"]' in done.stdout
    assert "port = 9000" in done.stdout
    file.write_text(done.stdout)
    assert subprocess.run(command, capture_output=True, text=True, timeout=60, check=True).stdout == done.stdout
    file.write_text("port = -1")
    failed = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)
    assert failed.returncode == 2
    assert failed.stderr.startswith("agora: ")
