"""TLS: certificates that were given, and an authority of the server's own that can vouch for nobody else."""

import ipaddress
import json
import os
import signal
import ssl
import stat
import subprocess
import sys
from collections.abc import Iterator
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any

import httpx
import pytest
from cryptography import x509
from cryptography.hazmat.primitives import hashes, serialization
from cryptography.hazmat.primitives.asymmetric import ec
from websockets.sync.connection import Connection

from assets.site import load_site
from server.configuration import Configuration
from server.local_authority import LocalAuthority, make, own_names
from server.messages import ControlReply, ControlRequest
from server.options import SITE
from server.push import RigLink
from server.serving import Serving
from server.tls import Tls
from server.web_server import WebServer
from tests.server.serving import bytes_of, serving, token, until, viewer
from tests.server.test_privacy import frame
from tracker.errors import InputError

NOW = datetime(2026, 6, 1, 12, tzinfo=UTC)
NAMES = ("localhost", "127.0.0.1", "::1", "rig.local")
AGORA = str(Path(sys.executable).with_name("agora"))


def today() -> datetime:
    return datetime.now(UTC)


def trusting(path: Path) -> ssl.SSLContext:
    """Return what a device has that has installed this authority and no other."""
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
    context.load_verify_locations(path)
    return context


def handshake(server: ssl.SSLContext, client: ssl.SSLContext, name: str) -> None:
    """Connect both within this process; `SSLCertVerificationError` where the client does not trust the server."""
    to_server, to_client = ssl.MemoryBIO(), ssl.MemoryBIO()
    ours = client.wrap_bio(to_client, to_server, server_hostname=name)
    theirs = server.wrap_bio(to_server, to_client, server_side=True)
    for _ in range(5):
        for side in (ours, theirs):
            try:
                side.do_handshake()
            except ssl.SSLWantReadError:
                continue


def obey(request: ControlRequest) -> ControlReply:
    return ControlReply(request.request_id, ok=True)


def viewer_over_tls(server: WebServer, device: ssl.SSLContext) -> Connection:
    """Connect as a viewer; once more where nothing is answered.

    This client reads and writes in two threads, and in CPython these race within one TLS connection
    (github.com/python/cpython/issues/143756): an answer that never comes is taken for that, once.
    """
    try:
        return viewer(server, ssl=device, open_timeout=5.0)
    except TimeoutError:
        return viewer(server, ssl=device)


def shown_by(tls: Tls) -> ssl.SSLContext:
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
    context.load_cert_chain(tls.certificate, tls.key)
    return context


@pytest.mark.parametrize("name", NAMES)
def test_a_device_that_installed_the_authority_trusts_the_server_by_its_names(tmp_path: Path, name: str) -> None:
    authority = LocalAuthority(tmp_path, NAMES, today())
    handshake(shown_by(authority.tls), trusting(authority.path), name)
    with pytest.raises(ssl.SSLCertVerificationError):
        handshake(shown_by(authority.tls), ssl.create_default_context(), name)


