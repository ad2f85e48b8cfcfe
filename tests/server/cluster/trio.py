"""Three servers on a cluster of three nodes of NATS behind a proxy, rigs that push poses there, and viewers that watch them."""

import json
import os
import subprocess
import sys
import threading
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import dataclass, field, replace
from itertools import pairwise
from pathlib import Path
from time import monotonic, sleep
from types import TracebackType
from typing import Any, Self

import httpx
from websockets.exceptions import WebSocketException
from websockets.sync.client import connect

from server.access import Access
from server.messages import ControlReply, ControlRequest
from server.push import RigLink
from server.tokens import Issued
from server.wire import POSE_BYTES, decode_pose, encode_pose
from tests.server.cluster.certificates import make_certificates
from tests.server.cluster.nodes import Node, nodes
from tests.server.cluster.proxy import proxy
from tests.server.wire_examples import example_pose

AGORA = str(Path(sys.executable).with_name("agora"))
HZ = 30.0
#: Poses of one session bear numbers from here on, of the next from twice that.
MARK = 1_000_000
_SECRET = bytes(32)
_PASSWORD = "between-servers"


class Served:
    """One `agora serve`."""

    def __init__(self, process: "subprocess.Popen[str]", journal: Path) -> None:
        self.process, self.journal = process, journal
        assert process.stdout is not None
        line = process.stdout.readline()
        assert line.startswith("Agora is at http://"), journal.read_text()
        self.url = line.split()[-1]

    @property
    def port(self) -> int:
        """Where it listens."""
        return int(self.url.rstrip("/").rpartition(":")[2])

    @property
    def node_port(self) -> int:
        """The node of NATS that it joined last."""
        events = [json.loads(line) for line in self.journal.read_text().splitlines()]
        joined = [event["server"] for event in events if event["event"] == "joined the bus"]
        return int(joined[-1].rpartition(":")[2])

    def get(self, path: str) -> httpx.Response:
        """Ask as an operator."""
        return httpx.get(f"{self.url}{path}", headers=_bearer("operator"), trust_env=False, timeout=10.0)

    def sessions(self) -> dict[str, Any]:
        """Return what it says of every session."""
        return {session["name"]: session for session in self.get("api/sessions").json()["sessions"]}

    def kill(self) -> None:
        """End it without a word."""
        self.process.kill()
        self.process.wait(10.0)


@dataclass
class Trio:
    """All of it."""

    nodes: list[Node]
    servers: list[Served]
    proxy_port: int
    """Of HAProxy before them."""


@contextmanager
def trio(folder: Path) -> Iterator[Trio]:
    """Run it: TLS and a password to NATS, every server ready and knowing of the others."""
    certificates = make_certificates(folder)
    (folder / "password").write_text(_PASSWORD)
    (folder / "web").mkdir()
    for page in ("index.html", "ar.html"):
        (folder / "web" / page).write_text("<title>agora</title>")
    with ExitStack() as stack:
        running = stack.enter_context(nodes(folder, 3, secured=certificates, password=_PASSWORD))
        settings = {
            "AGORA_BUS": ",".join(f"tls://127.0.0.1:{node.port}" for node in running),
            "AGORA_BUS_USER": "agora",
            "AGORA_BUS_PASSWORD_FILE": str(folder / "password"),
            "AGORA_BUS_CA": str(certificates.ca),
            "AGORA_BUS_REPLICAS": "3",
            "AGORA_WEB": str(folder / "web"),
            "AGORA_PORT": "0",
            "AGORA_LOG_FORMAT": "json",
        }
        started = [stack.enter_context(serve(folder / f"server-{i}", settings)) for i in range(3)]
        servers = [Served(process, journal) for process, journal in started]
        for server in servers:
            wait(lambda server=server: server.get("ready").status_code == 200)
        yield Trio(running, servers, stack.enter_context(proxy(folder, [server.port for server in servers])))


