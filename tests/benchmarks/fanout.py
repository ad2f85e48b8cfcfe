"""One rig to many viewers over loopback, each side in a process of its own: what a viewer waits for, and what it is sent.

    python -m tests.benchmarks.fanout

Frames are 1280 x 720 JPEGs at 30 Hz to 40 viewers that acknowledge each, with one more that reads nothing and one that reads at
64 kbit/s; poses go to 1,000 viewers at 30 Hz. The server side is what its own `/metrics` says, the viewers' side is by the one
clock of the machine. Viewers are as thin as Python allows, and still they share the server's cores. The rivals are in
`fanout_rivals.py`; of NATS the rig's and the viewers' connections are its own.
"""

import argparse
import asyncio
import json
import os
import resource
import signal
import subprocess
import sys
from base64 import b64encode
from contextlib import ExitStack
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from time import monotonic, monotonic_ns, sleep
from typing import Any, Final

import httpx
import numpy as np

ROOT: Final = Path(__file__).parents[2]
HZ: Final = 30.0
FRAME_VIEWERS: Final = 40
POSE_VIEWERS: Final = 1000
FRAME_TARGET_S: Final = 0.015
RATE_TARGET_HZ: Final = 29.0
POSE_TARGET_S: Final = 0.100
#: Ours, and those beside it.
SERVERS: Final = {"serve": "Agora", "plain": "FastAPI loop", "nats": "NATS WebSocket", "viser": "viser alone"}
#: Viewers come while the rig pushes already; what is measured begins after them.
_SETTLE_S: Final = 3.0
_SLOW_BYTES: Final = 800
_SLOW_EVERY_S: Final = 0.1
_JPEG_SHAPE: Final = (720, 1280, 3)


@dataclass(frozen=True)
class Figures:
    """Of one run."""

    server_p95_s: float | None
    """From a message's arrival to its leaving for one viewer; None where the server does not say."""
    viewers_p99_s: float
    """From the rig's sending to a viewer's having it, over all messages of all viewers that read."""
    least_hz: float
    """Messages that the worst-off viewer had."""
    cpu_us: float
    """Of the server, for each message that a viewer had, all that the server does beside it included."""


def measure(what: str, seconds: float, server: str = "serve") -> Figures:
    """Run server, rig and viewers; `what` is frames or poses, `server` one of `SERVERS`."""
    with ExitStack() as stack:
        serving = stack.enter_context(_process(server))
        told = json.loads(_line(serving))
        url, token = told["url"], told["token"]
        if server == "nats":  # a program of its own, which would outlive the process that started it
            stack.callback(os.kill, told["pid"], signal.SIGKILL)
        if server != "viser":  # which has no rigs: whoever has it sets the pose in it
            rig = "push-nats" if server == "nats" else "push"
            stack.enter_context(_process(rig, what, url, token, str(seconds + 60.0)))
        while server in ("serve", "plain") and not httpx.get(f"{url}api/sessions", trust_env=False).json()["sessions"]:
            sleep(0.05)
        watching = stack.enter_context(_process("watch", what, url, str(seconds), server))
        _line(watching)  # all are there, and it begins
        cpu_s = _cpu_s(told["pid"])
        before = _page(url) if server == "serve" else ""
        seen = json.loads(_line(watching))
        cpu_s = _cpu_s(told["pid"]) - cpu_s
        after = _page(url) if server == "serve" else ""
    p95_s = _quantile(before, after, f"agora_{what.removesuffix('s')}_fanout_seconds", 0.95) if after else None
    return Figures(p95_s, seen["p99_s"], seen["least_hz"], 1e6 * cpu_s / max(1.0, seen["messages"]))


def _cpu_s(pid: int) -> float:
    """Return the processor time that a process has taken."""
    fields = Path(f"/proc/{pid}/stat").read_text().rpartition(") ")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def _page(url: str) -> str:
    return httpx.get(f"{url}metrics", trust_env=False, timeout=30.0).text


