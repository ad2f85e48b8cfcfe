"""One thread for each sensor, restarted when it ends: one sensor's death is never another's."""

import logging
from collections.abc import Callable
from threading import Event, Thread
from time import monotonic

from tracker.errors import InputError, SourceLost
from tracker.measurements import Measurement
from tracker.running.backoff import Backoff
from tracker.sources.source import Source

_logger = logging.getLogger(__name__)


class SourceThread:
    """Runs one source again and again. What happens to it is told by `tell`: `opened`, `lost` or `failed`, and why."""

    def __init__(
        self, source: Source, put: Callable[[str, Measurement], None], tell: Callable[[str, str, str], None]
    ) -> None:
        """`put` takes the sensor's name and a measurement; `tell` the name, what happened and the reason."""
        self.source = source
        self._put, self._tell = put, tell
        self._stop = Event()
        self._thread = Thread(target=self._run, name=f"source-{source.name}", daemon=True)

    def start(self) -> None:
        """Start."""
        self._thread.start()

    def stop(self) -> None:
        """Ask it to end."""
        self._stop.set()

    def join(self, timeout_s: float) -> bool:
        """Wait for the end, at most so long; return whether it has come."""
        self._thread.join(timeout_s)
        return not self._thread.is_alive()

    def _run(self) -> None:
        name, backoff = self.source.name, Backoff()
        while not self._stop.is_set():
            self._tell(name, "opened", "")
            began_s = monotonic()
            try:
                self.source.run(lambda measurement: self._put(name, measurement), self._stop)
                reason = "it has ended"
            except SourceLost as error:
                reason = str(error)
            except InputError as error:
                self._tell(name, "failed", str(error))
                return
            except Exception as error:
                # a mistake of ours in one source must not cost the others: it is told, and tried again like a lost plug
                _logger.exception("the source %s failed", name)
                reason = f"its driver failed ({type(error).__name__}: {error})"
            if not self._stop.is_set():
                self._tell(name, "lost", reason)
                self._stop.wait(backoff.after(monotonic() - began_s))
