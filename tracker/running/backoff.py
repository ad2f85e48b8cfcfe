"""How long to wait before something that failed is tried again. Pure."""

_FIRST_S, _LONGEST_S = 0.25, 2.0
#: What has run for so long has recovered: its next failure is a first one.
_RECOVERED_S = 5.0


class Backoff:
    """Pauses that double: a plug put back is found within two seconds, and a device that is not there costs nothing."""

    def __init__(self) -> None:
        self._pause_s = _FIRST_S

    def after(self, ran_s: float) -> float:
        """Return the pause after a run of so long."""
        if ran_s >= _RECOVERED_S:
            self._pause_s = _FIRST_S
        pause_s, self._pause_s = self._pause_s, min(2.0 * self._pause_s, _LONGEST_S)
        return pause_s
