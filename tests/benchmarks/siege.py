"""A server under abuse: whoever misbehaves is refused with the right status, and everybody else notices nothing.

    python -m tests.benchmarks.siege

`agora serve` in a process of its own, a rig that pushes pictures at 30 Hz, a viewer, and a visitor who asks for a page five times a
second from another address. Beside them one abuse after the other, from an address of its own: 10,000 connections, heads that never
end, an upload of 10 GB, a walk whose chunk inflates to 50 GB. Told is how long the viewer waited for a picture at worst.
"""

import argparse
import asyncio
import json
import os
import socket
import subprocess
import sys
import tempfile
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from threading import Event, Thread
from time import monotonic, monotonic_ns
from typing import Any, Final
from urllib.parse import urlsplit

import numpy as np
from websockets.sync.client import connect

from server.messages import Ack, ControlReply, encode
from server.push import RigLink
from server.wire import decode_frame, encode_frame, is_frame
from tests.server.uploads import bomb, with_chunk
from tests.server.wire_examples import example_frame
from tracker.pictures import encode_jpeg

ROOT: Final = Path(__file__).parents[2]
HZ: Final = 30.0
CONNECTIONS: Final = 10_000
SLOW: Final = 200
HEAD_S: Final = 3.0
UPLOAD_BYTES: Final = 10 * 10**9
BOMB_BYTES: Final = 50 * 10**9
MOST_MB: Final = 50
_QUIET_S: Final = 3.0
#: In this order, because ten thousand connections leave their address nothing for a while.
_KINDS: Final = ("quiet", "slow", "upload", "bomb", "connect")
#: Attackers, and a visitor who has nothing to do with them: all of 127/8 is this machine.
_ATTACKER, _VISITOR = "127.0.0.66", "127.0.0.77"
_SHAPE: Final = (720, 1280, 3)
_PATIENCE_S: Final = 60.0


@dataclass(frozen=True)
class Figures:
    """Of one abuse."""

    what: str
    """With what became of it."""
    took_s: float
    gap_ms: float
    """The viewer's longest wait for a picture meanwhile."""
    page_ms: float
    """The visitor's longest wait for a page."""


class _Watching:
    """The viewer and the visitor, each on a thread."""

    def __init__(self, url: str, token: str) -> None:
        self._url, self._token, self._stop = url, token, Event()
        self._t_frame_s, self._gap_s, self._page_s = monotonic(), 0.0, 0.0
        self._threads = [Thread(target=work, daemon=True) for work in (self._watch, self._visit)]
        self.failed: list[BaseException] = []

    def __enter__(self) -> "_Watching":
        for thread in self._threads:
            thread.start()
        return self

    def __exit__(self, *error: object) -> None:
        self._stop.set()
        for thread in self._threads:
            thread.join(5.0)

    def begin(self) -> None:
        """Forget what was waited so far."""
        self._gap_s = self._page_s = 0.0
        self._t_frame_s = monotonic()

    def longest_ms(self) -> tuple[float, float]:
        """Return the longest waits since then, for a picture and for a page."""
        if self.failed:
            raise self.failed[0]
        return 1e3 * max(self._gap_s, monotonic() - self._t_frame_s), 1e3 * self._page_s

    def _watch(self) -> None:
        url = f"{self._url.replace('http', 'ws', 1)}ws/view/walk"
        headers = {"Authorization": f"Bearer {self._token}"}
        try:
            with connect(url, additional_headers=headers, compression=None, proxy=None) as viewer:
                for message in viewer:
                    if isinstance(message, bytes) and is_frame(message):
                        now_s = monotonic()
                        self._gap_s, self._t_frame_s = max(self._gap_s, now_s - self._t_frame_s), now_s
                        viewer.send(encode(Ack(decode_frame(message)[0].frame_id)))
                    if self._stop.is_set():
                        return
        except Exception as exc:
            self.failed.append(exc)

    def _visit(self) -> None:
        try:
            while not self._stop.wait(0.2):
                began_s = monotonic()
                status = _status(_asked(self._url, _VISITOR, _get(self._url)))
                self._page_s = max(self._page_s, monotonic() - began_s)
                if status != "200":
                    raise RuntimeError(f"a visitor from elsewhere got {status}")
        except Exception as exc:
            self.failed.append(exc)


