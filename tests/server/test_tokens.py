"""Tokens: what we signed passes until its time is over, and nothing else does."""

import base64
import os
import stat
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from server.errors import TokenRefused
from server.grants import LOCAL, Grant
from server.secret_file import secret_of
from server.tokens import Signer
from tracker.errors import InputError

NOW_S = 1_800_000_000
SIGNER = Signer(bytes(range(32)), lambda: NOW_S)
TOKEN = SIGNER.issue("rig", NOW_S + 10, "walk")


def test_a_token_says_what_it_was_made_for() -> None:
    assert SIGNER.read(TOKEN) == Grant("rig", "walk", NOW_S + 10)
    assert SIGNER.read(SIGNER.issue("viewer", NOW_S + 1)) == Grant("viewer", None, NOW_S + 1)
    assert SIGNER.issue("viewer", NOW_S + 1) != SIGNER.issue("viewer", NOW_S + 1)


def test_a_token_ends_on_the_second() -> None:
    with pytest.raises(TokenRefused, match="expired"):
        Signer(bytes(range(32)), lambda: NOW_S + 10).read(TOKEN)
    assert Signer(bytes(range(32)), lambda: NOW_S + 9.9).read(TOKEN).role == "rig"


def test_another_servers_token_is_none_of_ours() -> None:
    with pytest.raises(TokenRefused, match="not one of"):
        Signer(bytes(32), lambda: NOW_S).read(TOKEN)


@given(place=st.integers(0, len(TOKEN) - 1), character=st.characters(codec="utf-8"))
def test_one_other_character_is_a_forgery(place: int, character: str) -> None:
    forged = TOKEN[:place] + character + TOKEN[place + 1 :]
    if forged == TOKEN:
        return
    with pytest.raises(TokenRefused):
        SIGNER.read(forged)


@given(st.text())
def test_no_text_is_a_token_and_none_does_harm(text: str) -> None:
    with pytest.raises(TokenRefused):
        SIGNER.read(text)
    with pytest.raises(TokenRefused):
        SIGNER.read(TOKEN + text[:1] + ".")


@pytest.mark.parametrize(
    "payload",
    [
        b'{"role":"local","exp":9999999999}',
        b'{"role":"rig","exp":9999999999}',
        b'{"role":"viewer"}',
        b'{"role":"viewer","exp":9999999999,"more":1}',
        b'{"role":"viewer","exp":9999999999,"session":"a/b"}',
        b"\xff",
    ],
)
def test_what_we_would_never_sign_is_refused_even_signed(payload: bytes) -> None:
    head = "agora1." + base64.urlsafe_b64encode(payload).rstrip(b"=").decode()
    signature = base64.urlsafe_b64encode(SIGNER._signature(head)).rstrip(b"=").decode()
    with pytest.raises(TokenRefused, match="another version"):
        SIGNER.read(f"{head}.{signature}")


def test_what_cannot_be_granted_is_a_mistake() -> None:
    with pytest.raises(ValueError, match="one session"):
        SIGNER.issue("rig", NOW_S)
    with pytest.raises(ValueError, match="name"):
        SIGNER.issue("viewer", NOW_S, "../walk")
    with pytest.raises(ValueError, match="32 bytes"):
        Signer(b"short", lambda: NOW_S)


ALL = {"watch", "see", "control", "publish", "operate", "administer"}
OPERATES = {"watch", "control", "operate"}


@pytest.mark.parametrize(
    ("grant", "own", "other", "server"),
    [
        (Grant("viewer", "walk"), {"watch"}, set(), set()),
        (Grant("viewer"), {"watch"}, {"watch"}, {"watch"}),
        (Grant("rig", "walk"), {"watch", "see", "control", "publish"}, set(), set()),
        (Grant("operator"), OPERATES, OPERATES, OPERATES),
        (Grant("admin", "walk"), OPERATES | {"administer"}, set(), set()),
        (LOCAL, OPERATES | {"see"}, OPERATES | {"see"}, OPERATES | {"see"}),
    ],
)
def test_who_may_do_what(grant: Grant, own: set[str], other: set[str], server: set[str]) -> None:
    def allowed(session: str | None) -> set[str]:
        return {ability for ability in ALL if grant.allows(ability, session)}  # type: ignore[arg-type]

    assert (allowed("walk"), allowed("other"), allowed(None)) == (own, other, server)


def test_the_secret_is_made_once_and_is_its_owners(tmp_path: Path) -> None:
    secret = secret_of(tmp_path / "data")
    path = tmp_path / "data" / "secret"
    assert secret_of(tmp_path / "data") == secret == path.read_bytes()
    assert stat.S_IMODE(path.stat().st_mode) == 0o600
    assert [entry.name for entry in path.parent.iterdir()] == ["secret"]


def test_a_secret_that_is_none_is_refused(tmp_path: Path) -> None:
    secret_of(tmp_path)
    path = tmp_path / "secret"
    path.chmod(0o640)
    with pytest.raises(InputError, match="chmod 600"):
        secret_of(tmp_path)
    path.chmod(0o600)
    path.write_bytes(b"short")
    with pytest.raises(InputError, match="no secret"):
        secret_of(tmp_path)
    path.unlink()
    os.symlink("/etc/hostname", path)
    with pytest.raises(InputError, match="cannot be read"):
        secret_of(tmp_path)
