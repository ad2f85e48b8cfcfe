"""Mailboxes: newest frame wins, text keeps its order, three unacknowledged frames at most."""

import asyncio

from hypothesis import given
from hypothesis import strategies as st

from server.fanout import MAX_TEXTS, MAX_UNACKNOWLEDGED, TOO_SLOW, Mailbox
from server.wire import decode_frame, encode_frame
from tests.server.wire_examples import TINY_JPEG, example_frame


def frame(frame_id: int, *, did_seek: bool = False) -> bytes:
    return encode_frame(example_frame(frame_id, did_seek=did_seek), TINY_JPEG)


async def drain(mailbox: Mailbox) -> list[str | bytes | None]:
    got: list[str | bytes | None] = []
    while True:
        try:
            got.append(await asyncio.wait_for(mailbox.next(), 0.01))
        except TimeoutError:
            return got
        if got[-1] is None:
            return got


def test_text_goes_before_the_newest_frame_before_the_newest_pose() -> None:
    mailbox = Mailbox()
    mailbox.put_pose(b"old pose")
    mailbox.put_pose(b"pose")
    mailbox.put_frame(1, frame(1))
    mailbox.put_frame(2, frame(2))
    mailbox.put_text("a")
    mailbox.put_text("b")
    assert asyncio.run(drain(mailbox)) == ["a", "b", frame(2), b"pose"]


def test_a_viewer_that_acknowledges_nothing_gets_three_frames_and_all_texts() -> None:
    async def play() -> list[str | bytes | None]:
        mailbox = Mailbox()
        got: list[str | bytes | None] = []
        for i in range(10):
            mailbox.put_frame(i, frame(i))
            mailbox.put_text(str(i))
            got += await drain(mailbox)
        mailbox.acknowledge(MAX_UNACKNOWLEDGED - 1)
        return got + await drain(mailbox)

    got = asyncio.run(play())
    assert [m for m in got if isinstance(m, str)] == [str(i) for i in range(10)]
    assert [m for m in got if isinstance(m, bytes)] == [frame(i) for i in (0, 1, 2, 9)]


def test_a_dropped_frame_leaves_its_seek_mark_to_the_next() -> None:
    mailbox = Mailbox()
    mailbox.put_frame(1, frame(1, did_seek=True))
    mailbox.put_frame(2, frame(2))
    (message,) = asyncio.run(drain(mailbox))
    assert isinstance(message, bytes)
    assert message == frame(2, did_seek=True)
    assert decode_frame(message)[0].did_seek


def test_too_many_texts_close_the_mailbox() -> None:
    mailbox = Mailbox()
    for i in range(MAX_TEXTS + 1):
        mailbox.put_text(str(i))
    assert mailbox.closing is not None
    assert mailbox.closing[0] == TOO_SLOW
    assert asyncio.run(drain(mailbox)) == [None]


@given(steps=st.lists(st.one_of(st.integers(0, 9), st.just("ack"), st.just("next")), max_size=40))
def test_frames_come_in_order_and_never_more_than_three_are_under_way(steps: list[int | str]) -> None:
    async def play() -> None:
        mailbox, acknowledged, put = Mailbox(), 0, 0
        sent: list[int] = []
        for step in steps:
            if step == "ack" and acknowledged < len(sent):
                mailbox.acknowledge(sent[acknowledged])
                acknowledged += 1
            elif step == "next":
                mailbox.put_pose(b"pose")
                message = await mailbox.next()
                assert isinstance(message, bytes)
                if message != b"pose":
                    sent.append(decode_frame(message)[0].frame_id)
            elif isinstance(step, int):
                put += 1
                mailbox.put_frame(put, frame(put))
            assert len(sent) - acknowledged <= MAX_UNACKNOWLEDGED
        assert sent == sorted(set(sent))

    asyncio.run(play())
