"""A certificate and its key, as files: checked before anything is served with them."""

import ssl
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from tracker.errors import InputError

_END: Final = "-----END CERTIFICATE-----\n"


@dataclass(frozen=True)
class Tls:
    """What a server shows, and its key."""

    certificate: Path
    """PEM: the server's own first, then those that lead to the authority's."""
    key: Path

    def own_pem(self) -> str:
        """Return the server's own certificate alone."""
        head, end, _ = self.certificate.read_text(encoding="ascii", errors="replace").partition(_END)
        return head + end

    def check(self) -> None:
        """Try both.

        Raises:
            InputError: They cannot be read, are none, or do not belong together.
        """
        try:
            # a key with a password would ask for it on the terminal; a server that starts by itself has nobody to ask
            ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER).load_cert_chain(self.certificate, self.key, password=_nobody)
        except ssl.SSLError as exc:
            raise InputError(
                f"{self.certificate} and {self.key} are no certificate and its key, in PEM and without a password ({exc.reason})."
            ) from exc
        except OSError as exc:
            raise InputError(f"{self.certificate} or {self.key} cannot be read: {exc.strerror}.") from exc


def _nobody() -> str:
    return ""