def _quantile(before: str, after: str, family: str, share: float) -> float:
    """Return a quantile of what a histogram has counted between two pages, by a straight line within its class."""
    begun, ended = (
        [line for line in page.splitlines() if line.startswith(f"{family}_bucket")] for page in (before, after)
    )
    bounds = [float(line.split('le="')[1].split('"')[0]) for line in ended]
    counts = [float(b.rsplit(" ", 1)[1]) - float(a.rsplit(" ", 1)[1]) for a, b in zip(begun, ended, strict=True)]
    wanted = share * counts[-1]
    i = next(i for i, count in enumerate(counts) if count >= wanted)
    low, below = (bounds[i - 1], counts[i - 1]) if i else (0.0, 0.0)
    return (
        bounds[i] if np.isinf(bounds[i]) else low + (bounds[i] - low) * (wanted - below) / max(1.0, counts[i] - below)
    )


def _process(role: str, *arguments: str) -> "_Ended":
    return _Ended([sys.executable, "-m", "tests.benchmarks.fanout", "--role", role, *arguments])


class _Ended(subprocess.Popen[str]):
    """A process that its context ends."""

    def __init__(self, command: list[str]) -> None:
        environment = os.environ | {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
        super().__init__(
            command,
            cwd=ROOT,
            env=environment,
            text=True,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
        )

    def __exit__(self, *error: object) -> None:
        self.kill()
        self.communicate()


def _line(process: "subprocess.Popen[str]") -> str:
    assert process.stdout is not None
    return process.stdout.readline()


# -- the server's process ---------------------------------------------------------------------------------------------


def _serve() -> None:
    from server.access import Access
    from server.app import create_app
    from server.limits import Limits
    from server.sessions import Sessions

    access = Access.for_loopback()
    token = access.signer.issue("rig", int(access.signer.now_s()) + 3600, "walk")
    app = create_app(
        web_folder=ROOT,
        models_folder=ROOT,
        site={},
        access=access,
        limits=Limits(requests_per_s=1e6, burst=1e6, connections=10_000),
        sessions=Sessions(monotonic_ns, 16, 10_000),
    )
    _until_killed(app, token)


def _serve_plainly() -> None:
    """FastAPI as its tutorial broadcasts: a list of sockets, and each message sent to one after the other."""
    from fastapi import FastAPI, WebSocket, WebSocketDisconnect

    app, viewers, pushing = FastAPI(), list[WebSocket](), list[str]()

    @app.get("/api/sessions")
    async def sessions() -> dict[str, Any]:
        return {"sessions": pushing}

    @app.websocket("/ws/rig/walk")
    async def rig(websocket: WebSocket) -> None:
        await websocket.accept()
        pushing.append("walk")
        while True:
            message = await websocket.receive_bytes()
            for viewer in viewers:
                await viewer.send_bytes(message)

    @app.websocket("/ws/view/walk")
    async def view(websocket: WebSocket) -> None:
        await websocket.accept()
        viewers.append(websocket)
        try:
            while True:
                await websocket.receive()
        except (WebSocketDisconnect, RuntimeError):
            viewers.remove(websocket)

    _until_killed(app, "")


def _until_killed(app: Any, token: str) -> None:
    from server.web_server import WebServer

    with WebServer(app) as server:
        _say({"url": server.url, "token": token, "pid": os.getpid()})
        sys.stdin.read()


# -- the rig's process ------------------------------------------------------------------------------------------------


def _push(what: str, url: str, token: str, seconds: float) -> None:
    from websockets.sync.client import connect

    from server.wire import encode_frame, encode_pose
    from tests.server.wire_examples import example_frame, example_pose

    jpeg, frame, pose = _jpeg(), example_frame(0), example_pose()
    bearer = {"Authorization": f"Bearer {token}"}
    rig = connect(f"{url.replace('http', 'ws')}ws/rig/walk", additional_headers=bearer, compression=None, proxy=None)
    with rig:
        began = monotonic()
        for i in range(int(seconds * HZ)):
            sleep(max(0.0, began + i / HZ - monotonic()))
            now_ns = monotonic_ns()
            if what == "frames":
                rig.send(encode_frame(replace(frame, frame_id=i, t_capture_ns=now_ns, t_sent_ns=now_ns), jpeg))
            else:
                rig.send(encode_pose(replace(pose, seq=i, t_ns=now_ns)))


def _jpeg() -> bytes:
    """Return a picture of as many bytes as a webcam's of a ruin has: about a tenth of a megabyte."""
    import cv2

    rng = np.random.default_rng(1)
    coarse = cv2.resize(rng.integers(0, 255, (90, 160, 3), np.uint8), (1280, 720), interpolation=cv2.INTER_CUBIC)
    picture = np.clip(coarse.astype(np.int16) + rng.normal(0.0, 4.0, _JPEG_SHAPE).astype(np.int16), 0, 255)
    return bytes(cv2.imencode(".jpg", picture.astype(np.uint8), [cv2.IMWRITE_JPEG_QUALITY, 70])[1].tobytes())


# -- the viewers' process ---------------------------------------------------------------------------------------------


class Viewer(asyncio.BufferedProtocol):
    """Reads a WebSocket's frames and no more of them than their beginnings; acknowledges pictures."""

    head_bytes = 32
    """So much of a message is looked at."""

    def __init__(self, port: int, slow: bool) -> None:
        self._port, self._slow = port, slow
        self._room = bytearray(_SLOW_BYTES if slow else 1 << 18)
        self._waiting = bytearray()
        self._open = False
        self.delays_ns: list[int] = []
        self.messages = 0

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        assert isinstance(transport, asyncio.Transport)
        self.transport = transport
        self.ask("/ws/view/walk")

    def ask(self, path: str, more: str = "") -> None:
        """Ask for a WebSocket; `more` is header lines."""
        key = b64encode(os.urandom(16)).decode()
        self.transport.write(
            f"GET {path} HTTP/1.1\r\nHost: 127.0.0.1:{self._port}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n{more}"
            f"Sec-WebSocket-Key: {key}\r\nSec-WebSocket-Version: 13\r\n\r\n".encode()
        )

    def opened(self) -> None:
        """Say what is to be said first."""

    def say(self, data: bytes) -> None:
        """Send a short text message."""
        self.transport.write(bytes((0x81, 0x80 | len(data), 0, 0, 0, 0)) + data)  # masked with zeros

    def get_buffer(self, sizehint: int) -> bytearray:
        return self._room

    def buffer_updated(self, nbytes: int) -> None:
        self._waiting += memoryview(self._room)[:nbytes]
        if self._slow:
            self.transport.pause_reading()
            asyncio.get_running_loop().call_later(_SLOW_EVERY_S, self.transport.resume_reading)
        if not self._open:
            end = self._waiting.find(b"\r\n\r\n")
            if end < 0:
                return
            assert self._waiting.startswith(b"HTTP/1.1 101"), bytes(self._waiting[:200])
            self._open = True
            del self._waiting[: end + 4]
            self.opened()
        while self._take():
            pass

    def _take(self) -> bool:
        """Take one message, if all of it is there."""
        data = self._waiting
        if len(data) < 10:
            return False
        length, begin = data[1], 2
        if length == 126:
            length, begin = int.from_bytes(data[2:4], "big"), 4
        elif length == 127:
            length, begin = int.from_bytes(data[2:10], "big"), 10
        if len(data) < begin + length:
            return False
        if data[0] & 15 == 2:
            self.note(bytes(data[begin : begin + min(length, self.head_bytes)]))
        del data[: begin + length]
        return True

    def note(self, head: bytes) -> None:
        """Take note of a message's coming."""
        is_frame = head.startswith(b"AGF1")
        sent_ns = int.from_bytes(head[24:32] if is_frame else head[16:24], "little")
        self.delays_ns.append(monotonic_ns() - sent_ns)
        self.messages += 1
        if is_frame:
            self.say(b'{"type":"ack","frame_id":%d}' % int.from_bytes(head[8:12], "little"))


async def _watch(what: str, url: str, seconds: float, server: str) -> dict[str, float]:
    from tests.benchmarks.fanout_rivals import VIEWERS

    kind = VIEWERS.get(server, Viewer)
    loop, port = asyncio.get_running_loop(), int(url.rstrip("/").rpartition(":")[2])

    async def viewer(*, slow: bool = False) -> Viewer:
        made = await loop.create_connection(lambda: kind(port, slow), "127.0.0.1", port)
        return made[1]

    watching = [await viewer() for _ in range(FRAME_VIEWERS if what == "frames" else POSE_VIEWERS)]
    if what == "frames":
        await viewer(slow=True)
        (await viewer()).transport.pause_reading()
    await asyncio.sleep(_SETTLE_S)
    for one in watching:
        one.delays_ns.clear()
        one.messages = 0
    _say({"viewers": len(watching)})
    began = monotonic()
    await asyncio.sleep(seconds)
    took_s = monotonic() - began
    delays = np.concatenate([np.array(one.delays_ns, dtype=np.int64) for one in watching])
    least = min(one.messages for one in watching)
    return {
        "p99_s": float(np.percentile(delays, 99.0)) * 1e-9 if len(delays) else 1e9,
        "least_hz": least / took_s,
        "messages": float(sum(one.messages for one in watching)),
    }


def rows_of(frames: Figures, poses: Figures, rivals: dict[str, Figures]) -> list[tuple[str, float, str, str, float]]:
    """Return name, value, unit, what it is beside, and the ratio to that, of each row of `make bench`."""
    cores = f"{os.cpu_count()} cores"
    to_40, to_1000 = f"{FRAME_VIEWERS} viewers of 720p, {cores}", f"{POSE_VIEWERS} viewers of poses, {cores}"
    p95_s, p99_ms = frames.server_p95_s or 0.0, poses.viewers_p99_s * 1e3
    beside = f"target {RATE_TARGET_HZ:g}"
    rows = [
        (f"{to_40}: server side, p95", p95_s * 1e3, "ms", f"target {FRAME_TARGET_S * 1e3:g}", p95_s / FRAME_TARGET_S),
        (f"{to_40}: slowest reader", frames.least_hz, "Hz, more is better", beside, frames.least_hz / RATE_TARGET_HZ),
        (
            f"{to_1000}: rig to viewer, p99",
            p99_ms,
            "ms",
            f"target {POSE_TARGET_S * 1e3:g}",
            p99_ms * 1e-3 / POSE_TARGET_S,
        ),
        (f"{to_1000}: slowest reader", poses.least_hz, "Hz, more is better", beside, poses.least_hz / RATE_TARGET_HZ),
    ]
    for server, rival in rivals.items():
        name, rival_ms = SERVERS[server], rival.viewers_p99_s * 1e3
        theirs = f"{name}: {rival_ms:.0f} at {rival.least_hz:.1f} Hz"
        rows += [
            (f"{to_1000}: rig to viewer, p99", p99_ms, "ms", theirs, p99_ms / rival_ms),
            (
                f"{to_1000}: processor",
                poses.cpu_us,
                "us a pose",
                f"{name}: {rival.cpu_us:.1f}",
                poses.cpu_us / rival.cpu_us,
            ),
        ]
    return rows


def _say(answer: dict[str, Any]) -> None:
    sys.stdout.write(json.dumps(answer) + "\n")
    sys.stdout.flush()


def main() -> None:
    """Play a part, or measure all and print it."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--role", choices=(*SERVERS, "push", "push-nats", "watch"), help=argparse.SUPPRESS)
    parser.add_argument("--seconds", type=float, default=10.0)
    parser.add_argument("rest", nargs="*", help=argparse.SUPPRESS)
    options = parser.parse_args()
    hard = resource.getrlimit(resource.RLIMIT_NOFILE)[1]
    resource.setrlimit(resource.RLIMIT_NOFILE, (hard, hard))
    if options.role == "serve":
        _serve()
    elif options.role == "plain":
        _serve_plainly()
    elif options.role == "push":
        what, url, token, seconds = options.rest
        _push(what, url, token, float(seconds))
    elif options.role in ("nats", "viser", "push-nats"):
        from tests.benchmarks import fanout_rivals

        fanout_rivals.play(options.role, options.rest)
    elif options.role == "watch":
        what, url, seconds, server = options.rest
        _say(asyncio.run(_watch(what, url, float(seconds), server)))
    else:
        for what, server in (("frames", "serve"), *(("poses", server) for server in SERVERS)):
            figures = measure(what, options.seconds, server)
            _say({"what": what, "server": SERVERS[server], "cores": os.cpu_count(), **asdict(figures)})


if __name__ == "__main__":
    main()