@pytest.mark.parametrize("name", ["evil.example", "localhost.evil.example", "192.0.2.1", "2001:db8::1"])
def test_even_who_stole_the_authoritys_key_while_it_signed_could_vouch_for_nobody_else(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str
) -> None:
    keys: list[ec.EllipticCurvePrivateKey] = []
    generate = ec.generate_private_key

    def watched(curve: Any) -> ec.EllipticCurvePrivateKey:
        keys.append(generate(curve))
        return keys[-1]

    monkeypatch.setattr("cryptography.hazmat.primitives.asymmetric.ec.generate_private_key", watched)
    made = make(NAMES, today())
    authority, certificate = (x509.load_pem_x509_certificate(pem) for pem in (made.authority, made.certificate))
    stolen = next(key for key in keys if key.public_key() == authority.public_key())
    tls = Tls(tmp_path / "forged.pem", tmp_path / "server.key")
    tls.key.write_bytes(made.key)
    (tmp_path / "authority.pem").write_bytes(made.authority)

    def forge(subject: x509.GeneralName) -> None:
        builder = x509.CertificateBuilder(
            certificate.issuer,
            certificate.subject,
            certificate.public_key(),
            x509.random_serial_number(),
            certificate.not_valid_before_utc,
            certificate.not_valid_after_utc,
        )
        for extension in certificate.extensions:
            is_names = isinstance(extension.value, x509.SubjectAlternativeName)
            value = x509.SubjectAlternativeName([subject]) if is_names else extension.value
            builder = builder.add_extension(value, extension.critical)
        signed = builder.sign(stolen, hashes.SHA256())
        tls.certificate.write_bytes(signed.public_bytes(serialization.Encoding.PEM))

    forge(x509.DNSName("localhost"))
    handshake(shown_by(tls), trusting(tmp_path / "authority.pem"), "localhost")  # the forger knows how
    is_address = name[0].isdigit()
    forge(x509.IPAddress(ipaddress.ip_address(name)) if is_address else x509.DNSName(name))
    with pytest.raises(ssl.SSLCertVerificationError, match="permitted subtree violation"):
        handshake(shown_by(tls), trusting(tmp_path / "authority.pem"), name)


def test_the_authoritys_key_is_nowhere_and_the_servers_is_its_owners(tmp_path: Path) -> None:
    authority = LocalAuthority(tmp_path / "tls", NAMES, today())
    assert sorted(path.name for path in (tmp_path / "tls").iterdir()) == ["authority.pem", "server.key", "server.pem"]
    assert stat.S_IMODE(authority.tls.key.stat().st_mode) == 0o600
    key = serialization.load_pem_private_key(authority.tls.key.read_bytes(), None)
    certificate = x509.load_pem_x509_certificate(authority.path.read_bytes())
    assert key.public_key() != certificate.public_key()
    assert authority.path.read_bytes().count(b"-----BEGIN") == 1


def test_it_is_kept_until_names_change_or_time_runs_out(tmp_path: Path) -> None:
    first = LocalAuthority(tmp_path, NAMES, NOW).fingerprint
    assert LocalAuthority(tmp_path, reversed(NAMES), NOW + timedelta(days=300)).fingerprint == first
    second = LocalAuthority(tmp_path, (*NAMES, "agora.example"), NOW).fingerprint
    assert second != first
    third = LocalAuthority(tmp_path, (*NAMES, "agora.example"), NOW + timedelta(days=380)).fingerprint
    assert third != second
    (tmp_path / "server.key").write_text("broken")
    assert LocalAuthority(tmp_path, (*NAMES, "agora.example"), NOW + timedelta(days=380)).fingerprint != third


def test_names_that_are_none_are_refused() -> None:
    with pytest.raises(InputError, match="--host"):
        make(["a..b"], NOW)
    make(own_names(), NOW)


def test_certificates_that_do_not_fit_are_refused(tmp_path: Path) -> None:
    authority = LocalAuthority(tmp_path / "a", NAMES, NOW)
    other = LocalAuthority(tmp_path / "b", NAMES, NOW)
    authority.tls.check()
    with pytest.raises(InputError, match="no certificate and its key"):
        Tls(authority.tls.certificate, other.tls.key).check()
    with pytest.raises(InputError, match="cannot be read"):
        Tls(tmp_path / "none.pem", other.tls.key).check()


@pytest.fixture
def secure(tmp_path: Path) -> Iterator[tuple[WebServer, LocalAuthority]]:
    authority = LocalAuthority(tmp_path / "tls", NAMES, today())
    with serving(tmp_path, tls=authority.tls) as server:
        yield server, authority


