"""A certificate authority for one server on a network of its own, where no public one can vouch for it: Safari refuses wss without.

Whoever installs an authority trusts whatever it signs. So this one can vouch for this server's names and addresses alone (critical
name constraints, RFC 5280 4.2.1.10), and its key is never written: it signs once and is gone.
"""

import ipaddress
import os
import socket
import ssl
from collections.abc import Iterable
from contextlib import suppress
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from hashlib import sha256
from pathlib import Path
from typing import Final

from cryptography import x509
from cryptography.exceptions import InvalidSignature
from cryptography.hazmat.primitives import hashes, serialization
from cryptography.hazmat.primitives.asymmetric import ec
from cryptography.x509.oid import ExtendedKeyUsageOID, NameOID

from server.tls import Tls
from tracker.errors import InputError

#: Below all limits that browsers set: Apple's is 825 days for an authority that a user has installed.
_VALID: Final = timedelta(days=397)
#: A certificate with less than this before it is made anew: so long can a walk, or an exhibition, last.
_LEAST: Final = timedelta(days=30)
#: Clocks of devices without a network are behind.
_BACKDATED: Final = timedelta(days=1)


@dataclass(frozen=True)
class Made:
    """An authority without its key, and what it signed. All PEM."""

    authority: bytes
    certificate: bytes
    key: bytes


def make(names: Iterable[str], now: datetime) -> Made:
    """Return a new authority for some names and addresses, with the server's certificate that it signed.

    Raises:
        InputError: A name is none.
    """
    try:
        subjects = [_general_name(name) for name in sorted(set(names))]
    except ValueError as exc:
        raise InputError(f"No certificate can be for these names: {exc}; see `names` and --host.") from exc
    authority_key, key = (ec.generate_private_key(ec.SECP256R1()) for _ in range(2))
    issuer = _name(f"Agora on {socket.gethostname()[:40]}, {now:%Y-%m-%d}")
    authority = (
        _builder(issuer, issuer, authority_key, now)
        .add_extension(x509.BasicConstraints(ca=True, path_length=0), critical=True)
        .add_extension(_usage(signs_certificates=True), critical=True)
        .add_extension(x509.NameConstraints([_subtree(subject) for subject in subjects], None), critical=True)
        .add_extension(x509.SubjectKeyIdentifier.from_public_key(authority_key.public_key()), critical=False)
        .sign(authority_key, hashes.SHA256())
    )
    certificate = (
        _builder(_name("Agora"), issuer, key, now)
        .add_extension(x509.BasicConstraints(ca=False, path_length=None), critical=True)
        .add_extension(_usage(signs_certificates=False), critical=True)
        .add_extension(x509.ExtendedKeyUsage([ExtendedKeyUsageOID.SERVER_AUTH]), critical=False)
        .add_extension(x509.SubjectAlternativeName(subjects), critical=False)
        .add_extension(x509.SubjectKeyIdentifier.from_public_key(key.public_key()), critical=False)
        .add_extension(
            x509.AuthorityKeyIdentifier.from_issuer_public_key(authority_key.public_key()),
            critical=False,
        )
        .sign(authority_key, hashes.SHA256())
    )
    pem = serialization.Encoding.PEM
    return Made(
        authority.public_bytes(pem),
        certificate.public_bytes(pem),
        key.private_bytes(pem, serialization.PrivateFormat.PKCS8, serialization.NoEncryption()),
    )


class LocalAuthority:
    """What was made for a server, kept in a folder and made anew when its names change or its time runs out."""

    def __init__(self, folder: Path, names: Iterable[str], now: datetime) -> None:
        """Read, or make, what is needed.

        Raises:
            InputError: The folder cannot be written, or a name is none.
        """
        names = frozenset(names)
        self.path = folder / "authority.pem"
        self.tls = Tls(folder / "server.pem", folder / "server.key")
        try:
            if not self._is_good(names, now):
                self._write(make(names, now))
            self.authority_der = ssl.PEM_cert_to_DER_cert(self.path.read_text())
        except OSError as exc:
            raise InputError(f"{folder} cannot be written: {exc.strerror}; choose another folder with --data.") from exc

    @property
    def fingerprint(self) -> str:
        """SHA-256 of the authority's certificate, as devices show it."""
        return sha256(self.authority_der).digest().hex(":").upper()

    def _is_good(self, names: frozenset[str], now: datetime) -> bool:
        try:
            certificate = x509.load_pem_x509_certificate(self.tls.certificate.read_bytes())
            authority = x509.load_pem_x509_certificate(self.path.read_bytes())
            certificate.verify_directly_issued_by(authority)
            self.tls.check()
        except (OSError, ValueError, TypeError, InvalidSignature, InputError):
            return False
        alternatives = certificate.extensions.get_extension_for_class(x509.SubjectAlternativeName).value
        return set(alternatives) == {_general_name(name) for name in names} and (
            certificate.not_valid_after_utc - now > _LEAST
        )

    def _write(self, made: Made) -> None:
        self.path.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
        for path, data in (
            (self.tls.key, made.key),
            (self.tls.certificate, made.certificate),
            (self.path, made.authority),
        ):
            draft = path.with_suffix(".new")
            with suppress(FileNotFoundError):
                draft.unlink()
            with os.fdopen(os.open(draft, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600), "wb") as file:
                file.write(data)
            draft.replace(path)


def own_names() -> frozenset[str]:
    """Return the names and addresses by which devices on the same network reach this machine."""
    found = {"localhost", "127.0.0.1", "::1"}
    host = socket.gethostname().lower()
    if host:
        found |= {host, host if "." in host else f"{host}.local"}
    for family, elsewhere in ((socket.AF_INET, "192.0.2.1"), (socket.AF_INET6, "2001:db8::1")):
        # which of its addresses this machine would take to go elsewhere; nothing is sent
        with suppress(OSError), socket.socket(family, socket.SOCK_DGRAM) as probe:
            probe.connect((elsewhere, 9))
            found.add(probe.getsockname()[0])
    return frozenset(found)


def _builder(
    subject: x509.Name, issuer: x509.Name, key: ec.EllipticCurvePrivateKey, now: datetime
) -> x509.CertificateBuilder:
    return (
        x509.CertificateBuilder()
        .subject_name(subject)
        .issuer_name(issuer)
        .public_key(key.public_key())
        .serial_number(x509.random_serial_number())
        .not_valid_before(now.astimezone(UTC) - _BACKDATED)
        .not_valid_after(now.astimezone(UTC) + _VALID - _BACKDATED)
    )


def _name(common: str) -> x509.Name:
    return x509.Name([x509.NameAttribute(NameOID.COMMON_NAME, common)])


def _usage(*, signs_certificates: bool) -> x509.KeyUsage:
    return x509.KeyUsage(
        digital_signature=not signs_certificates,
        key_cert_sign=signs_certificates,
        crl_sign=False,
        content_commitment=False,
        key_encipherment=False,
        data_encipherment=False,
        key_agreement=False,
        encipher_only=False,
        decipher_only=False,
    )


def _general_name(name: str) -> x509.GeneralName:
    try:
        return x509.IPAddress(ipaddress.ip_address(name))
    except ValueError:
        return x509.DNSName(name.encode("idna").decode().lower())


def _subtree(subject: x509.GeneralName) -> x509.GeneralName:
    """Return what an authority may vouch for: this name, or this one address."""
    if isinstance(subject, x509.IPAddress):
        return x509.IPAddress(ipaddress.ip_network(subject.value))
    return subject
