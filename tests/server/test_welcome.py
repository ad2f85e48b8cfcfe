"""The way in, in two languages."""

import re
from pathlib import Path

import pytest

from server.welcome import SENTENCES, WORDS, language_of, said, words

ROOT = Path(__file__).parents[2]


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


def test_every_word_and_sentence_is_there_in_both_languages() -> None:
    assert words("en").keys() == words("tr").keys() == WORDS.keys()
    assert all(words("en")[name] != words("tr")[name] for name in WORDS)
    for sentence, turkish in SENTENCES.items():
        assert said(sentence, "en") == sentence
        assert said(sentence, "tr") == turkish != sentence
    assert said("Something new.", "tr") == "Something new."


def test_every_reason_to_refuse_a_token_is_known_in_turkish() -> None:
    texts = [(ROOT / "server" / name).read_text(encoding="utf-8") for name in ("tokens.py", "codes.py")]
    reasons = {reason for text in texts for reason in re.findall(r'TokenRefused\(\s*"([^"]+)"', text)}
    assert len(reasons) >= 4
    assert reasons <= SENTENCES.keys()
