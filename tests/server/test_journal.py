"""What the server says of itself: one line each, machine-readable where asked, and never a secret."""

import json
import logging
import sys

import pytest

from server.journal import JsonLines, TextLines, without_secrets


def record(message: str, **fields: object) -> logging.LogRecord:
    made = logging.getLogger("server.sockets").makeRecord(
        "server.sockets", logging.INFO, "f.py", 1, message, (), None, extra=fields
    )
    made.created = 0.25
    return made


def test_an_event_is_one_line_of_json_with_its_own_fields() -> None:
    line = JsonLines().format(record("a viewer\ncame", session="walk", viewers=3))
    assert "\n" not in line
    assert json.loads(line) == {
        "time": "1970-01-01T00:00:00.250+00:00",
        "level": "info",
        "logger": "server.sockets",
        "event": "a viewer\ncame",
        "session": "walk",
        "viewers": 3,
    }


def test_an_event_as_text_names_its_fields() -> None:
    assert TextLines().format(record("a viewer came", session="walk")) == "agora: a viewer came (session=walk)"


def test_a_trace_stays_with_its_event() -> None:
    event = record("failed")
    try:
        raise ValueError("why?token=abc")
    except ValueError:
        event.exc_info = sys.exc_info()
    read = json.loads(JsonLines().format(event))
    assert "ValueError: why?token=[left out]" in read["trace"]
    assert "ValueError: why?token=[left out]" in TextLines().format(event)


@pytest.mark.parametrize(
    "text",
    [
        "GET /ar?code=s3cret&session=walk",
        "ws://host/ws/view/walk?token=s3cret",
        "{'Authorization': 'Bearer s3cret'}",
        "authorization: bearer s3cret",
        'cookie="s3cret"; path=/',
    ],
)
def test_no_secret_is_written(text: str) -> None:
    assert "s3cret" not in without_secrets(text)
    assert "s3cret" not in JsonLines().format(record(text, address=text))
    assert "s3cret" not in TextLines().format(record("asked", address=text))


def test_other_words_stay() -> None:
    text = "a rig needs a token of this server; close code 1007, session=walk"
    assert without_secrets(text) == text
