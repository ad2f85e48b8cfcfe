"""`agora token`: what it prints is good on the server with the same folder."""

from pathlib import Path

import pytest
from typer.testing import CliRunner

from server.cli import app
from server.secret_file import secret_of
from server.token_command import seconds
from server.tokens import Signer
from tracker.errors import InputError


def test_a_printed_token_is_good_on_the_server_of_that_folder(tmp_path: Path) -> None:
    command = ["token", "rig", "--session", "walk-7", "--for", "90m", "--data", str(tmp_path)]
    done = CliRunner().invoke(app, command)
    assert done.exit_code == 0
    signer = Signer(secret_of(tmp_path))
    grant = signer.read(done.stdout.strip())
    assert (grant.role, grant.session) == ("rig", "walk-7")
    assert grant.t_expires_s is not None
    assert 5390.0 < grant.t_expires_s - signer.now_s() <= 5400.0


@pytest.mark.parametrize(
    ("options", "sentence"),
    [
        (["rig"], "name it with --session"),
        (["viewer", "--session", "../x"], "No walk can be named"),
        (["viewer", "--for", "forever"], "write 90m"),
    ],
)
def test_what_cannot_be_granted_is_one_sentence(tmp_path: Path, options: list[str], sentence: str) -> None:
    done = CliRunner().invoke(app, ["token", *options, "--data", str(tmp_path)])
    assert isinstance(done.exception, InputError)
    assert sentence in str(done.exception)


@pytest.mark.parametrize(("text", "time_s"), [("90m", 5400), ("8h", 28_800), ("366d", 366 * 86_400)])
def test_times(text: str, time_s: int) -> None:
    assert seconds(text) == time_s


@pytest.mark.parametrize("text", ["", "8", "h", "0h", "-1h", "1.5h", "367d", "999999h", "8h\n", "8H"])
def test_no_times(text: str) -> None:
    with pytest.raises(InputError):
        seconds(text)
