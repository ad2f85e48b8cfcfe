"""Tokens: who may push as a rig, and who may watch where a server is not bound to loopback."""

import hmac
import secrets
from collections.abc import Iterable
from hashlib import sha256

_SCHEME = "bearer "


def new_token() -> str:
    """Return a fresh random token, 256 bits, safe in a URL."""
    return secrets.token_urlsafe(32)


class Tokens:
    """A set of tokens, kept as digests; a comparison takes the same time whatever was offered."""

    def __init__(self, tokens: Iterable[str]) -> None:
        if not all(given := list(tokens)):
            raise ValueError("an empty token would let everybody in")
        self._digests = [_digest(token) for token in given]

    def allows(self, token: str | None) -> bool:
        """Whether the token is one of ours."""
        offered = _digest(token or "")
        # No early end: every digest is compared.
        return bool(sum(hmac.compare_digest(offered, digest) for digest in self._digests))

    def allows_header(self, authorization: str | None) -> bool:
        """Whether an `Authorization: Bearer TOKEN` header carries one of ours."""
        header = authorization or ""
        return self.allows(header[len(_SCHEME) :].strip() if header.lower().startswith(_SCHEME) else None)


def _digest(token: str) -> bytes:
    return sha256(token.encode(errors="surrogateescape")).digest()
