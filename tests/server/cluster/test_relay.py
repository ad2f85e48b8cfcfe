"""Three servers as one, over the bus inside a process and over NATS: what each knows, what each hears, and who has the word."""

import asyncio
import json
from collections.abc import Awaitable, Callable, Iterator
from secrets import token_hex
from time import monotonic, monotonic_ns
from typing import Any

import pytest

from server.cluster.bus import Bus, Hub, LocalBus
from server.cluster.nats_bus import NatsBus
from server.cluster.nats_settings import NatsSettings
from server.cluster.relay import Relay
from server.fanout import Mailbox
from server.grants import Role
from server.messages import ControlRequest
from server.privacy import without_picture
from server.session import REPLACED, Session
from server.sessions import ENDED, Sessions
from server.wire import decode_frame, encode_frame, encode_pose, is_frame
from tests.server.cluster.nodes import nodes
from tests.server.lines import Wire
from tests.server.wire_examples import TINY_JPEG, example_frame, example_pose

_HELD_S = 15.0
POSE = encode_pose(example_pose())

MakeBuses = Callable[[int], list[Bus]]
Play = Callable[["Callable[[list[Server]], Awaitable[None]]"], None]


def frame(frame_id: int) -> bytes:
    return encode_frame(example_frame(frame_id), TINY_JPEG)


def _acknowledge(viewer: Mailbox, message: str | bytes) -> None:
    if isinstance(message, bytes) and is_frame(message):
        asyncio.get_running_loop().call_soon(viewer.acknowledge, decode_frame(message)[0].frame_id)


class Server:
    """One of them, without its web."""

    def __init__(self, name: str, bus: Bus) -> None:
        self.sessions = Sessions(monotonic_ns)
        self.late_s = 0.0
        """How far its clock is ahead."""
        self.relay = Relay(self.sessions, bus, name, now_s=lambda: monotonic() + self.late_s)
        self.task = asyncio.create_task(self.relay.run())

    def rig(self, session: str, **state: Any) -> tuple[Mailbox, Wire, Session]:
        """Connect a rig, which tells its state."""
        rig, wire = Mailbox(), Wire()
        rig.open(wire)
        opened = self.sessions.open(session)
        opened.attach_rig(rig)
        opened.take_text(json.dumps({"type": "state", "session": {"estimator": "precise", **state}}))
        return rig, wire, opened

    def viewer(self, session: str, role: Role = "viewer") -> tuple[Mailbox, Wire]:
        """Let somebody watch."""
        viewer, wire = Mailbox(), Wire()
        wire.took = lambda message: _acknowledge(viewer, message)
        viewer.role = role
        self.sessions.get(session).join(viewer)
        viewer.open(wire)
        return viewer, wire

    def has_rig(self, session: str) -> bool:
        """Whether this server knows that the session's rig is connected."""
        return bool(self.told(session).get("connected"))

    def told(self, session: str) -> dict[str, Any]:
        """Return what this server says of a session; nothing where it knows none."""
        return self.sessions.get(session).describe() if session in self.sessions else {}


