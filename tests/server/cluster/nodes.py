"""Servers of NATS on loopback, each a process that its context ends, for the tests of this folder."""

import json
import socket
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from time import monotonic, sleep

from tests.server.cluster.certificates import Certificates

_PROGRAM = Path(sys.executable).with_name("nats-server")
_START_S = 20.0


class Node:
    """One server of NATS."""

    def __init__(self, name: str, port: int, process: "subprocess.Popen[bytes]") -> None:
        self.name, self.port, self.process = name, port, process

    def kill(self) -> None:
        """End it without a word."""
        self.process.kill()
        self.process.wait(10.0)


@contextmanager
def nodes(
    folder: Path, how_many: int = 1, *, secured: Certificates | None = None, password: str = ""
) -> Iterator[list[Node]]:
    """Run so many, a cluster where they are several, each that answers.

    Where they are secured they speak TLS alone, know each other by certificates, and let in the user `agora` by its password.
    """
    clients, routes = free_ports(how_many), free_ports(how_many)
    running: list[Node] = []
    try:
        for i in range(how_many):
            path = folder / f"nats-{i}.conf"
            tls = "" if secured is None else _tls(secured)
            path.write_text(_configuration(folder, i, clients, routes, tls))
            if secured is not None:
                path.write_text(path.read_text() + _door(secured, password))
            with (folder / f"nats-{i}.log").open("wb") as log:
                process = subprocess.Popen([str(_PROGRAM), "-c", str(path)], stdout=log, stderr=log)
            running.append(Node(f"n{i}", clients[i], process))
        for node in running:
            _until_it_answers(node, folder)
        yield running
    finally:
        for node in running:
            node.kill()


def free_ports(how_many: int) -> list[int]:
    """Return ports that nobody has."""
    sockets = [socket.create_server(("127.0.0.1", 0)) for _ in range(how_many)]
    ports = [one.getsockname()[1] for one in sockets]
    for one in sockets:
        one.close()
    return ports


def _tls(secured: Certificates) -> str:
    """Return the lines by which nodes know each other."""
    files = {"cert_file": secured.certificate, "key_file": secured.key, "ca_file": secured.ca}
    return "tls { " + ", ".join(f"{name}: {json.dumps(str(path))}" for name, path in files.items()) + ", verify: true }"


def _door(secured: Certificates, password: str) -> str:
    """Return the lines by which clients come in."""
    files = {"cert_file": secured.certificate, "key_file": secured.key}
    tls = ", ".join(f"{name}: {json.dumps(str(path))}" for name, path in files.items())
    return (
        f"tls {{ {tls}, handshake_first: true }}\nauthorization {{ user: agora, password: {json.dumps(password)} }}\n"
    )


def _configuration(folder: Path, i: int, clients: list[int], routes: list[int], tls: str) -> str:
    lines = [
        f'server_name: n{i}\nlisten: "127.0.0.1:{clients[i]}"\nmax_payload: 8MB',
        f"jetstream {{ store_dir: {json.dumps(str(folder / f'store-{i}'))} }}",
    ]
    if len(clients) > 1:
        others = ", ".join(f'"nats://127.0.0.1:{port}"' for j, port in enumerate(routes) if j != i)
        lines.append(f'cluster {{ name: agora, listen: "127.0.0.1:{routes[i]}", routes: [{others}], {tls} }}')
    return "\n".join(lines) + "\n"


def _until_it_answers(node: Node, folder: Path) -> None:
    deadline = monotonic() + _START_S
    while True:
        try:
            socket.create_connection(("127.0.0.1", node.port), 1.0).close()
            return
        except OSError:
            assert node.process.poll() is None, (folder / f"nats-{node.name[1:]}.log").read_text()
            assert monotonic() < deadline, f"{node.name} did not start"
            sleep(0.02)
