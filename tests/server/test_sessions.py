"""Sessions: what a rig has piled up goes out as its newest."""

from collections.abc import Callable

from server.fanout import Mailbox
from server.sessions import Sessions
from server.wire import encode_frame, encode_pose
from tests.server.lines import Wire
from tests.server.wire_examples import TINY_JPEG, example_frame, example_pose


def test_what_came_while_the_loop_was_busy_goes_out_as_the_newest_with_the_seek_of_those_before() -> None:
    """A server that sends every one of them stays as far behind as it is."""
    turns: list[Callable[[], None]] = []
    session = Sessions(lambda: 0, later=turns.append).open("walk")
    viewer, wire = Mailbox(), Wire()
    session.join(viewer)
    viewer.open(wire)
    wire.sent.clear()
    pose = encode_pose(example_pose())
    session.take_binary(encode_frame(example_frame(1, did_seek=True), TINY_JPEG), 0)
    for i in range(2, 5):
        session.take_binary(pose, 0)
        session.take_binary(encode_frame(example_frame(i), TINY_JPEG), 0)
    assert (len(turns), wire.sent) == (1, [])
    turns.pop()()
    assert [message for message in wire.sent if isinstance(message, bytes)] == [
        encode_frame(example_frame(4, did_seek=True), TINY_JPEG),
        pose,
    ]
    session.take_binary(pose, 0)
    assert len(turns) == 1, "the next one has a turn again"