@pytest.fixture(scope="module")
def node_url(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    with nodes(tmp_path_factory.mktemp("nats")) as (node,):
        yield f"nats://127.0.0.1:{node.port}"


@pytest.fixture(params=["local", "nats"])
def play(request: pytest.FixtureRequest) -> Play:
    """Return what runs a scene with three servers that know each other."""

    def run(scene: Callable[[list[Server]], Awaitable[None]]) -> None:
        if request.param == "local":
            hub = Hub()
            asyncio.run(_with_servers([LocalBus(hub) for _ in range(3)], scene))
        else:
            settings = NatsSettings(urls=[request.getfixturevalue("node_url")])
            asyncio.run(_with_servers([NatsBus(settings) for _ in range(3)], scene))

    return run


async def _with_servers(buses: list[Bus], scene: Callable[[list[Server]], Awaitable[None]]) -> None:
    servers = [Server(token_hex(4), bus) for bus in buses]
    try:
        await until(lambda: all(server.relay.ready and len(server.relay.peers) == 2 for server in servers))
        await scene(servers)
        for session in [session for server in servers for session in server.sessions]:
            if session.name in servers[1].sessions:
                servers[1].sessions.end(session.name, ENDED, "over")  # nothing is kept for the next scene
        await until(lambda: not any(list(server.sessions) for server in servers))
        while await servers[1].relay.bus.kept():
            await asyncio.sleep(0.02)
    finally:
        for server in servers:
            server.task.cancel()
        await asyncio.gather(*(server.task for server in servers), return_exceptions=True)


async def until(condition: Callable[[], Any]) -> None:
    """Wait for a condition; fail after a while."""
    deadline = monotonic() + _HELD_S
    while not condition():
        assert monotonic() < deadline, "waited in vain"
        await asyncio.sleep(0.005)


def test_every_server_knows_every_session_and_its_state(play: Play) -> None:
    async def scene(servers: list[Server]) -> None:
        servers[0].rig("walk", notice="Sunny.")
        await until(lambda: all(server.told("walk").get("notice") == "Sunny." for server in servers))
        assert servers[2].told("walk") == servers[0].told("walk")
        assert servers[2].told("walk")["connected"]

    play(scene)


def test_a_viewer_elsewhere_gets_the_newest_at_once_and_then_what_comes(play: Play) -> None:
    async def scene(servers: list[Server]) -> None:
        _, _, session = servers[0].rig("walk")
        session.take_binary(frame(1), 0)
        session.take_binary(POSE, 0)
        await until(lambda: servers[1].has_rig("walk"))
        _, wire = servers[1].viewer("walk", "rig")
        await until(lambda: frame(1) in wire.sent and POSE in wire.sent)
        session.take_binary(frame(2), 0)
        await until(lambda: frame(2) in wire.sent)

    play(scene)


def test_who_does_not_see_gets_no_picture_from_another_server_until_it_is_shared(play: Play) -> None:
    async def scene(servers: list[Server]) -> None:
        _, _, session = servers[0].rig("walk")
        await until(lambda: servers[1].has_rig("walk") and servers[2].has_rig("walk"))
        _, walker = servers[1].viewer("walk", "rig")
        _, beside = servers[1].viewer("walk")
        _, stranger = servers[2].viewer("walk")
        await _frame_until(session, 1, lambda i: frame(i) in walker.sent)
        await _frame_until(session, 1000, lambda i: without_picture(frame(i)) in stranger.sent)
        await _frame_until(session, 2000, lambda i: without_picture(frame(i)) in beside.sent)
        assert not [m for m in stranger.sent + beside.sent if isinstance(m, bytes) and TINY_JPEG in m]
        session.take_text('{"type": "state", "sharing": true}')
        await _frame_until(session, 3000, lambda i: frame(i) in stranger.sent)

    play(scene)


async def _frame_until(session: Session, first: int, condition: Callable[[int], bool]) -> None:
    """Send a frame, which is lossy, and wait for a condition of it; then the next."""
    for i in range(first, first + 200):
        session.take_binary(frame(i), 0)
        for _ in range(20):
            await asyncio.sleep(0.005)
            if condition(i):
                return
    raise AssertionError("no frame was enough")


def test_a_request_reaches_the_rig_and_its_answer_the_one_who_asked(play: Play) -> None:
    async def scene(servers: list[Server]) -> None:
        _, rig, session = servers[0].rig("walk")
        await until(lambda: servers[1].has_rig("walk") and servers[2].has_rig("walk"))
        asker, asked = servers[1].viewer("walk", "operator")
        _, other = servers[2].viewer("walk", "operator")
        servers[1].sessions.get("walk").control(asker, ControlRequest("mine", "seek", 7.0))
        await until(lambda: rig.sent)
        request = json.loads(rig.sent[-1])
        assert (request["action"], request["value"]) == ("seek", 7.0)
        session.take_text(json.dumps({"type": "reply", "request_id": request["request_id"], "ok": True}))
        await until(lambda: any('"reply"' in m for m in asked.sent if isinstance(m, str)))
        reply = json.loads(next(m for m in asked.sent if isinstance(m, str) and '"reply"' in m))
        assert (reply["request_id"], reply["ok"]) == ("mine", True)
        assert not any('"reply"' in m for m in other.sent if isinstance(m, str))

    play(scene)


def test_a_rig_that_comes_to_another_server_takes_its_session_along(play: Play) -> None:
    async def scene(servers: list[Server]) -> None:
        old, _, before = servers[0].rig("walk", notice="Before.")
        await until(lambda: all(server.has_rig("walk") for server in servers))
        _, wire = servers[2].viewer("walk", "rig")
        _, _, after = servers[1].rig("walk", notice="After.")
        await until(lambda: old.closing is not None and all(s.told("walk")["notice"] == "After." for s in servers))
        assert old.closing == (REPLACED, "another rig took this session")
        before.detach_rig(old)
        assert all(server.told("walk")["connected"] for server in servers)
        await _frame_until(after, 1, lambda i: frame(i) in wire.sent)

    play(scene)


def test_viewers_everywhere_are_told_when_the_rig_leaves(play: Play) -> None:
    async def scene(servers: list[Server]) -> None:
        rig, _, session = servers[0].rig("walk")
        await until(lambda: servers[1].has_rig("walk"))
        _, wire = servers[1].viewer("walk")
        session.detach_rig(rig)
        await until(lambda: not servers[1].told("walk")["connected"])
        assert "left" in json.loads(str(wire.sent[-1]))["session"]["notice"]

    play(scene)


def test_an_operator_renames_and_ends_from_any_server(play: Play) -> None:
    async def scene(servers: list[Server]) -> None:
        rig, _, _ = servers[0].rig("walk.of-today")
        await until(lambda: servers[1].has_rig("walk.of-today") and servers[2].has_rig("walk.of-today"))
        viewer, _ = servers[2].viewer("walk.of-today")
        servers[1].sessions.get("walk.of-today").rename("East gate")
        await until(lambda: all(server.told("walk.of-today").get("title") == "East gate" for server in servers))
        servers[1].sessions.end("walk.of-today", ENDED, "It is late.")
        await until(lambda: not any("walk.of-today" in server.sessions for server in servers))
        assert rig.closing == (ENDED, "It is late.")
        assert viewer.closing == (ENDED, "It is late.")

    play(scene)


def test_a_server_that_is_gone_leaves_its_sessions_to_the_others(play: Play) -> None:
    """Nobody has the rig then; who renames one of them, or a rig that comes, takes it over."""

    async def scene(servers: list[Server]) -> None:
        gone, here, there = servers
        gone.rig("walk")
        await until(lambda: here.has_rig("walk") and there.has_rig("walk"))
        viewer, wire = here.viewer("walk")
        gone.task.cancel()
        here.late_s = there.late_s = 60.0
        await until(lambda: not here.has_rig("walk") and not there.has_rig("walk"))
        assert "left" in json.loads(str(wire.sent[-1]))["session"]["notice"]
        await until(lambda: len(here.relay.peers) == len(there.relay.peers) == 1)
        here.sessions.get("walk").rename("Orphan")
        await until(lambda: there.told("walk")["title"] == "Orphan")
        there.rig("walk")
        await until(lambda: here.has_rig("walk"))
        here.sessions.end("walk", ENDED, "It is late.")
        await until(lambda: "walk" not in here.sessions and "walk" not in there.sessions)
        assert viewer.closing == (ENDED, "It is late.")
        if "walk" in gone.sessions:  # a bus inside the process still brings it the news
            gone.sessions.forget("walk", ENDED, "It is late.")

    play(scene)


def test_nonsense_on_the_bus_harms_nobody(play: Play) -> None:
    async def scene(servers: list[Server]) -> None:
        _, _, session = servers[0].rig("walk")
        await until(lambda: servers[1].has_rig("walk"))
        _, wire = servers[1].viewer("walk", "rig")
        name, bus = servers[0].relay.server, servers[2].relay.bus
        for subject in ("agora.entries", f"agora.to.{name}", "agora.poses.walk", "agora.frames.whole.walk"):
            for data in (
                b"",
                b"{}",
                b"[" * 100_000,
                b"\xff\xfe",
                b"AGF1",
                b'{"name":"walk","server":"x","term":-1,"version":0}',
            ):
                bus.tell(subject, data)
        await _frame_until(session, 1, lambda i: frame(i) in wire.sent)
        assert servers[1].has_rig("walk")

    play(scene)


def test_nobody_hears_another_sessions_frames(play: Play) -> None:
    """Names that begin alike, and one that is a part of the other, among them."""

    async def scene(servers: list[Server]) -> None:
        names = ["walk", "walk.1", "walk-1", "walk1"]
        rigs = {name: servers[i % 2].rig(name)[2] for i, name in enumerate(names)}
        await until(lambda: all(servers[2].has_rig(name) for name in names))
        wires = {name: servers[2].viewer(name, "rig")[1] for name in names}
        for i, name in enumerate(names):
            await _frame_until(rigs[name], 1000 * (i + 1), lambda i, name=name: frame(i) in wires[name].sent)  # type: ignore[misc]
        for i, name in enumerate(names):
            ids = [int.from_bytes(m[8:12], "little") for m in wires[name].sent if isinstance(m, bytes)]
            assert ids
            assert {frame_id // 1000 for frame_id in ids} == {i + 1}

    play(scene)
