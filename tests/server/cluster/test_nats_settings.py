"""How a server reaches NATS: what would send a password in the clear, or to anybody, is refused before anything is sent."""

import ssl
from pathlib import Path
from typing import Any

import pytest

from server.cluster.nats_settings import NatsSettings
from tests.server.cluster.certificates import make_certificates
from tracker.errors import InputError


def test_another_machine_is_reached_by_tls_from_the_first_byte(tmp_path: Path) -> None:
    certificates = make_certificates(tmp_path)
    options = NatsSettings(
        urls=["tls://10.0.0.1:4222", "tls://[fd00::2]:4222"],
        ca=str(certificates.ca),
        certificate=str(certificates.certificate),
        key=str(certificates.key),
    ).options()
    assert options["tls_handshake_first"]
    assert options["tls"].verify_mode == ssl.CERT_REQUIRED
    assert options["tls"].check_hostname


def test_a_node_on_this_machine_may_do_without(tmp_path: Path) -> None:
    (tmp_path / "password").write_text("east gate\n")
    settings = NatsSettings(urls=["nats://127.0.0.1:4222"], user="agora", password_file=str(tmp_path / "password"))
    options = settings.options()
    assert "tls" not in options
    assert (options["user"], options["password"]) == ("agora", "east gate")


@pytest.mark.parametrize(
    ("fields", "says"),
    [
        ({"urls": ["nats://10.0.0.1:4222"]}, "write tls://10.0.0.1:4222"),
        ({"urls": ["nats://example.org"]}, "write tls://example.org:4222"),
        ({"urls": ["tls://agora:secret@10.0.0.1"]}, "bus_password_file"),
        ({"urls": ["http://10.0.0.1"]}, "tls://HOST:4222"),
        ({"urls": ["tls://"]}, "tls://HOST:4222"),
        ({"urls": ["tls://10.0.0.1:99999"]}, "tls://HOST:4222"),
        ({"urls": ["nats://127.0.0.1", "tls://10.0.0.1"]}, "not both"),
        ({"urls": ["tls://10.0.0.1"], "ca": "/none/ca.pem"}, "certificates cannot be used"),
        ({"urls": ["nats://localhost"], "user": "agora", "password_file": "/none/password"}, "cannot be read"),
        ({"urls": ["nats://localhost"], "user": "agora", "password_file": "/dev/null"}, "holds no password"),
    ],
)
def test_a_mistake_is_one_sentence_that_tells_no_secret(fields: dict[str, Any], says: str) -> None:
    with pytest.raises(InputError, match=says) as caught:
        NatsSettings(**fields).options()
    assert "secret" not in str(caught.value)
