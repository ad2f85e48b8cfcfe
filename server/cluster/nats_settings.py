"""How a server reaches NATS, and proves who it is."""

import ssl
from pathlib import Path
from typing import Any, Final
from urllib.parse import urlsplit

from msgspec import Struct

from tracker.errors import InputError

_LOOPBACK: Final = ("127.0.0.1", "localhost", "::1")
_LONGEST_PASSWORD: Final = 1024


class NatsSettings(Struct, frozen=True, kw_only=True):
    """Of the bus; files by their paths, empty for none."""

    urls: list[str]
    user: str = ""
    password_file: str = ""
    ca: str = ""
    """Who vouches for the servers of NATS; empty for the machine's authorities."""
    certificate: str = ""
    """Of this server, where those of NATS ask for one."""
    key: str = ""
    replicas: int = 1

    def options(self) -> dict[str, Any]:
        """Return the arguments of `nats.connect` that say where and who.

        Raises:
            InputError: A file cannot be read, or what is given does not fit.
        """
        secure = [self._check(url) for url in self.urls]
        if any(secure) != all(secure):
            raise InputError("The bus's servers are reached with TLS or without, not both: write tls:// before each.")
        options: dict[str, Any] = {"servers": list(self.urls), "pending_size": 2 * 1024 * 1024}
        if any(secure):
            # TLS from the first byte: NATS's own greeting could be changed on the way to one that asks for none
            options |= {"tls": self._context(), "tls_handshake_first": True}
        if self.user:
            options |= {"user": self.user, "password": self._password()}
        return options

    def _check(self, url: str) -> bool:
        """Return whether a server is reached with TLS."""
        try:
            parts = urlsplit(url)
            host, _ = parts.hostname, parts.port
        except ValueError as exc:
            raise InputError(f"The bus has no server {url[:80]!r}: write tls://HOST:4222.") from exc
        if parts.username or parts.password:
            raise InputError("A password does not belong in the bus's address: use bus_user and bus_password_file.")
        if parts.scheme not in ("nats", "tls") or not host:
            raise InputError(f"The bus has no server {url[:80]!r}: write tls://HOST:4222.")
        if parts.scheme == "nats" and host not in _LOOPBACK:
            raise InputError(
                f"{host} is another machine: write tls://{host}:{parts.port or 4222}, and see docs/scale.md."
            )
        return parts.scheme == "tls"

    def _context(self) -> ssl.SSLContext:
        try:
            context = ssl.create_default_context(cafile=self.ca or None)
            if self.certificate:
                context.load_cert_chain(self.certificate, self.key or None)
        except (OSError, ssl.SSLError) as exc:
            raise InputError(f"The bus's certificates cannot be used: {exc}.") from exc
        return context

    def _password(self) -> str:
        path = Path(self.password_file).expanduser()
        try:
            text = path.read_text(encoding="utf-8").strip()
        except (OSError, ValueError) as exc:
            raise InputError(f"The bus's password cannot be read: write it into {path}.") from exc
        if not 0 < len(text) <= _LONGEST_PASSWORD:
            raise InputError(f"{path} holds no password: write one line into it.")
        return text
