"""The server's own pages, in every language that there is."""

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

from server.language import CATALOGUES, LANGUAGES, language_of, speaking

SERVER = Path(__file__).parents[2] / "server"
SOURCES = [path for path in SERVER.rglob("*.py") if path.parent.name != "language"]


@pytest.mark.parametrize(
    ("accepted", "language"),
    [
        (None, "en"),
        ("", "en"),
        ("tr", "tr"),
        ("tr-TR,tr;q=0.9,en;q=0.8", "tr"),
        ("en-GB,en;q=0.9,tr;q=0.8", "en"),
        ("de, tr;q=0.5, en;q=0.4", "tr"),
        ("de;q=1.0", "en"),
        ("tr;q=zero, en;q=0.1", "en"),
        ("tr;q=0", "en"),
        (";;;q=,,=", "en"),
    ],
)
def test_the_language_is_the_one_that_is_wished_most(accepted: str | None, language: str) -> None:
    assert language_of(accepted) == language


def texts(path: Path) -> Iterator[str]:
    """Yield the texts of a source that are said to visitors as they stand there."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "say":
            for argument in node.args:
                if isinstance(argument, ast.Constant):
                    yield str(argument.value)


@pytest.mark.parametrize("language", CATALOGUES)
def test_every_text_that_is_said_is_in_every_language_and_no_other(language: str) -> None:
    catalogue = CATALOGUES[language]
    said = {text for path in SOURCES for text in texts(path)}
    assert len(said) > 30
    assert said <= catalogue.keys()
    written = {
        str(node.value)
        for path in SOURCES
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        if isinstance(node, ast.Constant)
    }
    sides = {f"{down} {across}" for down in ("top", "bottom") for across in ("left", "right")}
    assert catalogue.keys() <= written | sides
    for text, there in catalogue.items():
        assert there.strip() == there != ""
        assert re.findall(r"{\w+}", there) == re.findall(r"{\w+}", text)


def test_a_text_that_is_not_known_stays_as_it_is() -> None:
    assert LANGUAGES[0] == "en"
    assert [speaking(language)("Something new.") for language in LANGUAGES] == ["Something new."] * len(LANGUAGES)
    assert speaking("tr")("Enter") == "Gir"


def test_every_reason_to_refuse_a_token_is_known_in_every_language() -> None:
    sources = [(SERVER / name).read_text(encoding="utf-8") for name in ("tokens.py", "codes.py")]
    reasons = {reason for source in sources for reason in re.findall(r'TokenRefused\(\s*"([^"]+)"', source)}
    assert len(reasons) >= 4
    assert all(reasons <= catalogue.keys() for catalogue in CATALOGUES.values())