def test_pages_and_sockets_over_tls(secure: tuple[WebServer, LocalAuthority]) -> None:
    server, authority = secure
    assert server.url.startswith("https://")
    device = trusting(authority.path)
    ready = httpx.get(f"{server.url}ready", verify=device, trust_env=False, headers={"Host": "127.0.0.1"})
    assert (ready.status_code, ready.headers["strict-transport-security"]) == (200, "max-age=2592000")
    local = httpx.get(f"{server.url}ready", verify=device, trust_env=False, headers={"Host": "localhost"})
    assert (local.status_code, "strict-transport-security" in local.headers) == (200, False)
    made = httpx.post(f"{server.url}api/codes", verify=device, trust_env=False)
    assert made.status_code == 201
    with RigLink(server.rig_url("walk"), token("rig", "walk"), obey, authority.tls.own_pem()) as link:
        until(lambda: link.connected)
        with viewer_over_tls(server, device) as watching:
            for number in range(1, 11):  # each goes at once, whatever went before
                link.send_frame(frame(number))
                assert bytes_of(watching) == frame(number)
                watching.send(json.dumps({"type": "ack", "frame_id": number}))


def test_a_cookie_over_tls_stays_on_tls(secure: tuple[WebServer, LocalAuthority]) -> None:
    server, authority = secure
    with httpx.Client(base_url=server.url, verify=trusting(authority.path), trust_env=False) as browser:
        entered = browser.post("/enter", data={"token": token("viewer")})
    assert entered.headers["set-cookie"].endswith("; HttpOnly; SameSite=Strict; Secure")


def test_a_rig_trusts_the_certificate_that_it_was_given_and_no_other(
    secure: tuple[WebServer, LocalAuthority], tmp_path: Path
) -> None:
    server, _ = secure
    other = LocalAuthority(tmp_path / "other", NAMES, today())
    with RigLink(server.rig_url("walk"), token("rig", "walk"), obey, other.tls.own_pem()) as wrong:
        with RigLink(server.rig_url("walk"), token("rig", "walk"), obey, secure[1].tls.own_pem()) as right:
            until(lambda: right.connected)
        assert not wrong.connected


def test_serve_with_an_authority_of_its_own_brings_it_to_devices(tmp_path: Path) -> None:
    (tmp_path / "web").mkdir()
    (tmp_path / "web" / "index.html").write_text("<title>index</title>")
    variables = {"AGORA_PORT": "0", "AGORA_DATA": str(tmp_path / "data"), "AGORA_WEB": str(tmp_path / "web")}
    command = [AGORA, "serve", "--tls-local"]
    with subprocess.Popen(command, env=os.environ | variables, text=True, stdout=subprocess.PIPE) as process:
        try:
            assert process.stdout is not None
            lines = [process.stdout.readline().strip() for _ in range(4)]
            url, first, page, fingerprint = (line.split()[-1] for line in lines)
            with httpx.Client(trust_env=False) as device:
                until(lambda: _answers(device, page))
                shown = device.get(page)
                assert "<svg" in shown.text
                assert "style=" not in shown.text, "the page's policy would not allow it"
                assert fingerprint in shown.text
                installed = tmp_path / "installed.pem"
                installed.write_text(ssl.DER_cert_to_PEM_cert(device.get(f"{page}agora.crt").content))
                assert device.get(page, headers={"Host": "evil.example"}).status_code == 403
            with httpx.Client(verify=trusting(installed), trust_env=False) as device:
                assert first.startswith(f"{url}enter?code=")
                assert "Secure" in device.get(first).headers["set-cookie"]
            process.send_signal(signal.SIGTERM)
            assert process.wait(20) == 0
        finally:
            process.kill()


def _answers(device: httpx.Client, url: str) -> bool:
    try:
        return device.get(url).status_code == 200
    except httpx.TransportError:
        return False


@pytest.mark.parametrize(
    ("options", "sentence"),
    [
        ({"tls_cert": "a.pem"}, "A certificate needs its key"),
        ({"tls_key": "b.pem"}, "A certificate needs its key"),
        ({"tls_cert": "a.pem", "tls_key": "b.pem"}, "cannot be read"),
        ({"tls_cert": "a.pem", "tls_key": "b.pem", "tls_local": True}, "not both"),
    ],
)
def test_what_cannot_be_served_with_is_one_sentence(tmp_path: Path, options: dict[str, Any], sentence: str) -> None:
    configuration = Configuration(port=0, data=str(tmp_path), **options)
    with pytest.raises(InputError, match=sentence):
        Serving(configuration, load_site(SITE), tmp_path)
