"""A source on a thread of its own, and what it says."""

import time
from collections.abc import Callable
from threading import Event, Thread
from types import TracebackType

from tracker.measurements import GpsFix, GpsVelocity, Measurement
from tracker.sources.source import Source

PATIENCE_S = 60.0
"""How long to wait for what must come; only a failing test waits so long."""


class Listening:
    """Runs a source while the context is open."""

    def __init__(self, source: Source) -> None:
        self.found: list[Measurement] = []
        self.error: Exception | None = None
        self._source, self._stop = source, Event()
        self._thread = Thread(target=self._run, daemon=True)

    def __enter__(self) -> "Listening":
        self._thread.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        self.stop()

    def _run(self) -> None:
        try:
            self._source.run(self.found.append, self._stop)
        except Exception as error:
            self.error = error

    def stop(self) -> None:
        """End it."""
        self._stop.set()
        self.join()

    def join(self) -> None:
        """Wait for its end."""
        self._thread.join(PATIENCE_S)
        assert not self._thread.is_alive()

    def wait(self, is_done: Callable[[], bool]) -> None:
        """Wait until something has happened."""
        end_s = time.monotonic() + PATIENCE_S
        while not is_done():
            assert self.error is None, self.error
            assert time.monotonic() < end_s, f"{len(self.found)} measurements, {self._source.status()}"
            time.sleep(0.01)

    @property
    def fixes(self) -> list[GpsFix]:
        """The fixes so far."""
        return [m for m in list(self.found) if isinstance(m, GpsFix)]

    @property
    def velocities(self) -> list[GpsVelocity]:
        """The velocities so far."""
        return [m for m in list(self.found) if isinstance(m, GpsVelocity)]
