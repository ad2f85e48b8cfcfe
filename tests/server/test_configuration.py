"""The server's configuration: what goes before what, that it prints itself, and one sentence for every mistake."""

from pathlib import Path

import msgspec
import pytest

from server.configuration import Configuration, as_toml, read_configuration
from server.limits import Limits
from tracker.errors import InputError


def written(folder: Path, text: str) -> Path:
    path = folder / "server.toml"
    path.write_text(text, encoding="utf-8")
    return path


def test_options_go_before_the_environment_before_the_file_before_the_defaults(tmp_path: Path) -> None:
    path = written(tmp_path, 'host = "10.0.0.1"\nport = 1\nmax_sessions = 3\nkeep_days = 7\n')
    environment = {
        "AGORA_CONFIG": str(path),
        "AGORA_PORT": "2",
        "AGORA_MAX_SESSIONS": "4",
        "AGORA_NAMES": "a.example, b",
    }
    read = read_configuration(None, environment, {"port": 5, "host": None})
    assert (read.host, read.port, read.max_sessions, read.keep_days) == ("10.0.0.1", 5, 4, 7.0)
    assert read.names == ["a.example", "b"]
    assert read.max_viewers == Configuration().max_viewers


def test_the_limits_of_an_address_are_settings_like_others() -> None:
    read = read_configuration(None, {"AGORA_MAX_BURST": "20", "AGORA_MAX_HEAD_S": "2.5", "AGORA_PROXIES": "10.0.0.7"})
    assert read.limits == Limits(burst=20.0, header_s=2.5, proxies=frozenset({"10.0.0.7"}))
    assert Configuration().limits == Limits()


def test_what_is_printed_reads_back_as_itself_and_explains_every_field(tmp_path: Path) -> None:
    configuration = Configuration(
        port=0, names=['quo"te', "Έφεσος"], data="C:\\a\x7f\t", keep_days=0.5, log_format="json"
    )
    text = as_toml(configuration)
    assert read_configuration(written(tmp_path, text), {}) == configuration
    lines = text.splitlines()
    for field in msgspec.structs.fields(Configuration):
        at = next(i for i, line in enumerate(lines) if line.startswith(f"{field.name} = "))
        assert lines[at - 1].startswith("# ")


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("port = 70000", "port"),
        ('port = "8470"', "port"),
        ("prot = 1", "prot"),
        ("[log]\nlevel = 1", "log"),
        ("port = ", "no TOML"),
        ("a" + "[" * 3000 + "]" * 3000, "no TOML"),
        ("#" + " " * 1_000_001, "too large"),
    ],
)
def test_a_mistake_in_the_file_is_one_sentence_with_the_remedy(tmp_path: Path, text: str, says: str) -> None:
    with pytest.raises(InputError, match=says) as caught:
        read_configuration(written(tmp_path, text), {})
    assert "--print-config" in str(caught.value)
    assert "server.toml" in str(caught.value)


@pytest.mark.parametrize(
    ("name", "value"), [("AGORA_PORT", "many"), ("AGORA_LOG_FORMAT", "xml"), ("AGORA_KEEP_DAYS", "-1")]
)
def test_a_mistake_in_the_environment_names_its_variable(name: str, value: str) -> None:
    with pytest.raises(InputError, match=f"^{name} in the environment"):
        read_configuration(None, {name: value, "HOME": "/"})


def test_a_file_that_was_asked_for_must_be_there(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="cannot be read"):
        read_configuration(tmp_path / "none.toml", {})


def test_the_names_of_a_server_are_loopbacks_its_own_and_those_given() -> None:
    assert "0.0.0.0" not in Configuration(host="0.0.0.0").hosts
    assert {"10.0.0.1", "agora.example", "localhost"} <= Configuration(host="10.0.0.1", names=["agora.example"]).hosts
    assert Configuration().on_loopback
    assert not Configuration(host="0.0.0.0").on_loopback