@contextmanager
def serve(folder: Path, settings: dict[str, str]) -> Iterator[tuple["subprocess.Popen[str]", Path]]:
    """Run `agora serve`, which keeps its data in a folder that may be there already."""
    folder.mkdir(mode=0o700, exist_ok=True)
    secret = folder / "secret"
    secret.write_bytes(_SECRET)
    secret.chmod(0o600)
    journal = folder / "journal"
    with journal.open("w") as log:
        process = subprocess.Popen(
            [AGORA, "serve"],
            env=os.environ | settings | {"AGORA_DATA": str(folder)},
            text=True,
            stdout=subprocess.PIPE,
            stderr=log,
        )
    try:
        yield process, journal
    finally:
        process.kill()
        process.communicate()


def _bearer(role: Issued, session: str | None = None) -> dict[str, str]:
    return {"Authorization": f"Bearer {_token(role, session)}"}


def _token(role: Issued, session: str | None = None) -> str:
    signer = Access.with_secret(_SECRET).signer
    return signer.issue(role, int(signer.now_s()) + 3600, session)


class Rig:
    """Pushes poses, numbered from a mark on, and its state."""

    def __init__(self, port: int, session: str, mark: int) -> None:
        self._stop = threading.Event()
        self.asked: list[ControlRequest] = []
        self.sent: dict[int, float] = {}
        """When each pose was handed to the link, seconds."""
        self._link = RigLink(f"ws://127.0.0.1:{port}/ws/rig/{session}", _token("rig", session), self._answer)
        self._link.send_state({"estimator": "precise", "notice": session, "duration_s": float(mark)})
        self._mark = mark
        self._thread = threading.Thread(target=self._push, daemon=True)
        self._thread.start()

    def _answer(self, request: ControlRequest) -> ControlReply:
        self.asked.append(request)
        return ControlReply(request.request_id, ok=True)

    def _push(self) -> None:
        number, pose = self._mark, example_pose()
        while not self._stop.wait(1.0 / HZ):
            self.sent[number] = monotonic()
            self._link.send_pose(encode_pose(replace(pose, seq=number)))
            number += 1

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._stop.set()
        self._thread.join()
        self._link.close()


@dataclass
class Watcher:
    """Watches a session: at one server first, and where that one goes away, at those that the proxy finds."""

    port: int
    then: int
    session: str
    came: list[tuple[float, int]] = field(default_factory=list)
    """When poses came, seconds, and their numbers."""
    told: list[dict[str, Any]] = field(default_factory=list)
    """What it was told of the session."""
    answers: list[dict[str, Any]] = field(default_factory=list)

    def __enter__(self) -> Self:
        self._stop = threading.Event()
        self._ask = threading.Event()
        self._thread = threading.Thread(target=self._watch, daemon=True)
        self._thread.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._stop.set()
        self._thread.join()

    def newest_s(self) -> float:
        """When the newest pose came; minus infinity before there was one."""
        return self.came[-1][0] if self.came else float("-inf")

    def longest_gap_s(self, since_s: float) -> float:
        """Return the longest time without a pose since a moment."""
        times = [since_s, *(t_s for t_s, _ in self.came if t_s > since_s)]
        return max(b - a for a, b in pairwise(times))

    def ask(self) -> None:
        """Have the rig asked for something."""
        self._ask.set()

    def _watch(self) -> None:
        port = self.port
        while not self._stop.is_set():
            with suppress(OSError, WebSocketException):
                self._read(port)
            port = self.then
            self._stop.wait(0.1)

    def _read(self, port: int) -> None:
        url = f"ws://127.0.0.1:{port}/ws/view/{self.session}"
        with connect(url, additional_headers=_bearer("operator"), compression=None, proxy=None) as socket:
            while not self._stop.is_set():
                if self._ask.is_set():
                    self._ask.clear()
                    socket.send('{"type": "control", "request_id": "q", "action": "seek", "value": 3.0}')
                with suppress(TimeoutError):
                    self._take(socket.recv(0.1))

    def _take(self, message: str | bytes) -> None:
        if isinstance(message, bytes):
            if len(message) == POSE_BYTES:
                self.came.append((monotonic(), decode_pose(message).seq))
            return
        parsed = json.loads(message)
        if parsed["type"] == "reply":
            self.answers.append(parsed)
        elif "session" in parsed:
            self.told.append(parsed["session"])


def wait(condition: Any, held_s: float = 60.0) -> None:
    """Wait for a condition; fail after a while."""
    deadline = monotonic() + held_s
    while not condition():
        assert monotonic() < deadline, "waited in vain"
        sleep(0.02)
