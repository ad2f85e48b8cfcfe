"""Tests of how the tests' browser is found."""

import io
from collections.abc import Callable

import pytest
from rich.console import Console

from tests.ci import machine


def answers(*values: str | None) -> Callable[[], str | None]:
    """Return a `find_browser` that gives `values` one after the other."""
    remaining = iter(values)
    return lambda: next(remaining)


@pytest.fixture
def calls(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """What was asked of the machine, in order; each request is granted."""
    made: list[str] = []

    def succeeds(*command: str, timeout_s: float = 0.0) -> bool:
        made.append("playwright" if "playwright" in command else " ".join(command))
        return True

    def install(*packages: str) -> bool:
        made.append(f"install {' '.join(packages)}")
        return True

    monkeypatch.setattr(machine, "succeeds", succeeds)
    monkeypatch.setattr(machine, "install", install)
    return made


@pytest.mark.parametrize(
    ("found", "asked"),
    [
        (("/usr/bin/chromium",), []),
        ((None, "/home/playwright/chrome"), ["playwright"]),
        ((None, None, "/usr/bin/chromium"), ["playwright", "install chromium"]),
    ],
)
def test_a_browser_is_found_then_downloaded_then_installed(
    monkeypatch: pytest.MonkeyPatch, calls: list[str], found: tuple[str | None, ...], asked: list[str]
) -> None:
    monkeypatch.setattr(machine, "find_browser", answers(*found))
    assert machine.get_browser(Console(file=io.StringIO()))
    assert calls == asked


@pytest.mark.parametrize(("root", "code"), [(True, 3), (False, 0)])
def test_what_is_missing_is_said_in_one_sentence(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], root: bool, code: int
) -> None:
    monkeypatch.setattr(machine, "is_root", lambda: root)
    for get, there in (
        ("get_open_gl", True),
        ("get_font", True),
        ("get_browser", False),
        ("get_gpsd", True),
        ("get_proxy", True),
    ):
        monkeypatch.setattr(machine, get, lambda _say, there=there: there)
    assert machine.main() == code
    assert capsys.readouterr().err == "agora: the tests need a browser: run as root: apt-get install chromium\n"


def test_without_root_nothing_is_installed(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(machine, "is_root", lambda: False)
    monkeypatch.setattr(machine, "succeeds", lambda *_command, **_options: pytest.fail("a command was run"))
    assert not machine.install("chromium")


def test_a_command_that_hangs_or_is_absent_has_not_succeeded() -> None:
    assert machine.succeeds("true")
    assert not machine.succeeds("false")
    assert not machine.succeeds("a-command-that-is-not-there")
    assert not machine.succeeds("sleep", "20", timeout_s=0.05)
