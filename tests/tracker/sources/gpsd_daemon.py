"""A real gpsd that hears a log over and over: Debian's `gpsfake` starts it and plays the log to it through a pseudo-terminal."""

import os
import signal
import socket
import subprocess
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

import pytest

from tests.ci.machine import has_gpsd, is_root
from tests.tracker.sources.listening import PATIENCE_S

_SENTENCE_S = 0.001
_LONGEST_S = 120.0
"""Both end after so long even if the test run was killed."""


def need_gpsd() -> None:
    """Skip the test where there is no gpsd and none can be installed."""
    if not has_gpsd():
        if is_root():
            pytest.fail("no gpsd: make test installs it, or run: apt-get install gpsd gpsd-clients python3-gps")
        pytest.skip("not root")


def free_port() -> int:
    """Return a TCP port that nobody listens at."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])


@contextmanager
def playing(log: Path) -> Iterator[int]:
    """Yield the port at which a gpsd listens whose receiver says what is in `log`, again and again."""
    port = free_port()
    play = ("gpsfake", "-q", "-c", str(_SENTENCE_S), "-P", str(port), str(log))
    command = ("timeout", "--kill-after=1", str(_LONGEST_S), *play)
    environment = os.environ | {"PATH": f"{os.environ.get('PATH', '')}:/usr/sbin:/sbin"}
    process = subprocess.Popen(
        command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, env=environment, start_new_session=True
    )
    try:
        _wait_for(port)
        yield port
    finally:
        children = Path(f"/proc/{process.pid}/task/{process.pid}/children").read_text(encoding="ascii").split()
        os.killpg(process.pid, signal.SIGTERM)
        try:
            process.wait(5.0)
        finally:
            with suppress(ProcessLookupError):
                os.killpg(process.pid, signal.SIGKILL)
            for child in children:  # gpsfake leaves its socket behind
                Path(f"/tmp/gpsfake-{child}.sock").unlink(missing_ok=True)


def _wait_for(port: int) -> None:
    end_s = time.monotonic() + PATIENCE_S
    while True:
        try:
            socket.create_connection(("127.0.0.1", port), 1.0).close()
            return
        except OSError:
            assert time.monotonic() < end_s, "gpsfake has started no gpsd"
            time.sleep(0.05)
