"""One-time codes: what stands in a server's first address, and is exchanged for a cookie there. For one event loop; pure."""

import secrets
from collections.abc import Callable
from hashlib import sha256
from typing import Final

from server.errors import ServerFull, TokenRefused
from server.grants import Grant

LIFETIME_S: Final = 600.0
MAX_CODES: Final = 256


class Codes:
    """Grants that wait to be fetched, each once, by those who know its code."""

    def __init__(self, now_s: Callable[[], float]) -> None:
        """`now_s` is any clock that does not jump."""
        self._now_s = now_s
        self._waiting: dict[bytes, tuple[Grant, float]] = {}

    def new(self, grant: Grant) -> str:
        """Return a code for a grant, good for ten minutes.

        Raises:
            ServerFull: Too many wait.
        """
        now_s = self._now_s()
        self._waiting = {key: kept for key, kept in self._waiting.items() if kept[1] > now_s}
        if len(self._waiting) >= MAX_CODES:
            raise ServerFull(f"{MAX_CODES} codes wait to be used already: try again in some minutes.")
        code = secrets.token_urlsafe(24)
        self._waiting[_digest(code)] = (grant, now_s + LIFETIME_S)
        return code

    def redeem(self, code: str) -> Grant:
        """Return a code's grant, once.

        Raises:
            TokenRefused: It is none, was used already, or its time is over.
        """
        # looked up by digest: how long that takes tells nothing of the codes
        grant, t_end_s = self._waiting.pop(_digest(code), (None, 0.0))
        if grant is None or t_end_s <= self._now_s():
            raise TokenRefused(
                "This code was used already or its time is over: ask for another, or enter with a token."
            )
        return grant


def _digest(code: str) -> bytes:
    return sha256(code.encode(errors="replace")).digest()
