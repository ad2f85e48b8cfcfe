"""docs/scale.md: the files that it shows are files that the programs take."""

import os
import subprocess
import sys
from pathlib import Path

from server.configuration import read_configuration
from tests.server.cluster.certificates import make_certificates
from tests.server.cluster.guide import shown
from tests.server.cluster.proxy import haproxy

NATS = str(Path(sys.executable).with_name("nats-server"))


def test_the_servers_file_is_a_configuration(tmp_path: Path) -> None:
    path = tmp_path / "server.toml"
    path.write_text(shown("toml", "host"))
    configuration = read_configuration(path, {})
    assert (len(configuration.bus), configuration.bus_replicas) == (3, 3)
    assert "agora.example" in configuration.hosts


def test_the_nodes_file_is_one_that_nats_takes(tmp_path: Path) -> None:
    made = make_certificates(tmp_path)
    text = shown("", "server_name")
    for shown_path, path in (
        ("/etc/nats/node.pem", made.certificate),
        ("/etc/nats/node.key", made.key),
        ("/etc/nats/ca.pem", made.ca),
        ("/var/lib/nats", tmp_path / "store"),
    ):
        assert shown_path in text
        text = text.replace(shown_path, str(path))
    (tmp_path / "nats.conf").write_text(text)
    checked = subprocess.run(
        [NATS, "-t", "-c", str(tmp_path / "nats.conf")],
        env=os.environ | {"AGORA_BUS_PASSWORD": "c0ffee"},
        capture_output=True,
        text=True,
        check=False,
        timeout=30.0,
    )
    assert checked.returncode == 0, checked.stderr


def test_the_proxys_file_is_one_that_haproxy_takes(tmp_path: Path) -> None:
    made = make_certificates(tmp_path)
    pair = tmp_path / "pair.pem"
    pair.write_bytes(made.certificate.read_bytes() + made.key.read_bytes())
    text = shown("", "defaults")
    for shown_path, path in (("/etc/haproxy/agora.example.pem", pair), ("/etc/haproxy/agora-ca.pem", made.ca)):
        assert shown_path in text
        text = text.replace(shown_path, str(path))
    (tmp_path / "haproxy.cfg").write_text(text)
    checked = subprocess.run(
        [haproxy(), "-c", "-f", str(tmp_path / "haproxy.cfg")],
        capture_output=True,
        text=True,
        check=False,
        timeout=30.0,
    )
    assert checked.returncode == 0, checked.stderr
    assert "WARNING" not in checked.stderr
