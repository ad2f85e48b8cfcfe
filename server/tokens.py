"""Tokens: grants signed by HMAC-SHA256 with the server's secret, so that a server need remember none of them.

A token is `agora1.PAYLOAD.SIGNATURE`, both parts base64url without padding; the payload is the grant as JSON, and the signature
is of everything before its dot. A new secret makes all older tokens void.
"""

import hmac
import secrets
from base64 import urlsafe_b64decode, urlsafe_b64encode
from binascii import Error as NotBase64
from collections.abc import Callable
from hashlib import sha256
from time import time_ns
from typing import Final, Literal

import msgspec

from server.errors import TokenRefused
from server.grants import Grant, SessionName

SECRET_BYTES: Final = 32
_PREFIX: Final = "agora1"
#: No token of ours comes near this.
_LONGEST: Final = 1024

Issued = Literal["viewer", "rig", "operator", "admin"]


class _Payload(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    role: Issued
    exp: int
    session: SessionName | None = None
    id: str = ""
    """Makes two tokens for the same thing differ."""


class Signer:
    """Makes and reads a server's tokens."""

    def __init__(self, secret: bytes, now_s: Callable[[], float] = lambda: time_ns() * 1e-9) -> None:
        """`now_s` is the wall clock, seconds since 1970: tokens outlive the program."""
        if len(secret) < SECRET_BYTES:
            raise ValueError(f"expected a secret of at least {SECRET_BYTES} bytes, got {len(secret)}")
        self._secret = secret
        self.now_s = now_s

    def issue(self, role: Issued, t_expires_s: int, session: str | None = None) -> str:
        """Return a token; `ValueError` for a rig without a session, or a name that no session can have."""
        if role == "rig" and session is None:
            raise ValueError("a rig's token is for one session")
        payload = _Payload(role, t_expires_s, session, secrets.token_urlsafe(6))
        data = msgspec.json.encode(payload)
        try:
            msgspec.json.decode(data, type=_Payload)
        except msgspec.ValidationError as exc:
            raise ValueError(f"no session can have this name: {exc}") from exc
        head = f"{_PREFIX}.{_to_text(data)}"
        return f"{head}.{_to_text(self._signature(head))}"

    def read(self, token: str) -> Grant:
        """Return what a token grants.

        Raises:
            TokenRefused: It is not one of this server's, or its time is over.
        """
        head, _, signature = token[:_LONGEST].rpartition(".")
        # the signature is compared before anything of the payload is looked at, and as text: each has one spelling
        ours = _to_text(self._signature(head))
        if not hmac.compare_digest(ours.encode(), signature.encode(errors="replace")) or len(token) > _LONGEST:
            raise TokenRefused("This token is not one of this server's: ask its operator for another.")
        prefix, _, text = head.partition(".")
        try:
            payload = msgspec.json.decode(urlsafe_b64decode(text + "=" * (-len(text) % 4)), type=_Payload)
        except (msgspec.MsgspecError, NotBase64, ValueError) as exc:
            raise TokenRefused("This token is of another version: ask the server's operator for another.") from exc
        grant = Grant(payload.role, payload.session, payload.exp)
        if prefix != _PREFIX or (grant.role == "rig" and grant.session is None):
            raise TokenRefused("This token is of another version: ask the server's operator for another.")
        if grant.expired(self.now_s()):
            raise TokenRefused("This token has expired: ask the server's operator for another.")
        return grant

    def tag(self, purpose: str) -> str:
        """Return eight digits that are this secret's and tell nothing of it."""
        return self._signature(purpose).hex()[:8]

    def _signature(self, text: str) -> bytes:
        return hmac.new(self._secret, text.encode(errors="replace"), sha256).digest()


def is_token(text: str) -> bool:
    """Whether a text means to be a token, and no one-time code."""
    return text.startswith(f"{_PREFIX}.")


def _to_text(data: bytes) -> str:
    return urlsafe_b64encode(data).rstrip(b"=").decode()
