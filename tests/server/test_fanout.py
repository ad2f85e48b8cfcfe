"""Mailboxes: newest frame wins, text keeps its order, three unacknowledged frames at most."""

from hypothesis import given
from hypothesis import strategies as st

from server.fanout import MAX_TEXTS, MAX_UNACKNOWLEDGED, TOO_SLOW, Mailbox
from server.wire import decode_frame, encode_frame
from tests.server.lines import Wire
from tests.server.wire_examples import TINY_JPEG, example_frame


def frame(frame_id: int, *, did_seek: bool = False) -> bytes:
    return encode_frame(example_frame(frame_id, did_seek=did_seek), TINY_JPEG)


def test_text_goes_before_the_newest_frame_before_the_newest_pose() -> None:
    mailbox, wire = Mailbox(), Wire()
    mailbox.put_pose(b"old pose")
    mailbox.put_pose(b"pose")
    mailbox.put_frame(1, frame(1))
    mailbox.put_frame(2, frame(2))
    mailbox.put_text("a")
    mailbox.put_text("b")
    mailbox.open(wire)
    assert wire.sent == ["a", "b", frame(2), b"pose"]


def test_what_is_put_in_goes_at_once_where_the_line_is_free() -> None:
    mailbox, wire = Mailbox(), Wire()
    mailbox.open(wire)
    mailbox.put_pose(b"pose")
    assert wire.sent == [b"pose"]


def test_a_busy_line_gets_the_newest_pose_when_it_is_free_again_and_not_those_before() -> None:
    mailbox, wire = Mailbox(), Wire(room=1)
    mailbox.open(wire)
    for i in range(5):
        mailbox.put_pose(b"%d" % i)
    assert wire.sent == [b"0"]
    wire.make_room()
    assert wire.sent == [b"0", b"4"]
    assert (mailbox.tally.poses_sent, mailbox.tally.poses_dropped) == (2, 3)


def test_a_viewer_that_acknowledges_nothing_gets_three_frames_and_all_texts() -> None:
    mailbox, wire = Mailbox(), Wire()
    mailbox.open(wire)
    for i in range(10):
        mailbox.put_frame(i, frame(i))
        mailbox.put_text(str(i))
    mailbox.acknowledge(MAX_UNACKNOWLEDGED - 1)
    assert [m for m in wire.sent if isinstance(m, str)] == [str(i) for i in range(10)]
    assert [m for m in wire.sent if isinstance(m, bytes)] == [frame(i) for i in (0, 1, 2, 9)]


def test_a_dropped_frame_leaves_its_seek_mark_to_the_next() -> None:
    mailbox, wire = Mailbox(), Wire()
    mailbox.put_frame(1, frame(1, did_seek=True))
    mailbox.put_frame(2, frame(2))
    mailbox.open(wire)
    (message,) = wire.sent
    assert isinstance(message, bytes)
    assert message == frame(2, did_seek=True)
    assert decode_frame(message)[0].did_seek


def test_too_many_texts_close_the_mailbox() -> None:
    mailbox, wire = Mailbox(), Wire()
    for i in range(MAX_TEXTS + 1):
        mailbox.put_text(str(i))
    assert mailbox.closing is not None
    assert mailbox.closing[0] == TOO_SLOW
    mailbox.open(wire)
    assert wire.sent == []


def test_a_closed_mailbox_sends_its_last_text_and_nothing_that_waited() -> None:
    mailbox, wire = Mailbox(), Wire(room=0)
    mailbox.open(wire)
    mailbox.put_text("old")
    mailbox.put_pose(b"pose")
    mailbox.close(1000, "over", "last")
    mailbox.put_text("too late")
    wire.make_room()
    assert wire.sent == ["last"]


@given(steps=st.lists(st.one_of(st.integers(0, 9), st.just("ack"), st.just("room")), max_size=40))
def test_frames_come_in_order_and_never_more_than_three_are_under_way(steps: list[int | str]) -> None:
    mailbox, wire, acknowledged, put = Mailbox(), Wire(room=0), 0, 0
    mailbox.open(wire)
    for step in steps:
        sent = [decode_frame(m)[0].frame_id for m in wire.sent if m != b"pose" and isinstance(m, bytes)]
        if step == "ack" and acknowledged < len(sent):
            mailbox.acknowledge(sent[acknowledged])
            acknowledged += 1
        elif step == "room":
            mailbox.put_pose(b"pose")
            wire.make_room(2)
        elif isinstance(step, int):
            put += 1
            mailbox.put_frame(put, frame(put))
        sent = [decode_frame(m)[0].frame_id for m in wire.sent if m != b"pose" and isinstance(m, bytes)]
        assert sent == sorted(set(sent))
        assert len(sent) - acknowledged <= MAX_UNACKNOWLEDGED
