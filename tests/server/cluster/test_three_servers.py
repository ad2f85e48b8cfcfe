"""`agora serve` three times on three nodes of NATS: a node dies, then the server with the rigs, and nobody misses anything else."""

from contextlib import ExitStack
from pathlib import Path
from time import monotonic

import pytest

from tests.server.cluster.trio import MARK, Rig, Served, Trio, Watcher, trio, wait

NAMES = ("east-gate", "west-gate")


@pytest.mark.slow
def test_a_node_and_then_a_server_are_killed(tmp_path: Path) -> None:
    """How long poses stay away is measured by `tests/benchmarks/failover.py`."""
    with ExitStack() as stack:
        running = stack.enter_context(trio(tmp_path))
        rigs = [stack.enter_context(Rig(running.proxy_port, name, MARK * (i + 1))) for i, name in enumerate(NAMES)]
        wait(lambda: all(_told(server) for server in running.servers))
        watchers = [
            stack.enter_context(Watcher(server.port, running.proxy_port, name))
            for server in running.servers
            for name in NAMES
        ]
        wait(lambda: all(watcher.came for watcher in watchers))
        before = running.servers[2].sessions()
        _kill_the_rigs_node(running)
        _until_poses_flow(watchers)
        running.servers[0].kill()
        _until_poses_flow(watchers)
        wait(lambda: all(server.sessions() == before for server in running.servers[1:]))
        assert all(session["connected"] for session in before.values())
        for watcher in watchers:
            mark = MARK * (NAMES.index(watcher.session) + 1)
            assert {number // MARK * MARK for _, number in watcher.came} == {mark}, "poses of another session"
            assert {session["name"] for session in watcher.told} == {watcher.session}
        watchers[-1].ask()
        wait(lambda: watchers[-1].answers)
        assert watchers[-1].answers[0]["ok"]
        assert [len(rig.asked) for rig in rigs] == [0, 1]


def _told(server: Served) -> bool:
    """Whether a server knows what both rigs have told of themselves."""
    sessions = server.sessions()
    return all(name in sessions and sessions[name]["notice"] == name for name in NAMES)


def _kill_the_rigs_node(running: Trio) -> None:
    """Kill the node that the server has joined which both rigs are connected to."""
    port = running.servers[0].node_port
    next(node for node in running.nodes if node.port == port).kill()


def _until_poses_flow(watchers: list[Watcher]) -> None:
    """Wait until each of them has got a pose that came from now on, by half a second."""
    from_s = monotonic() + 0.5
    wait(lambda: all(watcher.newest_s() > from_s for watcher in watchers))
