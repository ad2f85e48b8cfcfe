"""What else could bring poses to a thousand viewers: NATS with its own WebSockets, and viser alone.

viser's viewers know a pose's age by where it says that the walker is: its messages carry no time of a measurement. One in twenty of
them looks into its messages, which are compressed; the others count.
"""

import asyncio
import json
import os
import subprocess
import sys
from contextlib import redirect_stdout
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory
from time import monotonic, monotonic_ns, sleep
from typing import Any, Final

from tests.benchmarks.fanout import HZ, Viewer

_SUBJECT: Final = "walk"
_LOOKS_IN: Final = 20
#: viser's coordinates are doubles: seconds to the microsecond for weeks.
_NS: Final = 1_000_000_000


class NatsViewer(Viewer):
    """Speaks NATS's protocol in a WebSocket, and hears one subject."""

    head_bytes = 65_536

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        """Ask for the WebSocket."""
        assert isinstance(transport, asyncio.Transport)
        self.transport = transport
        self.ask("/")

    def opened(self) -> None:
        """Subscribe."""
        self.say(b'CONNECT {"verbose":false}\r\nSUB walk 1\r\n')

    def note(self, head: bytes) -> None:
        """Take note of every pose in what came: there may be several."""
        at = head.find(b"AGP1")
        while at >= 0:
            super().note(head[at : at + 32])
            at = head.find(b"AGP1", at + 32)


class ViserViewer(Viewer):
    """Connects as viser's own page does."""

    head_bytes = 65_536
    _made = 0

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        """Ask for the WebSocket."""
        import viser

        assert isinstance(transport, asyncio.Transport)
        self.transport = transport
        self._looks = ViserViewer._made % _LOOKS_IN == 0
        ViserViewer._made += 1
        self.ask("/", f"Sec-WebSocket-Protocol: viser-v{viser.__version__}\r\n")

    def note(self, head: bytes) -> None:
        """Take note of a window of messages; its newest pose counts."""
        self.messages += 1
        if not self._looks:
            return
        import msgspec
        import zstandard

        size = int.from_bytes(head[8:16], "little")
        window = msgspec.msgpack.decode(zstandard.ZstdDecompressor().decompress(head[16 : 16 + size]))
        places = [
            message["position"]
            for message in window["messages"]
            if message.get("name") == "/walker" and "position" in message
        ]
        if places:
            self.delays_ns.append(monotonic_ns() - int(places[-1][0] * _NS))


VIEWERS: Final[dict[str, type[Viewer]]] = {"nats": NatsViewer, "viser": ViserViewer}


def play(role: str, rest: list[str]) -> None:
    """Be a rival's server, or the rig of NATS."""
    if role == "nats":
        _serve_nats()
    elif role == "viser":
        _serve_viser()
    else:
        asyncio.run(_push_nats(rest[2], float(rest[3])))


def _serve_nats() -> None:
    program = Path(sys.executable).with_name("nats-server")
    with TemporaryDirectory() as folder:
        settings = Path(folder) / "nats.conf"
        settings.write_text(
            'listen: "127.0.0.1:-1"\nwebsocket { listen: "127.0.0.1:-1", no_tls: true }\nmax_connections: 20000\n'
        )
        command = [str(program), "-c", str(settings), "--ports_file_dir", folder]
        with subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as server:
            try:
                ports = Path(folder) / f"nats-server_{server.pid}.ports"
                while not (ports.is_file() and ports.read_text().endswith("}")):
                    sleep(0.02)
                told = json.loads(ports.read_text())
                _say(
                    {
                        "url": told["websocket"][0].replace("ws://", "http://"),
                        "token": told["nats"][0],
                        "pid": server.pid,
                    }
                )
                sys.stdin.read()
            finally:
                server.kill()


async def _push_nats(url: str, seconds: float) -> None:
    import nats

    from server.wire import encode_pose
    from tests.server.wire_examples import example_pose

    rig, pose, began = await nats.connect(url), example_pose(), monotonic()
    for i in range(int(seconds * HZ)):
        await asyncio.sleep(max(0.0, began + i / HZ - monotonic()))
        await rig.publish(_SUBJECT, encode_pose(replace(pose, seq=i, t_ns=monotonic_ns())))


def _serve_viser() -> None:
    import viser

    with redirect_stdout(sys.stderr):  # it says where it is in a box
        server = viser.ViserServer(host="127.0.0.1", port=0, verbose=False)
    walker = server.scene.add_frame("/walker")
    _say({"url": f"http://127.0.0.1:{server.get_port()}/", "token": "", "pid": os.getpid()})
    began, i = monotonic(), 0
    while True:
        sleep(max(0.0, began + i / HZ - monotonic()))
        walker.position = (monotonic_ns() / _NS, 0.0, 0.0)
        i += 1


def _say(answer: dict[str, Any]) -> None:
    sys.stdout.write(json.dumps(answer) + "\n")
    sys.stdout.flush()
