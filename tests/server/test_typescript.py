"""The page's types of the messages are those of the schema, and what the server says is what the schema says."""

import json

import msgspec
import pytest

from server.fanout import Mailbox
from server.messages import Hello, SensorHealth, SessionNews
from server.session import Session
from server.typescript import PLACE, _type, typescript


def test_the_committed_types_are_those_of_the_schema() -> None:
    assert PLACE.read_text(encoding="utf-8") == typescript(), "run `make wire`"


def test_what_a_viewer_receives_is_as_the_schema_says() -> None:
    session, viewer = Session("walk"), Mailbox()
    rig = Mailbox()
    session.attach_rig(rig)
    health = {"gps": {"trouble": True, "sentence": "Gone.", "state": "lost", "rate_hz": 0.0, "of a newer rig": 1}}
    session.take_text(json.dumps({"type": "state", "session": {"kind": "live", "health": health}}))
    session.join(viewer)
    session.take_text(json.dumps({"type": "state", "notice": "News."}))
    session.detach_rig(rig)
    hello, *news = viewer._texts
    told = msgspec.json.decode(hello, type=Hello)
    assert (told.version, told.role, told.session.connected) == (1, "local", True)
    assert told.session.health == {"gps": SensorHealth(True, "Gone.", "lost", 0.0)}
    changes = [msgspec.json.decode(text, type=SessionNews).session for text in news]
    assert [(change.notice or "")[:5] for change in changes] == ["News.", "The r"]
    assert changes[-1].connected is False


def test_what_the_page_would_not_know_is_no_part_of_a_message() -> None:
    with pytest.raises(TypeError, match="BytesType"):
        _type(msgspec.inspect.type_info(bytes))