def measure() -> list[Figures]:
    """Run all of it."""
    with tempfile.TemporaryDirectory() as raw, _server(Path(raw)) as url:
        token = _token(Path(raw))
        with RigLink(f"{url.replace('http', 'ws', 1)}ws/rig/walk", token, _refuse) as link, _pushing(link):
            _until_walking(link)
            with _Watching(url, token) as watching:
                return [_one(watching, url, Path(raw), kind) for kind in _KINDS]


def rows_of(found: list[Figures]) -> list[tuple[str, float, str, str, float]]:
    """Return name, value, unit, what it is beside, and the ratio to that, of each row of `make bench`."""
    quiet, *abuses = found
    cores = f"{os.cpu_count()} cores"
    return [
        (f"{one.what}, {cores}: others' longest wait for a picture", one.gap_ms, "ms", f"undisturbed {quiet.gap_ms:.0f}",
         one.gap_ms / quiet.gap_ms) for one in abuses
    ]  # fmt: skip


def _one(watching: _Watching, url: str, folder: Path, kind: str) -> Figures:
    watching.begin()
    began_s = monotonic()
    command = [sys.executable, "-m", "tests.benchmarks.siege", "--attack", kind, url, str(folder)]
    environment = os.environ | {"SIEGE_TOKEN": _token(folder, "operator")}
    what = subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, text=True, check=True).stdout.strip()
    gap_ms, page_ms = watching.longest_ms()
    return Figures(what, monotonic() - began_s, gap_ms, page_ms)


@contextmanager
def _server(folder: Path) -> Iterator[str]:
    (folder / "server.toml").touch()
    settings = {"CONFIG": str(folder / "server.toml"), "DATA": str(folder), "PROXIES": "", "MAX_HEAD_S": str(HEAD_S),
                "MAX_UPLOAD_MB": str(MOST_MB)}  # fmt: skip
    environment = os.environ | {f"AGORA_{name}": value for name, value in settings.items()} | {"OMP_NUM_THREADS": "1"}
    command = [str(Path(sys.executable).with_name("agora")), "serve", "--port", "0"]
    with subprocess.Popen(
        command, env=environment, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True
    ) as serving:
        try:
            assert serving.stdout is not None
            yield serving.stdout.readline().split()[-1]
        finally:
            serving.kill()


def _token(folder: Path, role: str = "rig") -> str:
    from server.secret_file import secret_of
    from server.tokens import Signer

    signer = Signer(secret_of(folder))
    return signer.issue(role, int(signer.now_s()) + 3600, "walk" if role == "rig" else None)  # type: ignore[arg-type]


