"""Three servers on a cluster of three: how late poses are across them, and for how long they stay away when one of all is killed.

    python -m tests.benchmarks.failover

Everything is on this machine: three nodes of NATS with TLS, three `agora serve`, a proxy, two rigs at 30 Hz, and viewers of both at
each server. First a node of NATS is killed, the one that the rigs' server has joined; then that server. Another server, that is
alone, is killed and started again at the same port.
"""

import argparse
import json
import os
import sys
from contextlib import ExitStack
from dataclasses import asdict, dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from time import monotonic, sleep
from typing import Final

import numpy as np

from tests.server.cluster.nodes import free_ports
from tests.server.cluster.trio import MARK, Rig, Served, Trio, Watcher, serve, trio, wait

AWAY_TARGET_S: Final = 2.0
REJOIN_TARGET_S: Final = 3.0
_NAMES: Final = ("east-gate", "west-gate")


@dataclass(frozen=True)
class Figures:
    """Of one run, seconds."""

    same_p50_s: float
    """From a rig's sending a pose to a viewer's having it, both at one server."""
    same_p99_s: float
    across_p50_s: float
    """The same, the viewer at another server."""
    across_p99_s: float
    node_away_s: float
    """The longest that any viewer was without poses when a node of NATS was killed; one thirtieth is the usual."""
    server_away_s: float
    """When the rigs' server was killed, of those who watched elsewhere."""
    rejoined_s: float
    """The same, of those who watched there."""
    restarted_s: float
    """From when a server that was killed answers again to the first pose at its viewer."""


def measure(seconds: float) -> Figures:
    """Run all of it once, so long before each kill."""
    with TemporaryDirectory() as folder, ExitStack() as stack:
        running = stack.enter_context(trio(Path(folder)))
        rigs = [stack.enter_context(Rig(running.proxy_port, name, MARK * (i + 1))) for i, name in enumerate(_NAMES)]
        wait(lambda: all(set(server.sessions()) == set(_NAMES) for server in running.servers))
        watchers = [
            [stack.enter_context(Watcher(server.port, running.proxy_port, name)) for name in _NAMES]
            for server in running.servers
        ]
        there, elsewhere = watchers[0], [watcher for at in watchers[1:] for watcher in at]
        wait(lambda: all(watcher.came for watcher in there + elsewhere))
        sleep(seconds)
        sent = {number: t_s for rig in rigs for number, t_s in rig.sent.items()}
        same, across = _delays(there, sent), _delays(elsewhere, sent)
        node_s = _kill_node(running)
        sleep(seconds)
        node_away_s = max(watcher.longest_gap_s(node_s) for watcher in there + elsewhere)
        server_s = monotonic()
        running.servers[0].kill()
        sleep(seconds)
        return Figures(
            same_p50_s=float(np.percentile(same, 50.0)),
            same_p99_s=float(np.percentile(same, 99.0)),
            across_p50_s=float(np.percentile(across, 50.0)),
            across_p99_s=float(np.percentile(across, 99.0)),
            node_away_s=node_away_s,
            server_away_s=max(watcher.longest_gap_s(server_s) for watcher in elsewhere),
            rejoined_s=max(watcher.longest_gap_s(server_s) for watcher in there),
            restarted_s=restart_s(),
        )


def restart_s() -> float:
    """Kill a server that is alone, and start it again: return how long after that a viewer has poses again."""
    with TemporaryDirectory() as name, ExitStack() as stack:
        folder, port = Path(name), free_ports(1)[0]
        (folder / "web").mkdir()
        (folder / "web" / "index.html").write_text("<title>agora</title>")
        settings = {"AGORA_WEB": str(folder / "web"), "AGORA_PORT": str(port), "AGORA_LOG_FORMAT": "json"}
        with serve(folder / "data", settings) as started:
            Served(*started)
            stack.enter_context(Rig(port, "walk", MARK))
            watcher = stack.enter_context(Watcher(port, port, "walk"))
            wait(lambda: watcher.came)
        with serve(folder / "data", settings) as started:
            Served(*started)  # it says where it is once it answers
            t_s = monotonic()
            wait(lambda: watcher.newest_s() > t_s)
            return next(came_s for came_s, _ in watcher.came if came_s > t_s) - t_s


def _delays(watchers: list[Watcher], sent: dict[int, float]) -> list[float]:
    return [t_s - sent[number] for watcher in watchers for t_s, number in watcher.came if number in sent]


def _kill_node(running: Trio) -> float:
    """Kill the node that the rigs' server has joined; return when."""
    port = running.servers[0].node_port
    t_s = monotonic()
    next(node for node in running.nodes if node.port == port).kill()
    return t_s


def rows_of(figures: Figures) -> list[tuple[str, float, str, str, float]]:
    """Return name, value, unit, what it is beside, and the ratio to that, of each row of `make bench`."""
    cores = f"{os.cpu_count()} cores"
    away, rejoin = f"target {AWAY_TARGET_S:g}", f"target {REJOIN_TARGET_S:g}"
    return [
        (
            f"pose to a viewer at another server, p99, {cores}",
            figures.across_p99_s * 1e3,
            "ms",
            f"at the same server {figures.same_p99_s * 1e3:.0f}",
            figures.across_p99_s / figures.same_p99_s,
        ),
        ("a node of NATS killed: poses away", figures.node_away_s, "s", away, figures.node_away_s / AWAY_TARGET_S),
        ("a server killed: poses away", figures.server_away_s, "s", away, figures.server_away_s / AWAY_TARGET_S),
        (
            "a server killed: its viewers without poses",
            figures.rejoined_s,
            "s",
            rejoin,
            figures.rejoined_s / REJOIN_TARGET_S,
        ),
        (
            "a server killed and started again: to the first pose",
            figures.restarted_s,
            "s",
            rejoin,
            figures.restarted_s / REJOIN_TARGET_S,
        ),
    ]


def main() -> None:
    """Measure and print it."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seconds", type=float, default=5.0)
    figures = measure(parser.parse_args().seconds)
    sys.stdout.write(json.dumps({"cores": os.cpu_count(), **asdict(figures)}) + "\n")


if __name__ == "__main__":
    main()
