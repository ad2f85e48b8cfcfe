"""HAProxy as docs/scale.md sets it before several servers, but without TLS, and with the first one that is there preferred."""

import os
import re
import shutil
import socket
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from time import monotonic, sleep

import pytest

from tests.server.cluster.guide import shown
from tests.server.cluster.nodes import free_ports

_STARTS_WITHIN_S = 20.0


def haproxy() -> str:
    """Return the program; a test that needs it is skipped where it is missing and cannot be installed."""
    path = shutil.which("haproxy", path=f"{os.environ.get('PATH', '')}:/usr/sbin:/sbin")
    if path is None:
        pytest.skip("not root")
    return path


@contextmanager
def proxy(folder: Path, ports: list[int]) -> Iterator[int]:
    """Run it before servers at these ports, and give its own."""
    port = free_ports(1)[0]
    path = folder / "haproxy.cfg"
    path.write_text(_settings(port, ports))
    process = subprocess.Popen([haproxy(), "-db", "-f", str(path)], stderr=subprocess.PIPE, text=True)
    try:
        _await(process, port)
        yield port
    finally:
        process.kill()
        process.communicate()


def _settings(port: int, ports: list[int]) -> str:
    text, _, _ = shown("", "defaults").partition("    server s1")
    for is_, becomes in (
        (r"bind .*", f"bind 127.0.0.1:{port}"),
        (r"balance leastconn", "balance first"),
        (r"agora\.example", "127.0.0.1"),
        (r" ssl verify .*", ""),
    ):
        text, changed = re.subn(is_, becomes, text)
        assert changed, is_
    return text + "".join(f"    server s{i} 127.0.0.1:{one}\n" for i, one in enumerate(ports, 1))


def _await(process: "subprocess.Popen[str]", port: int) -> None:
    deadline = monotonic() + _STARTS_WITHIN_S
    while monotonic() < deadline:
        if process.poll() is not None:
            _, said = process.communicate()
            raise RuntimeError(said)
        with suppress(OSError), socket.create_connection(("127.0.0.1", port), 1.0):
            return
        sleep(0.02)
    raise TimeoutError("HAProxy does not listen")