@contextmanager
def _pushing(link: RigLink) -> Iterator[None]:
    jpeg = encode_jpeg(np.random.default_rng(1).integers(0, 255, _SHAPE, np.uint8) // 4 * 2)
    stop = Event()

    def push() -> None:
        frame_id = 0
        while not stop.wait(1.0 / HZ):
            frame = replace(example_frame(frame_id), t_sent_ns=monotonic_ns())
            link.send_frame(encode_frame(frame, jpeg))
            frame_id += 1

    thread = Thread(target=push, daemon=True)
    thread.start()
    try:
        yield
    finally:
        stop.set()
        thread.join()


def _until_walking(link: RigLink) -> None:
    deadline_s = monotonic() + _PATIENCE_S
    while not link.connected:
        if monotonic() > deadline_s:
            raise TimeoutError("the rig did not reach the server")
        Event().wait(0.05)


def _refuse(request: Any) -> ControlReply:
    return ControlReply(request.request_id, ok=False)


# -- the attackers, in a process of their own -------------------------------------------------------------------------


def _attack(kind: str, url: str, folder: Path) -> str:
    """Do one abuse and return what became of it, in words."""
    match kind:
        case "connect":
            began_s = monotonic()
            counts = asyncio.run(_connections(url))
            return f"{CONNECTIONS:,} connections in {monotonic() - began_s:.0f} s, {counts['429']:,} got 429"
        case "slow":
            began_s = monotonic()
            counts = asyncio.run(_slow_heads(url))
            return f"{SLOW} slow heads, {counts['408']} got 408 within {monotonic() - began_s:.1f} s"
        case "upload":
            declared = _status(_asked(url, _ATTACKER, _put(url, f"Content-Length: {UPLOAD_BYTES}")))
            status, sent = _endless(url)
            return f"10 GB declared got {declared}, undeclared {status} after {sent / 1e6:.0f} MB"
        case "bomb":
            path = with_chunk(folder / "bomb.mcap", bomb(BOMB_BYTES), BOMB_BYTES)
            data = path.read_bytes()
            began_s = monotonic()
            answer = _asked(url, _ATTACKER, _put(url, f"Content-Length: {len(data)}") + data)
            return f"chunk of 50 GB got {_status(answer)} in {monotonic() - began_s:.1f} s"
    Event().wait(_QUIET_S)
    return "quiet"


async def _connections(url: str) -> Counter[str]:
    counts, places = Counter[str](), asyncio.Semaphore(100)
    head = _get(url)

    async def one() -> None:
        async with places:
            counts[await _answer(url, head)] += 1

    await asyncio.gather(*(one() for _ in range(CONNECTIONS)))
    return counts


async def _slow_heads(url: str) -> Counter[str]:
    return Counter(await asyncio.gather(*(_answer(url, _get(url)[:20]) for _ in range(SLOW))))


async def _answer(url: str, data: bytes) -> str:
    """Connect, send and return the status of the answer; "none" where the connection ends without one."""
    parts = urlsplit(url)
    try:
        reader, writer = await asyncio.open_connection(parts.hostname, parts.port, local_addr=(_ATTACKER, 0))
        try:
            writer.write(data)
            return _status(await asyncio.wait_for(reader.read(200), _PATIENCE_S))
        finally:
            writer.close()
    except OSError:
        return "none"


def _endless(url: str) -> tuple[str, int]:
    """Send a body that says nothing of its size until the server answers; return the status and the bytes that went."""
    piece = b"10000\r\n" + b"\x89MCAP0\r\n".ljust(65_536, b"\0") + b"\r\n"
    sent = 0
    with _connected(url, _ATTACKER) as peer:
        peer.sendall(_put(url, "Transfer-Encoding: chunked"))
        while sent < UPLOAD_BYTES:
            try:
                peer.sendall(piece)
            except OSError:
                break  # refused, and cut off
            sent += 65_536
            peer.setblocking(False)
            try:
                if answer := peer.recv(200):
                    return _status(answer), sent
            except BlockingIOError:
                pass
            finally:
                peer.settimeout(_PATIENCE_S)
        try:
            return _status(peer.recv(200)), sent
        except OSError:
            return "none", sent


def _asked(url: str, address: str, data: bytes) -> bytes:
    with _connected(url, address) as peer:
        peer.sendall(data)
        return peer.recv(200)


def _connected(url: str, address: str) -> socket.socket:
    parts = urlsplit(url)
    return socket.create_connection(
        (str(parts.hostname), int(parts.port or 0)), _PATIENCE_S, source_address=(address, 0)
    )


def _get(url: str) -> bytes:
    return f"GET /api/version HTTP/1.1\r\nHost: {urlsplit(url).netloc}\r\nConnection: close\r\n\r\n".encode()


def _put(url: str, header: str) -> bytes:
    token = os.environ["SIEGE_TOKEN"]
    return (
        f"PUT /api/logs/a HTTP/1.1\r\nHost: {urlsplit(url).netloc}\r\nAuthorization: Bearer {token}\r\n{header}\r\n\r\n"
    ).encode()


def _status(answer: bytes) -> str:
    return answer[9:12].decode() if answer.startswith(b"HTTP/1.1 ") else "none"


def main() -> None:
    """Do one abuse, or measure all and print it."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--attack", nargs=3, metavar=("KIND", "URL", "FOLDER"), help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.attack:
        kind, url, folder = options.attack
        lines = [_attack(kind, url, Path(folder))]
    else:
        lines = [json.dumps(one.__dict__) for one in measure()]
    sys.stdout.write("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
